/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* musurf_probe.c: the extension "musurf.probe/1": the core's quantities in float or double. */
#include <float.h>
#include <math.h>

#include "plugin/musurf_compiled.h"

#define REAL     float
#define IN(name) name##_f
#include "plugin/musurf_probe_real.h"
#undef REAL
#undef IN
#define REAL     double
#define IN(name) name##_d
#include "plugin/musurf_probe_real.h"

/* One that varies is left out: the surface as from afar. */
static const double *footprint_of(const musurf_material *material) {
    return material->parsed.footprint_from == FOOTPRINT_CONSTANT ? material->parsed.footprint : NULL;
}

static musurf_result probe_evaluate(const musurf_material *material, musurf_precision precision,
                                    const double wo[3], const double *wm, const double *wi,
                                    musurf_probe_values *out) {
    if (material->parsed.varying) return MUSURF_UNSUPPORTED;
    /* a material that shades in double answers in double: that is what its float answers are rounded from */
    if (precision == MUSURF_FLOAT && material->in_float)
        return evaluate_f(material->in_float, footprint_of(material), wo, wm, wi, out);
    if (precision != MUSURF_FLOAT && precision != MUSURF_DOUBLE) return MUSURF_UNSUPPORTED;
    return evaluate_d(material->in_double, footprint_of(material), wo, wm, wi, out);
}

static musurf_result probe_sample(const musurf_material *material, musurf_precision precision,
                                  musurf_sampler sampler, const double wo[3], const double u[3],
                                  musurf_probe_sample *out) {
    if (material->parsed.varying || sampler < MUSURF_SAMPLE_AS_SET || sampler > MUSURF_SAMPLE_NDF)
        return MUSURF_UNSUPPORTED;
    const mu_sampler chosen = sampler == MUSURF_SAMPLE_NDF       ? MU_SAMPLE_NDF
                              : sampler == MUSURF_SAMPLE_VISIBLE ? MU_SAMPLE_VISIBLE
                                                                 : material->parsed.definition.sampler;
    if (precision == MUSURF_FLOAT && material->in_float)
        return draw_f(material->in_float, footprint_of(material), chosen, wo, u, out);
    if (precision != MUSURF_FLOAT && precision != MUSURF_DOUBLE) return MUSURF_UNSUPPORTED;
    return draw_d(material->in_double, footprint_of(material), chosen, wo, u, out);
}

const musurf_probe musurf_probe_table = {sizeof(musurf_probe), probe_evaluate, probe_sample};
