# SPDX-License-Identifier: MIT
# tests/test_*.c are cmocka programs, tests/test_*.py are programs of their own; tests/run runs them all.
# tests/bench_*.c are benchmarks. Every other tests/*.c is shared by the test programs.
TEST_SHARED   := $(filter-out tests/test_%.c tests/bench_%.c,$(wildcard tests/*.c))
TEST_PROGRAMS := $(patsubst tests/%.c,$(BUILD)/tests/%,$(wildcard tests/test_*.c))
BENCHMARKS    := $(patsubst tests/%.c,$(BUILD)/tests/%,$(wildcard tests/bench_*.c))
TEST_LIBS      = $(BUILD)/libmusurf_render.a $(BUILD)/libmusurf.a $(RENDER_LIBS)

$(patsubst tests/%.c,$(BUILD)/obj/tests/%.o,$(wildcard tests/*.c)): CPPFLAGS += $(RENDER_CFLAGS)
$(TEST_PROGRAMS) $(BENCHMARKS): $(BUILD)/tests/%: $(BUILD)/obj/tests/%.o $(TEST_SHARED:%.c=$(BUILD)/obj/%.o) \
                                $(BUILD)/libmusurf_render.a $(BUILD)/libmusurf.a
	@mkdir -p $(@D)
	$(CC) $(LDFLAGS) $(filter %.o,$^) $(TEST_LIBS) -lcmocka -o $@

# test_ibl_study.py runs a benchmark.
run-test: all $(TEST_PROGRAMS) $(BUILD)/tests/bench_ibl
	@BUILD=$(BUILD) $(PYTHON) tests/run $(ONLY)

# Speed, as ratios measured in one run; one that falls short of its goal fails.
bench: all $(BENCHMARKS)
	@failed=0; for program in $(BENCHMARKS); do BUILD=$(BUILD) $$program || failed=1; done; \
	BUILD=$(BUILD) $(PYTHON) tests/bench_rays.py || failed=1; \
	BUILD=$(BUILD) $(PYTHON) tests/bench_tracers.py || failed=1; \
	BUILD=$(BUILD) $(PYTHON) tests/bench_mitsuba.py || failed=1; \
	BUILD=$(BUILD) $(PYTHON) tests/bench_page.py || failed=1; exit $$failed

# A million random lines to `musurf ibl axis`; `make test` asks 20 000.
fuzz: deps
	@$(MAKE) --no-print-directory run-fuzz
run-fuzz: all
	@BUILD=$(BUILD) $(PYTHON) tests/test_ibl_fuzz.py 1000000
