/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_info.c: `musurf info`: the build, the materials of a plugin and their parameters, straight from its
 * table. */
#include <stdio.h>
#include <string.h>

#include "core/render/command.h"
#include "core/render/features.h"
#include "core/render/info.h"
#include "core/render/options.h"
#include "core/render/scene.h"

static const mu_option options[] = {{"json", NULL, "everything as one JSON object"},
                                    {"schema", NULL, "the JSON Schema of MATERIAL's objects in scene files"},
                                    {NULL, NULL, NULL}};

static const mu_usage usage = {
    "info", "[--json|--schema] [MATERIAL]",
    "Shows the distributions and all other choices and parameters of a material, the build, and\n"
    "where the plugin was found. MATERIAL is vendor.name (default: musurf.microfacet).\n",
    options, NULL};

/* One value as a scene file writes it, short. */
static void print_value(const json_t *value) {
    if (json_is_real(value)) {
        printf("%.10g", json_real_value(value));
    } else if (json_is_array(value)) {
        for (size_t i = 0; i < json_array_size(value); i++) {
            fputs(i ? ", " : "[", stdout);
            print_value(json_array_get(value, i));
        }
        putchar(']');
    } else if (json_is_string(value)) {
        fputs(json_string_value(value), stdout);
    } else {
        fputs(json_is_true(value) ? "true" : json_is_false(value) ? "false" : "unbounded", stdout);
    }
}

static const char *text_of(const json_t *object, const char *key) {
    return json_string_value(json_object_get(object, key));
}

static void print_range(const json_t *p) {
    const json_t *min = json_object_get(p, "min"), *max = json_object_get(p, "max");
    if (json_is_null(min) && json_is_null(max)) {
        printf(", any");
    } else {
        printf(", %s", json_is_true(json_object_get(p, "min_excluded")) || json_is_null(min) ? "(" : "[");
        printf(json_is_null(min) ? "-inf" : "%.10g", json_real_value(min));
        printf(json_is_null(max) ? ", inf" : ", %.10g", json_real_value(max));
        printf("%s", json_is_true(json_object_get(p, "max_excluded")) || json_is_null(max) ? ")" : "]");
    }
}

/* Indented, with lines broken between words. */
static void print_doc(const char *text) {
    size_t column = 0;
    while (*text) {
        const size_t length = strcspn(text, " ");
        if (column > 0 && column + 1 + length > 100) column = 0, putchar('\n');
        printf("%s%.*s", column ? " " : "      ", (int)length, text);
        column += (column ? 1 : 6) + length;
        text += length;
        text += strspn(text, " ");
    }
    putchar('\n');
}

static void print_param(const json_t *p) {
    printf("  %s\n      %s", text_of(p, "name"), text_of(p, "kind"));
    const json_t *choices = json_object_get(p, "choices");
    for (size_t i = 0; i < json_array_size(choices); i++)
        printf("%s%s", i ? " | " : ": ", json_string_value(json_array_get(choices, i)));
    if (json_object_get(p, "min")) print_range(p);
    if (text_of(p, "unit")[0]) printf(" %s", text_of(p, "unit"));
    printf("; default ");
    print_value(json_object_get(p, "default"));
    if (json_is_true(json_object_get(p, "may_vary"))) printf("; may vary over the surface");
    putchar('\n');
    print_doc(text_of(p, "doc"));
}

static void print_build(const json_t *build) {
    printf("musurf %s, %s\n", text_of(build, "version"), text_of(build, "compiler"));
    const char *key, *separator = "libraries: ";
    json_t *value;
    json_object_foreach(json_object_get(build, "libraries"), key, value) {
        printf("%s%s %s", separator, key, json_string_value(value));
        separator = ", ";
    }
    putchar('\n');
}

