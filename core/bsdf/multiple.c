/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* multiple.c: makes what a surface keeps for multiple scattering. */
#include "core/bsdf/multiple.h"

size_t MU(multiple_bytes)(const mu_definition *d) {
    if (d->multiple == MU_SINGLE) return 0;
    const size_t head = padded(sizeof(multiple));
    if (d->multiple == MU_RANDOM_WALK || d->compensation_borrows) return head;
    return head + padded(mu_albedo_set_bytes(d));
}

/* 2 F(mu) mu dmu, the F_avg of Kulla & Conty 2017, by the midpoint rule: 1e-4 and better, kinks at the critical angle included. */
static void average_fresnel(const fresnel *f, real eta, real out[3]) {
    double sum[3] = {0};
    const int count = 256;
    for (int i = 0; i < count; i++) {
        real F[3];
        const double mu = (i + 0.5) / count;
        MU(fresnel_eval)(f, eta, R(mu), F);
        for (int k = 0; k < 3; k++) sum[k] += (double)F[k] * 2 * mu / count;
    }
    for (int k = 0; k < 3; k++) out[k] = R(sum[k]);
}

void MU(multiple_average)(const surface *s, real average[3]) {
    average_fresnel(&s->fresnel, s->fresnel.a[0], average);
    if (!s->transmission) return;
    real below[3];
    average_fresnel(&s->fresnel, 1 / s->fresnel.a[0], below);
    average[1] = below[0];
}

void MU(multiple_make)(surface *s, const mu_definition *d) {
    if (d->multiple == MU_SINGLE) return;
    char *memory = (char *)s + surface_head_bytes();
    multiple *m = (void *)memory;
    *m = (multiple){.salt = d->salt, .tables = d->compensation_borrows ? d->compensation_tables : NULL};
    MU(multiple_average)(s, m->average);
    if (d->multiple == MU_RANDOM_WALK || d->compensation_borrows) return;
    mu_albedo_set *tables = (void *)(memory + padded(sizeof *m));
    mu_albedo_set_make(d, tables);
    m->tables = tables;
}
