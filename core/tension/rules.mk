# SPDX-License-Identifier: MIT
# How an object deforms, and with it its microsurface: pure C17, libm only, no I/O, no threads, no globals. Part of
# libmusurf_render, which brings the files.
TENSION_SOURCES := $(wildcard core/tension/*.c)
TENSION_OBJECTS := $(TENSION_SOURCES:%.c=$(BUILD)/obj/%.o)

$(BUILD)/libmusurf_render.a: $(TENSION_OBJECTS)
