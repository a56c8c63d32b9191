# SPDX-License-Identifier: MIT
# The demonstration: the four plates of Figure 1, the quick cross-check against POV-Ray, a report.
run-demo: all
	@BUILD=$(BUILD) $(PYTHON) scripts/demo

# What masking and samplers are worth: Figures 9 and 10 measured.
efficiency: deps
	@$(MAKE) --no-print-directory run-efficiency
run-efficiency: all $(BENCHMARKS)
	@BUILD=$(BUILD) $(PYTHON) scripts/efficiency -o $(BUILD)/efficiency $(if $(QUICK),--quick)

# Explicit mirror facets in POV-Ray beside the fitted material, for four M.
geometry: deps
	@$(MAKE) --no-print-directory run-geometry
run-geometry: all
	@BUILD=$(BUILD) $(PYTHON) scripts/geometry-pair -o $(BUILD)/geometry $(if $(QUICK),--quick)

# The long report: error against run time as curves, the study above, and what `make demo`, `make test` and `make stability`
# left, if they ran. QUICK=1: small.
report: deps
	@$(MAKE) --no-print-directory run-report
run-report: run-efficiency run-geometry
	@BUILD=$(BUILD) $(PYTHON) scripts/curves -o $(BUILD)/curves
	@BUILD=$(BUILD) $(PYTHON) scripts/report --curves $(BUILD)/curves --efficiency $(BUILD)/efficiency --geometry $(BUILD)/geometry \
	    $(if $(wildcard $(BUILD)/plates/plates.json),--plates $(BUILD)/plates) \
	    $(if $(wildcard $(BUILD)/validate/fragment.html),--validate $(BUILD)/validate) \
	    --mutants $(BUILD)/mutants.json --stability $(BUILD)/stability \
	    --json $(BUILD)/report/report.json -o $(BUILD)/report/report.html

# The README's accuracy, speed and stability tables, measured again.
tables: deps
	@$(MAKE) --no-print-directory run-tables
run-tables: all $(BENCHMARKS)
	@BUILD=$(BUILD) $(PYTHON) scripts/tables && BUILD=$(BUILD) $(PYTHON) scripts/stability --readme

# Numerical stability over stiff and extreme cases, into $(BUILD)/stability; fails on what no rounding explains.
stability: deps
	@$(MAKE) --no-print-directory run-stability
run-stability: all
	@BUILD=$(BUILD) $(PYTHON) scripts/stability
