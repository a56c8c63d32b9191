/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * prefilter.c: filtered importance sampling (Krivanek and Colbert 2008; Lagarde and de Rousiers 2014), after Section 3.
 *
 * A half vector of polar angle t drawn from D cos t reflects to the polar angle 2 t with the density D / 4 per steradian, for
 * the view is the normal. With a = alpha² and the uniform number x, tan² t = a x / (1 - x); then
 *     D = (1 + tan² t)² / (pi a (1 + tan² t / a)²) = (1 + tan² t)² (1 - x)² / (pi a).
 * The cosine to the lobe's middle, cos 2 t = (1 - tan² t) / (1 + tan² t), is the weight.
 */
#include "core/ibl/prefilter.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 24

/* The average over [first, last] of a row or column that is constant in each of `count` cells, in the measure `bound`. */
typedef double bound_of(double place);

static double even_bound(double place) {
    return place;
}
static double polar_bound(double place) {
    const double s = sin(PI / 2 * place); /* (1 - cos(pi place)) / 2 without cancellation */
    return s * s;
}

/* Adds the share of cell k of `count` in [first, last] (places from 0 to 1). */
static double share_of(size_t k, size_t count, double first, double last, bound_of *bound) {
    const double low = fmax((double)k / (double)count, first),
                 high = fmin((double)(k + 1) / (double)count, last);
    return high > low ? (bound(high) - bound(low)) / (bound(last) - bound(first)) : 0;
}

void mu_ibl_average(const mu_ibl_image *from, mu_ibl_image *to) {
    for (size_t j = 0; j < to->height; j++) {
        const double top = (double)j / (double)to->height, bottom = (double)(j + 1) / (double)to->height;
        for (size_t i = 0; i < to->width; i++) {
            const double left = (double)i / (double)to->width, right = (double)(i + 1) / (double)to->width;
            double sum[3] = {0, 0, 0}, all = 0;
            for (size_t y = j * from->height / to->height;
                 y < from->height && (double)y < bottom * (double)from->height; y++) {
                const double tall = share_of(y, from->height, top, bottom, polar_bound);
                for (size_t x = i * from->width / to->width;
                     x < from->width && (double)x < right * (double)from->width; x++) {
                    const double share = tall * share_of(x, from->width, left, right, even_bound);
                    const float *pixel = from->rgb + 3 * (y * from->width + x);
                    for (int c = 0; c < 3; c++) sum[c] += share * (double)pixel[c];
                    all += share;
                }
            }
            for (int c = 0; c < 3; c++) to->rgb[3 * (j * to->width + i) + (size_t)c] = (float)(sum[c] / all);
        }
    }
}

static size_t halved(size_t side, size_t level) {
    return side >> level > 1 ? side >> level : 1;
}

size_t mu_ibl_pyramid_floats(size_t width, size_t height) {
    size_t sum = 0;
    for (size_t l = 0; l < MU_IBL_LEVELS_MOST; l++) {
        sum += 3 * halved(width, l) * halved(height, l);
        if (halved(width, l) * halved(height, l) == 1) break;
    }
    return sum;
}

void mu_ibl_pyramid_lay(mu_ibl_pyramid *p, size_t width, size_t height, float *memory) {
    p->levels = 0;
    while (p->levels < MU_IBL_LEVELS_MOST) {
        const mu_ibl_image image = {halved(width, p->levels), halved(height, p->levels), memory};
        p->level[p->levels++] = image;
        memory += 3 * image.width * image.height;
        if (image.width * image.height == 1) break;
    }
}

