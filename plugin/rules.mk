# SPDX-License-Identifier: MIT
# The shared objects that hosts load: one exported symbol each, nothing undefined.
PUBLIC_HEADERS += plugin/musurf_plugin.h plugin/musurf_probe.h plugin/musurf_map.h plugin/musurf_slopes.h
PLUGIN_LINK = $(CC) -shared $(LDFLAGS) -Wl,--version-script=plugin/export.map $(if $(SANITIZE),,-Wl,-z,defs)
MODULES += $(BUILD)/musurf_material.so $(BUILD)/template_material.so

$(BUILD)/musurf_material.so: $(patsubst %.c,$(BUILD)/obj/%.o,$(filter-out plugin/template.c,$(wildcard plugin/*.c))) \
                             $(patsubst %,$(BUILD)/obj/core/ibl/%.o,slopes.d even.d cells.f cells.d walks.f walks.d) $(BUILD)/libmusurf.a plugin/export.map
	$(PLUGIN_LINK) $(filter %.o,$^) $(BUILD)/libmusurf.a -lm -o $@
$(BUILD)/template_material.so: $(BUILD)/obj/plugin/template.o plugin/export.map
	$(PLUGIN_LINK) $(filter %.o,$^) -lm -o $@
