# SPDX-License-Identifier: MIT
# One HTML page with the core inside, compiled to WebAssembly by clang and wasi-libc. `make page` installs these; the sources of
# core/bsdf and core/ibl are the very ones of the library, and the studio is the renderer's.
PAGE_CC      ?= clang --target=wasm32-wasi
PAGE_SOURCES := $(wildcard scripts/page/*.c) core/render/light_studio.c
PAGE_OBJECTS := $(PAGE_SOURCES:%.c=$(BUILD)/wasm/%.o) $(BSDF_SOURCES:%.c=$(BUILD)/wasm/%.f.o) $(BSDF_SOURCES:%.c=$(BUILD)/wasm/%.d.o) \
                $(IBL_SOURCES:%.c=$(BUILD)/wasm/%.f.o) $(IBL_SOURCES:%.c=$(BUILD)/wasm/%.d.o)
PAGE_FILES   := $(wildcard scripts/page/*.py scripts/page/*.html scripts/page/*.css scripts/page/*.js)
# Roundings are those of the other build: no product is fused with a sum. Four floats at a time, as every browser has had since 2023.
PAGE_CFLAGS  := -std=c17 -O3 -msimd128 -mbulk-memory -mnontrapping-fptoint -fno-math-errno -fno-trapping-math -ffp-contract=off \
                -fvisibility=hidden -ffunction-sections -fdata-sections $(WARNINGS) -Wno-constant-logical-operand -MMD -MP
PAGE_LDFLAGS := -mexec-model=reactor -Wl,--gc-sections -Wl,--strip-all -Wl,-z,stack-size=262144 -Wl,--export=malloc -Wl,--export=free

.PHONY: page run-page
page: deps
	HOSTS=wasm BUILD=$(abspath $(BUILD)) scripts/install
	@$(MAKE) --no-print-directory run-page
run-page: $(BUILD)/musurf.html

$(BUILD)/wasm/core/bsdf/%.f.o: core/bsdf/%.c
	@mkdir -p $(@D)
	$(PAGE_CC) $(CPPFLAGS) -DMU_REAL_BITS=24 $(PAGE_CFLAGS) -c $< -o $@
$(BUILD)/wasm/core/ibl/%.f.o: core/ibl/%.c
	@mkdir -p $(@D)
	$(PAGE_CC) $(CPPFLAGS) -DMU_REAL_BITS=24 $(PAGE_CFLAGS) -c $< -o $@
$(BUILD)/wasm/core/bsdf/%.d.o: core/bsdf/%.c
	@mkdir -p $(@D)
	$(PAGE_CC) $(CPPFLAGS) -DMU_REAL_BITS=53 $(PAGE_CFLAGS) -c $< -o $@
$(BUILD)/wasm/core/ibl/%.d.o: core/ibl/%.c
	@mkdir -p $(@D)
	$(PAGE_CC) $(CPPFLAGS) -DMU_REAL_BITS=53 $(PAGE_CFLAGS) -c $< -o $@
$(BUILD)/wasm/%.o: %.c
	@mkdir -p $(@D)
	$(PAGE_CC) $(CPPFLAGS) $(PAGE_CFLAGS) -c $< -o $@
$(BUILD)/wasm/musurf.wasm: $(PAGE_OBJECTS) scripts/page/rules.mk
	$(PAGE_CC) $(PAGE_LDFLAGS) $(PAGE_OBJECTS) -o $@
$(BUILD)/musurf.html: $(BUILD)/wasm/musurf.wasm $(PAGE_FILES)
	$(PYTHON) scripts/page/bundle.py scripts/page $(BUILD)/wasm/musurf.wasm -o $@

-include $(shell test -d $(BUILD)/wasm && find $(BUILD)/wasm -name '*.d')
