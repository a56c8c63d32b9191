# SPDX-License-Identifier: MIT
# musurf: two commands for newcomers: `make demo` and `make test`. Both first install what is missing.
# `make help` lists the rest. Each room adds its own targets in its rules.mk.

BUILD   ?= build
PREFIX  ?= /usr/local
DESTDIR ?=
CC      ?= gcc
PYTHON  ?= $(abspath $(BUILD))/venv/bin/python
VERSION := 0.1.0
SOMAJOR := 0

# Warnings are errors in CI (WERROR=1) and for developers who ask; a newer compiler must not break a user's build.
WERROR   ?= 0
WARNINGS := -Wall -Wextra -Wshadow -Wconversion -Wstrict-prototypes -Wmissing-prototypes -Wvla \
            $(if $(filter 1,$(WERROR)),-Werror)
# -fno-math-errno -fno-trapping-math let sqrt and selects be single instructions; -ffast-math is never used.
OPTIMISE ?= -O3 -g
SANITIZE ?=
CFLAGS   += -std=c17 $(OPTIMISE) -fno-math-errno -fno-trapping-math -fPIC -pthread $(WARNINGS) $(SANITIZE) -MMD -MP
CPPFLAGS += -D_GNU_SOURCE -DMUSURF_VERSION='"$(VERSION)"' -I.
LDFLAGS  += $(SANITIZE) -pthread

.DEFAULT_GOAL := all
.PHONY: all lib clean distclean install uninstall test demo deps help run-test run-demo check-style

# Rooms: each adds to LIBRARIES, PROGRAMS, MODULES, TEST_PROGRAMS and TESTS.
LIBRARIES :=
MODULES   :=
PROGRAMS  :=
TEST_PROGRAMS :=
TESTS     :=
-include core/bsdf/rules.mk plugin/rules.mk core/render/rules.mk core/surface/rules.mk
-include tests/rules.mk scripts/rules.mk

all: $(LIBRARIES) $(MODULES) $(PROGRAMS)

# One object per source, in a mirror of the tree. Only the sources of core/render see third-party headers.
$(BUILD)/obj/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(CFLAGS) -c $< -o $@

$(BUILD)/obj/%.o: %.cpp
	@mkdir -p $(@D)
	$(CXX) $(CPPFLAGS) -std=c++17 $(OPTIMISE) -fPIC -Wall -Wextra $(SANITIZE) -MMD -MP $(CXXFLAGS_EXTRA) -c $< -o $@

# What the machine lacks: Debian packages and a pinned virtual environment. The stamp makes re-running free.
deps: $(BUILD)/.installed
$(BUILD)/.installed: scripts/install scripts/requirements.txt
	@mkdir -p $(BUILD)
	BUILD=$(abspath $(BUILD)) scripts/install
	@touch $@

test: deps
	@$(MAKE) --no-print-directory run-test
demo: deps
	@$(MAKE) --no-print-directory run-demo

clean:
	rm -rf $(BUILD)/obj $(BUILD)/tests $(BUILD)/musurf* $(BUILD)/lib* $(BUILD)/*.so*
distclean:
	rm -rf $(BUILD)

DEPENDENCY_FILES := $(shell test -d $(BUILD)/obj && find $(BUILD)/obj -name '*.d')
-include $(DEPENDENCY_FILES)
