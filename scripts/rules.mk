# SPDX-License-Identifier: MIT
# The demonstration: the four plates of Figure 1, the quick cross-check against POV-Ray, a report.
run-demo: all
	@BUILD=$(BUILD) $(PYTHON) scripts/demo

# What masking and samplers are worth: Figures 9 and 10 measured.
efficiency: deps
	@$(MAKE) --no-print-directory run-efficiency
run-efficiency: all $(BENCHMARKS)
	@BUILD=$(BUILD) $(PYTHON) scripts/efficiency -o $(BUILD)/efficiency $(if $(QUICK),--quick) $(if $(README),--readme)

# Explicit mirror facets in POV-Ray beside the fitted material, for four M.
geometry: deps
	@$(MAKE) --no-print-directory run-geometry
run-geometry: all
	@BUILD=$(BUILD) $(PYTHON) scripts/geometry-pair -o $(BUILD)/geometry $(if $(QUICK),--quick)

# A plate of facets deformed as a whole in POV-Ray beside the deformed mesh with "tension".
.PHONY: geometry-tension run-geometry-tension
geometry-tension: deps
	@$(MAKE) --no-print-directory run-geometry-tension
run-geometry-tension: all
	@BUILD=$(BUILD) $(PYTHON) scripts/geometry-tension -o $(BUILD)/geometry-tension $(if $(QUICK),--quick)

# Figures 6, 7 and 8 of the paper and a balloon of 24 frames: makes the meshes, renders scenes/figures.
.PHONY: figures run-figures
figures: deps
	@$(MAKE) --no-print-directory run-figures
run-figures: all
	@BUILD=$(BUILD) $(PYTHON) scripts/figures -o $(BUILD)/figures $(if $(QUICK),--quick)

# Image-based lighting against path tracing: error against the time of a frame, over roughness, anisotropy, environments, reads.
.PHONY: ibl run-ibl
ibl: deps
	@$(MAKE) --no-print-directory run-ibl
run-ibl: all $(BUILD)/tests/bench_ibl
	@BUILD=$(BUILD) $(PYTHON) scripts/ibl -o $(BUILD)/ibl $(if $(QUICK),--quick) $(if $(README),--readme)

# What accuracy costs on explicit surfaces: error against time and memory, over grid, points, realisations, images, tracers.
costs: deps
	@$(MAKE) --no-print-directory run-costs
run-costs: all
	@BUILD=$(BUILD) $(PYTHON) scripts/costs -o $(BUILD)/costs $(if $(QUICK),--quick)

# The long report: everything that can be measured in minutes, measured, with what is claimed on top; shows too what `make test`
# and `make stability` left. A part that fails is told in the page, and make fails. QUICK=1: small.
report: deps
	@$(MAKE) --no-print-directory run-report
run-report: all $(BENCHMARKS)
	@BUILD=$(BUILD) $(PYTHON) scripts/report --all $(if $(QUICK),--quick) --json $(BUILD)/report/report.json -o $(BUILD)/report/report.html

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
