/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* material.c: see material.h. A material that is refused leaves the one before as it was. */
#include "scripts/page/material.h"

#include <math.h>
#include <stdlib.h>

/* In the order of mu_ndf, of mu_masking_form: the names of scene files. */
static const char *const ndfs[] = {"ggx", "beckmann", "gtr", "std", "phong", "sheen", NULL};
static const char *const maskings[] = {"separable", "height_correlated", "direction_correlated", NULL};

const char *page_choice(int list, int index) {
    return list == PAGE_NDFS ? ndfs[index] : list == PAGE_MASKINGS ? maskings[index] : mu_metal_names[index];
}

page_material *page_material_new(void) {
    return calloc(1, sizeof(page_material));
}

const char *page_material_field(const page_material *m) {
    return m->why.field;
}
const char *page_material_complaint(const page_material *m) {
    return m->why.text;
}

static mu_definition define(const double *p) {
    mu_definition d = mu_definition_default();
    d.ndf = (mu_ndf)(int)p[PAGE_NDF];
    d.alpha = p[PAGE_ROUGHNESS] * p[PAGE_ROUGHNESS];
    d.gamma = p[PAGE_GAMMA];
    d.exponent = p[PAGE_EXPONENT];
    for (int k = 0; k < 4; k++) d.transform[k] = p[PAGE_TRANSFORM + k];
    d.masking = (mu_masking_form)(int)p[PAGE_MASKING];
    if (p[PAGE_METAL] > 0 && mu_metal(mu_metal_names[(int)p[PAGE_METAL] - 1], d.n, d.k))
        d.fresnel = MU_FRESNEL_CONDUCTOR;
    return d;
}

int page_material_set(page_material *m, const double *numbers) {
    const mu_definition d = define(numbers);
    mu_ibl_slopes slopes;
    if (!mu_definition_check(&d, &m->why)) return 0;
    const size_t single = (mu_surface_bytes_f(&d) + 15) / 16 * 16, whole = single + mu_surface_bytes_d(&d);
    unsigned char *memory = aligned_alloc(16, (whole + 15) / 16 * 16);
    if (!memory || !mu_ibl_slopes_of(&d, &slopes)) {
        free(memory);
        m->why = (mu_complaint){"memory", "is not enough for this material"};
        return 0;
    }
    free(m->memory);
    m->memory = memory;
    m->definition = d;
    m->shaded = mu_surface_make_f(&d, memory);
    m->exact = mu_surface_make_d(&d, memory + single);
    m->lobe = mu_ibl_lobe_of_f(&slopes);
    m->lobe_exact = mu_ibl_lobe_of_d(&slopes);
    m->angle = atan2(m->lobe_exact.turn[1], m->lobe_exact.turn[0]);
    m->lobe_exact.turn[0] = cos(m->angle), m->lobe_exact.turn[1] = sin(m->angle);
    return 1;
}
