# SPDX-License-Identifier: MIT
# The host Mitsuba 3: what lies between its arrays and a plugin's batches, the Python package, and its virtual environment.
MITSUBA         := $(BUILD)/mitsuba
MITSUBA_PACKAGE := $(wildcard plugin/mitsuba/musurf_mitsuba/*.py)
MODULES         += $(BUILD)/musurf_wavefront.so

$(BUILD)/musurf_wavefront.so: $(BUILD)/obj/plugin/mitsuba/wavefront.o
	$(CC) -shared $(LDFLAGS) $(if $(SANITIZE),,-Wl,-z,defs) $^ -o $@

# Mitsuba itself, pinned, and an LLVM for it: some 350 MB, so only when asked for.
.PHONY: mitsuba test-mitsuba run-test-mitsuba
mitsuba: deps
	HOSTS=mitsuba BUILD=$(abspath $(BUILD)) scripts/install
test-mitsuba: mitsuba
	@$(MAKE) --no-print-directory run-test-mitsuba
run-test-mitsuba: all
	@FULL=1 BUILD=$(BUILD) $(PYTHON) tests/run mitsuba