static void print_text(const json_t *all) {
    const json_t *build = json_object_get(all, "build"), *plugin = json_object_get(all, "plugin"),
                 *material = json_object_get(all, "material");
    print_build(build);
    json_t *value;
    printf("plugin: %s %s (%s), interface %s, %s\n", text_of(plugin, "name"), text_of(plugin, "version"),
           text_of(plugin, "license"), text_of(build, "abi"), text_of(plugin, "file"));
    size_t i;
    json_array_foreach(json_object_get(plugin, "materials"), i, value)
        printf("%s%s", i ? ", " : "materials: ", json_string_value(value));
    printf("\n\n%s: %s. %s\n\nparameters:\n", text_of(material, "id"), text_of(material, "label"),
           text_of(material, "doc"));
    json_array_foreach(json_object_get(material, "parameters"), i, value) print_param(value);
    const char *name;
    fputs("\nintegrators (render --integrator):", stdout);
    json_array_foreach(json_object_get(all, "integrators"), i, value) printf(" %s", json_string_value(value));
    putchar('\n');
    printf("\nwhat a scene may need, or leave out (render --explain):\n");
    json_object_foreach(json_object_get(all, "features"), name, value)
        printf("  %-24s%s\n", name, json_string_value(value));
}

static json_t *features(void) {
    json_t *all = json_object();
    for (int i = 0; i < MU_FEATURE_COUNT; i++)
        json_object_set_new(all, mu_feature_list()[i].name, json_string(mu_feature_list()[i].brings));
    return all;
}

static json_t *collect(const musurf_plugin *plugin, const char *file, const musurf_material_type *type) {
    json_t *materials = json_array();
    for (size_t i = 0; i < plugin->type_count; i++)
        json_array_append_new(materials, json_string(plugin->types[i]->id));
    json_t *integrators = json_array();
    for (size_t i = 0; mu_integrators[i]; i++) json_array_append_new(integrators, json_string(mu_integrators[i]));
    return json_pack("{s:o, s:{s:s, s:s, s:s, s:i, s:s, s:o}, s:{s:s, s:s, s:s, s:o}, s:o, s:o}", "build",
                     mu_info_build(), "plugin", "name", plugin->name, "version", plugin->version, "license",
                     plugin->license, "abi_minor", (int)plugin->abi_minor, "file", file, "materials",
                     materials, "material", "id", type->id, "label", type->label, "doc", type->doc,
                     "parameters", mu_info_params(type), "features", features(), "integrators", integrators);
}

static int show(mu_plugins *plugins, const char *id, _Bool as_json, _Bool as_schema) {
    mu_error error = {.text = ""};
    const musurf_material_type *type = mu_plugins_type(plugins, id, &error);
    if (!type) {
        /* The build is known all the same; without it there would be nothing to report a bug with. */
        json_t *build = mu_info_build();
        if (build && !as_json && !as_schema) print_build(build);
        json_decref(build);
        return mu_refuse(&usage, "%s", error.text);
    }
    char vendor[65];
    snprintf(vendor, sizeof vendor, "%.*s", (int)strcspn(id, "."), id);
    const char *file;
    const musurf_plugin *plugin = mu_plugins_vendor(plugins, vendor, &file, &error);
    json_t *all = as_schema ? mu_info_schema(type) : collect(plugin, file, type);
    if (!all) return mu_refuse(&usage, "not enough memory, or a text in %s that is not UTF-8", file);
    if (as_json || as_schema) {
        json_dumpf(all, stdout, JSON_INDENT(2));
        putchar('\n');
    } else {
        print_text(all);
    }
    json_decref(all);
    return MU_EXIT_OK;
}

int mu_command_info(int argc, char **argv) {
    const char *id = NULL;
    _Bool as_json = 0, as_schema = 0;
    int met;
    mu_options given = mu_options_begin(&usage, argc, argv);
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        if (met == MU_OPTIONS_OPERAND) {
            if (id) return mu_refuse(&usage, "one MATERIAL at most, but \"%s\" is a second", given.value);
            id = given.value;
        } else if (met < 0) {
            return mu_options_exit(met);
        } else {
            *(met == 0 ? &as_json : &as_schema) = 1;
        }
    }
    if (as_json && as_schema) return mu_refuse(&usage, "--json and --schema exclude each other");

    mu_plugins *plugins = mu_plugins_new();
    if (!plugins) return mu_refuse(&usage, "not enough memory");
    const int code = show(plugins, id ? id : "musurf.microfacet", as_json, as_schema);
    mu_plugins_free(plugins);
    return code;
}
