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
.PHONY: all clean distclean install uninstall test demo bench fuzz run-fuzz tables stability report efficiency geometry costs deps help run-test \
        run-demo run-tables run-stability run-report run-efficiency run-geometry run-costs asan ubsan tsan

# Rooms: each adds to LIBRARIES, PROGRAMS, MODULES, TEST_PROGRAMS and TESTS.
LIBRARIES :=
MODULES   :=
PUBLIC_HEADERS :=
DISTRIBUTION_HEADERS :=
PROGRAMS  :=
TEST_PROGRAMS :=
TESTS     :=
-include core/bsdf/rules.mk plugin/rules.mk plugin/mitsuba/rules.mk plugin/blender/rules.mk core/render/rules.mk core/surface/rules.mk core/tension/rules.mk \
         core/ibl/rules.mk
-include tests/rules.mk scripts/rules.mk scripts/page/rules.mk

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

# Libraries, headers, plugins, program, pkg-config files. The program finds its plugins in ../lib/musurf.
INSTALL ?= install
install: all
	$(INSTALL) -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/lib/musurf $(DESTDIR)$(PREFIX)/lib/pkgconfig \
	              $(DESTDIR)$(PREFIX)/include/musurf/core/bsdf $(DESTDIR)$(PREFIX)/share/musurf/scenes \
	              $(DESTDIR)$(PREFIX)/lib/musurf/mitsuba/musurf_mitsuba
	$(INSTALL) -m 755 $(PROGRAMS) $(DESTDIR)$(PREFIX)/bin
	$(INSTALL) -m 755 $(MODULES) $(DESTDIR)$(PREFIX)/lib/musurf
	$(INSTALL) -m 644 $(MITSUBA_PACKAGE) $(DESTDIR)$(PREFIX)/lib/musurf/mitsuba/musurf_mitsuba
	$(INSTALL) -m 644 $(BUILD)/libmusurf.a $(BUILD)/libmusurf_render.a $(DESTDIR)$(PREFIX)/lib
	$(INSTALL) -m 755 $(BUILD)/libmusurf.so.$(VERSION) $(DESTDIR)$(PREFIX)/lib
	ln -sf libmusurf.so.$(VERSION) $(DESTDIR)$(PREFIX)/lib/libmusurf.so.$(SOMAJOR)
	ln -sf libmusurf.so.$(SOMAJOR) $(DESTDIR)$(PREFIX)/lib/libmusurf.so
	$(INSTALL) -m 644 $(PUBLIC_HEADERS) $(DESTDIR)$(PREFIX)/include/musurf
	$(INSTALL) -m 644 $(DISTRIBUTION_HEADERS) $(DESTDIR)$(PREFIX)/include/musurf/core/bsdf
	$(INSTALL) -m 644 $(wildcard scenes/*.json) scenes/brushed_map.png $(DESTDIR)$(PREFIX)/share/musurf/scenes
	$(INSTALL) -d $(DESTDIR)$(PREFIX)/share/musurf/scenes/materials
	$(INSTALL) -m 644 $(wildcard scenes/materials/*.json) $(DESTDIR)$(PREFIX)/share/musurf/scenes/materials
	sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@VERSION@|$(VERSION)|' scripts/musurf.pc.in \
	    > $(DESTDIR)$(PREFIX)/lib/pkgconfig/musurf.pc

uninstall:
	rm -f $(addprefix $(DESTDIR)$(PREFIX)/bin/,$(notdir $(PROGRAMS)))
	rm -f $(DESTDIR)$(PREFIX)/lib/libmusurf.* $(DESTDIR)$(PREFIX)/lib/libmusurf_render.a
	rm -f $(DESTDIR)$(PREFIX)/lib/pkgconfig/musurf.pc
	rm -rf $(DESTDIR)$(PREFIX)/lib/musurf $(DESTDIR)$(PREFIX)/include/musurf $(DESTDIR)$(PREFIX)/share/musurf

# The whole suite under a sanitizer, in a build folder of its own.
asan ubsan: deps
	@mkdir -p $(BUILD)/$@ && ln -sfn ../venv $(BUILD)/$@/venv && touch $(BUILD)/$@/.installed
	$(MAKE) BUILD=$(BUILD)/$@ OPTIMISE='-O1 -g' \
	    SANITIZE='-fno-omit-frame-pointer -fsanitize=$(if $(filter asan,$@),address,undefined -fno-sanitize-recover=all)' run-test
tsan: deps
	@mkdir -p $(BUILD)/$@ && ln -sfn ../venv $(BUILD)/$@/venv && touch $(BUILD)/$@/.installed
	TSAN_OPTIONS=suppressions=$(abspath tests/tsan.supp) \
	$(MAKE) BUILD=$(BUILD)/$@ OPTIMISE='-O1 -g' SANITIZE='-fsanitize=thread' ONLY='$(or $(ONLY),abi render)' run-test

help:
	@echo 'make demo       install what is missing, build, render Figure 1, check against POV-Ray, write a report'
	@echo 'make test       install what is missing, build, run the test suite (ONLY="words" picks tests by name)'
	@echo 'make            build everything into $(BUILD)/'
	@echo 'make fuzz       a million random lines to musurf ibl axis: nothing that is not finite'
	@echo 'make bench      speed, as ratios measured in one run'
	@echo 'make efficiency masking and samplers against the paper'"'"'s own (Figures 9 and 10); QUICK=1: a glance; README=1: also there'
	@echo 'make geometry   mirror facets rendered by POV-Ray beside the material fitted to them; QUICK=1: a glance'
	@echo 'make geometry-tension  the same of plates deformed as a whole, beside meshes with "tension": highlights; QUICK=1: a glance'
	@echo 'make figures    the paper'"'"'s Figures 6, 7, 8 (scenes/figures) and an inflating balloon into $(BUILD)/figures; QUICK=1: a glance'
	@echo 'make ibl        techniques of image-based lighting against path tracing: error against time; QUICK=1: a glance; README=1: also there'
	@echo 'make costs      what accuracy costs on explicit surfaces: error against time and memory; QUICK=1: a glance'
	@echo 'make report     all of these and the full cross-check, measured and on one page, with what is claimed on top; QUICK=1'
	@echo 'make tables     measure the accuracy and speed tables of the README again'
	@echo 'make stability  measure errors over stiff and extreme cases, in float and double, into $(BUILD)/stability/'
	@echo 'make mitsuba    Mitsuba 3 into $(BUILD)/mitsuba (some 400 MB); then make test-mitsuba: musurf inside it, in full'
	@echo 'make blender-addon  an add-on for Blender as a zip, $(BUILD)/musurf_blender.zip'
	@echo 'make blender    Blender, and a newer one from PyPI into $(BUILD)/bpy (some 900 MB); then make test-blender: musurf inside, in full'
	@echo 'make page       one HTML page with the core inside, $(BUILD)/musurf.html: drag M, see D, lobe, axis and a lit sphere'
	@echo 'make asan       the test suite under the address sanitizer; also: ubsan, tsan'
	@echo 'make install    PREFIX=/usr/local DESTDIR= ; also: uninstall'
	@echo 'make clean      remove what was built; distclean removes $(BUILD)/ with the virtual environment'
	@echo 'Settings: BUILD=folder CC=gcc WERROR=1 OPTIMISE="-O3 -g" SANITIZE='

clean:
	rm -rf $(BUILD)/obj $(BUILD)/wasm $(BUILD)/tests $(BUILD)/musurf* $(BUILD)/lib* $(BUILD)/*.so*
distclean:
	rm -rf $(BUILD)

DEPENDENCY_FILES := $(shell test -d $(BUILD)/obj && find $(BUILD)/obj -name '*.d')
-include $(DEPENDENCY_FILES)
