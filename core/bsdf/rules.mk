# SPDX-License-Identifier: MIT
# libmusurf: core/bsdf, written once over `real`, compiled for float and for double. libm only.
BSDF_SOURCES := $(wildcard core/bsdf/*.c)
BSDF_OBJECTS := $(BSDF_SOURCES:%.c=$(BUILD)/obj/%.f.o) $(BSDF_SOURCES:%.c=$(BUILD)/obj/%.d.o)
LIBRARIES += $(BUILD)/libmusurf.a $(BUILD)/libmusurf.so
PUBLIC_HEADERS += core/bsdf/musurf.h core/bsdf/musurf_real.h
# What a distribution of somebody else's is written with.
DISTRIBUTION_HEADERS += $(wildcard core/bsdf/*.h)

$(BUILD)/obj/core/bsdf/%.f.o: core/bsdf/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) -DMU_REAL_BITS=24 $(CFLAGS) -c $< -o $@
$(BUILD)/obj/core/bsdf/%.d.o: core/bsdf/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) -DMU_REAL_BITS=53 $(CFLAGS) -c $< -o $@

$(BUILD)/libmusurf.a: $(BSDF_OBJECTS)
	rm -f $@ && $(AR) rcs $@ $^
$(BUILD)/libmusurf.so.$(VERSION): $(BSDF_OBJECTS)
	$(CC) -shared -Wl,-soname,libmusurf.so.$(SOMAJOR) $(LDFLAGS) $^ -lm -o $@
$(BUILD)/libmusurf.so: $(BUILD)/libmusurf.so.$(VERSION)
	ln -sf libmusurf.so.$(VERSION) $(BUILD)/libmusurf.so.$(SOMAJOR)
	ln -sf libmusurf.so.$(SOMAJOR) $@
