# SPDX-License-Identifier: MIT
# Explicit microsurfaces: pure C17, libm only, no I/O, no threads, no globals. Part of libmusurf_render, which brings
# what the kernels ask for: the FFT behind a callback, files, threads.
SURFACE_SOURCES := $(wildcard core/surface/*.c)
SURFACE_OBJECTS := $(SURFACE_SOURCES:%.c=$(BUILD)/obj/%.o)

$(BUILD)/libmusurf_render.a: $(SURFACE_OBJECTS)
