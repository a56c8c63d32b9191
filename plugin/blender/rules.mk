# SPDX-License-Identifier: MIT
# The host Blender: an add-on, and a zip of it with the shared objects inside, to be installed from Blender's preferences.
BLENDER_PACKAGE := $(wildcard plugin/blender/musurf_blender/*.py)
BLENDER_OBJECTS := $(addprefix $(BUILD)/,libmusurf_render.so musurf_material.so template_material.so musurf_oiio.so)
BLENDER_ZIP     := $(BUILD)/musurf_blender.zip

.PHONY: blender-addon blender test-blender run-test-blender
blender-addon: deps
	@$(MAKE) --no-print-directory $(BLENDER_ZIP)
$(BLENDER_ZIP): plugin/blender/pack $(BLENDER_PACKAGE) $(BLENDER_OBJECTS)
	$(PYTHON) plugin/blender/pack $@ $(BLENDER_PACKAGE) -- $(BLENDER_OBJECTS)

# Blender itself, as Debian has it, and a newer one from PyPI: some 900 MB with what they need, so only when asked for.
blender: deps
	HOSTS="blender bpy" BUILD=$(abspath $(BUILD)) scripts/install
test-blender: blender
	@$(MAKE) --no-print-directory run-test-blender
run-test-blender: all $(BLENDER_ZIP)
	@FULL=1 BUILD=$(BUILD) $(PYTHON) tests/run blender