/* Around in u, and held at the poles in v. */
static void bilinear(const mu_ibl_image *image, float u, float v, float share, float rgb[3]) {
    const float x = u * (float)image->width - 0.5f, y = v * (float)image->height - 0.5f;
    const float left = floor(x), top = floor(y), s = x - left, t = y - top;
    const long w = (long)image->width, h = (long)image->height;
    const long i = ((long)left % w + w) % w, k = (i + 1) % w;
    const long above = (long)top < 0    ? 0
                       : (long)top >= h ? h - 1
                                        : (long)top,
               below = (long)top + 1 >= h  ? h - 1
                       : (long)top + 1 < 0 ? 0
                                           : (long)top + 1;
    const float *a = image->rgb + 3 * (above * w + i), *b = image->rgb + 3 * (above * w + k);
    const float *c = image->rgb + 3 * (below * w + i), *d = image->rgb + 3 * (below * w + k);
    for (int n = 0; n < 3; n++)
        rgb[n] += share * ((1 - t) * ((1 - s) * a[n] + s * b[n]) + t * ((1 - s) * c[n] + s * d[n]));
}

void mu_ibl_lookup(const mu_ibl_pyramid *p, const float w[3], float level, float rgb[3]) {
    const float flat = hypot(w[0], w[1]);
    const float u = 0.5f - atan2(w[1], w[0]) * (float)(0.5 / PI), v = atan2(flat, w[2]) * (float)(1 / PI);
    const size_t low = (size_t)larger(0, smaller(level, (float)(p->levels - 1)));
    const float share = low + 1 < p->levels ? larger(level - (float)low, 0) : 0;
    rgb[0] = rgb[1] = rgb[2] = 0;
    bilinear(&p->level[low], u, v, 1 - share, rgb);
    if (share > 0) bilinear(&p->level[low + 1], u, v, share, rgb);
}

/* Van der Corput's sequence in base 2. */
static double mirrored_bits(size_t i) {
    double place = 0, digit = 0.5;
    for (; i; i >>= 1, digit /= 2) place += (i & 1) ? digit : 0;
    return place;
}

size_t mu_ibl_taps(float alpha, size_t count, size_t height, size_t levels, mu_ibl_tap *taps) {
    const double a = (double)alpha * (double)alpha, pixel = PI / (double)height * (PI / (double)height);
    size_t kept = 0;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const double x = ((double)i + 0.5) / (double)count, phi = 2 * PI * mirrored_bits(i);
        const double tan2 = a * x / (1 - x), cosine = (1 - tan2) / (1 + tan2),
                     sine = 2 * sqrt(tan2) / (1 + tan2);
        if (!(cosine > 0)) continue;
        const double density = (1 + tan2) * (1 - x) * (1 + tan2) * (1 - x) / (4 * PI * a);
        const double level = log2(1 / ((double)count * density) / pixel) / 2;
        taps[kept++] = (mu_ibl_tap){{(float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)cosine},
                                    (float)cosine,
                                    (float)fmin(fmax(level, 0), (double)(levels - 1))};
        sum += cosine;
    }
    for (size_t i = 0; i < kept; i++) taps[i].weight = (float)((double)taps[i].weight / sum);
    return kept;
}

void mu_ibl_filter_row(const mu_ibl_pyramid *p, size_t taps, const mu_ibl_tap *tap, size_t row,
                       mu_ibl_image *out) {
    const double theta = PI * ((double)row + 0.5) / (double)out->height;
    const float c = (float)cos(theta), s = (float)sin(theta);
    for (size_t i = 0; i < out->width; i++) {
        const double phi = 2 * PI * (0.5 - ((double)i + 0.5) / (double)out->width);
        const float x = (float)cos(phi), y = (float)sin(phi);
        double sum[3] = {0, 0, 0};
        for (size_t k = 0; k < taps; k++) { /* x of the frame points down the meridian, y east */
            const float *l = tap[k].local, down = c * l[0] + s * l[2];
            const float w[3] = {down * x - l[1] * y, down * y + l[1] * x, c * l[2] - s * l[0]};
            float rgb[3];
            mu_ibl_lookup(p, w, tap[k].level, rgb);
            for (int n = 0; n < 3; n++) sum[n] += (double)(tap[k].weight * rgb[n]);
        }
        for (int n = 0; n < 3; n++) out->rgb[3 * (row * out->width + i) + (size_t)n] = (float)sum[n];
    }
}

#endif
