/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * curves.c: what is drawn over a panel (panel.h), as x, y of points: the confidence region's boundary, the major axis,
 * samples and their radius, the extrema. In double.
 */
#include "scripts/page/numbers.h"
#include "scripts/page/panel.h"

#define PI 3.14159265358979323846

enum { DISC = 32 };

typedef struct drawing {
    const page_material *material;
    const double *wo;
    mu_ibl_settings_d settings;
    mu_ibl_axis_d axis;
    mu_ibl_space space;
    const double *frame;
    double *out;
} drawing;

static void put(drawing *d, double x, double y, double z) {
    const double length = hypot(hypot(x, y), z), m[3] = {x / length, y / length, z / length};
    page_project_normal(d->space, d->frame, d->wo, m, d->out);
    d->out += 2;
}

static void put_boundary(drawing *d, double t) {
    const mu_ibl_lobe_d *l = &d->material->lobe_exact;
    const double x = d->settings.k * l->sigma[0] * cos(t), y = d->settings.k * l->sigma[1] * sin(t);
    put(d, -(l->turn[0] * x - l->turn[1] * y), -(l->turn[1] * x + l->turn[0] * y), 1);
}

static void put_between(drawing *d, double ends[2][3], double share) {
    double m[3];
    for (int k = 0; k < 3; k++) m[k] = (1 - share) * ends[0][k] + share * ends[1][k];
    put(d, m[0], m[1], m[2]);
}

static void put_disc(drawing *d, const double m[3]) {
    const double *o = d->wo, along = m[0] * o[0] + m[1] * o[1] + m[2] * o[2];
    const double chord = fmin(d->axis.radius, 2), cosine = 1 - chord * chord / 2,
                 sine = sqrt(fmax(0, 1 - cosine * cosine));
    double w[3];
    for (int k = 0; k < 3; k++) w[k] = 2 * along * m[k] - o[k];
    const double flat = hypot(w[0], w[1]), c = flat > 1e-9 ? w[0] / flat : 1,
                 s = flat > 1e-9 ? w[1] / flat : 0;
    const double a[3] = {-s, c, 0}, b[3] = {-w[2] * c, -w[2] * s, flat};
    for (int i = 0; i < DISC; i++, d->out += 2) {
        const double phi = 2 * PI * i / DISC;
        double v[3];
        for (int k = 0; k < 3; k++) v[k] = cosine * w[k] + sine * (cos(phi) * a[k] + sin(phi) * b[k]);
        page_project_direction(v, d->frame, d->out);
    }
}

static void put_points(drawing *d) {
    mu_ibl_axis_d *a = &d->axis;
    for (int end = 0; end < 2; end++) put_between(d, a->far, end);
    for (int end = 0; end < 2; end++) put_between(d, a->near, end);
    for (int end = 0; end < 2; end++) put_boundary(d, a->t[0] + (end ? PI - a->delta : a->delta));
    put(d, 0, 0, 1);
}

int page_curve_points(const page_material *m, const double *query, int space, const double *frame, int curve,
                      int count, double *out) {
    drawing d = {.material = m, .wo = query + PAGE_WO, .settings = page_settings(query)};
    d.space = (mu_ibl_space)space, d.frame = frame, d.out = out;
    mu_ibl_axis_make_d(&m->lobe_exact, d.wo, &d.settings, &d.axis);
    if (curve == PAGE_POINTS) {
        put_points(&d);
    } else if (curve == PAGE_SAMPLED || curve == PAGE_DISCS) {
        for (size_t j = 0; j < d.settings.samples; j++) {
            double normal[3];
            mu_ibl_axis_sample_d(&d.axis, d.settings.samples, j, normal);
            if (curve == PAGE_DISCS)
                put_disc(&d, normal);
            else
                put(&d, normal[0], normal[1], normal[2]);
        }
    } else {
        for (int i = 0; i < count; i++) {
            const double share = count > 1 ? i / (count - 1.0) : 0;
            if (curve == PAGE_BOUNDARY)
                put_boundary(&d, 2 * PI * share);
            else
                put_between(&d, curve == PAGE_WHOLE ? d.axis.far : d.axis.far_clamped, share);
        }
    }
    return (int)((d.out - out) / 2);
}
