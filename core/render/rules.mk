# SPDX-License-Identifier: MIT
# libmusurf_render and the command `musurf`. OpenImageIO stays in a module that is opened only when needed.
RENDER_SOURCES := $(filter-out core/render/main.c,$(wildcard core/render/*.c))
RENDER_OBJECTS := $(RENDER_SOURCES:%.c=$(BUILD)/obj/%.o)
PKGS           := jansson assimp libpng OpenEXR kissfft-float
RENDER_CFLAGS  := $(shell pkg-config --cflags $(PKGS) 2>/dev/null)
RENDER_LIBS    := -lembree3 -lOpenEXRCore -lassimp -ljansson -lpng -lkissfft-float -lz -ldl -lm

LIBRARIES += $(BUILD)/libmusurf_render.a
PROGRAMS  += $(BUILD)/musurf
MODULES   += $(BUILD)/libmusurf_render.so
PUBLIC_HEADERS += core/render/musurf_render.h
MODULES   += $(if $(wildcard core/render/module_oiio.cpp),$(BUILD)/musurf_oiio.so)

$(RENDER_OBJECTS) $(BUILD)/obj/core/render/main.o: CPPFLAGS += $(RENDER_CFLAGS)

$(BUILD)/libmusurf_render.a: $(RENDER_OBJECTS)
	rm -f $@ && $(AR) rcs $@ $^
$(BUILD)/musurf: $(BUILD)/obj/core/render/main.o $(BUILD)/libmusurf_render.a $(BUILD)/libmusurf.a
	$(CC) $(LDFLAGS) $^ $(RENDER_LIBS) -o $@
# The same for hosts (musurf_render.h), which see nothing else of it.
$(BUILD)/libmusurf_render.so: $(BUILD)/libmusurf_render.a $(BUILD)/libmusurf.a core/render/export.map
	$(CC) -shared $(LDFLAGS) -Wl,--version-script=core/render/export.map $(if $(SANITIZE),,-Wl,-z,defs) \
	    -Wl,-u,musurf_render_run $(filter %.a,$^) $(RENDER_LIBS) -o $@
$(BUILD)/musurf_oiio.so: $(BUILD)/obj/core/render/module_oiio.o
	$(CXX) -shared $(LDFLAGS) $^ $(shell pkg-config --libs OpenImageIO 2>/dev/null) -o $@
$(BUILD)/obj/core/render/module_oiio.o: CXXFLAGS_EXTRA = $(shell pkg-config --cflags OpenImageIO 2>/dev/null)
