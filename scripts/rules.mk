# SPDX-License-Identifier: MIT
# The demonstration: the four plates of Figure 1, the quick cross-check against POV-Ray, a report.
run-demo: all
	@BUILD=$(BUILD) $(PYTHON) scripts/demo

# The README's accuracy and speed tables, measured again.
tables: deps
	@$(MAKE) --no-print-directory run-tables
run-tables: all $(BENCHMARKS)
	@BUILD=$(BUILD) $(PYTHON) scripts/tables
