# SPDX-License-Identifier: MIT
# Image-based lighting: pure C17, libm only, no I/O, no threads, no globals; written once over `real`, compiled for float
# and for double. Part of libmusurf_render, which brings images.
IBL_SOURCES := $(wildcard core/ibl/*.c)
IBL_OBJECTS := $(IBL_SOURCES:%.c=$(BUILD)/obj/%.f.o) $(IBL_SOURCES:%.c=$(BUILD)/obj/%.d.o)

$(BUILD)/obj/core/ibl/%.f.o: core/ibl/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) -DMU_REAL_BITS=24 $(CFLAGS) -c $< -o $@
$(BUILD)/obj/core/ibl/%.d.o: core/ibl/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) -DMU_REAL_BITS=53 $(CFLAGS) -c $< -o $@

$(BUILD)/libmusurf_render.a: $(IBL_OBJECTS)
