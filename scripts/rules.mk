# SPDX-License-Identifier: MIT
# The demonstration: the four plates of Figure 1, the quick cross-check against POV-Ray, a report.
run-demo: all
	@BUILD=$(BUILD) $(PYTHON) scripts/demo

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
