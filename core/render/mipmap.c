/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* mipmap.c: levels by area, and look-ups. A mean is taken of differences to one of its values: of equal ones it is that. */
#include "core/render/mipmap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PROBES = 16 };

_Bool mu_mipmap_make(mu_mipmap *mipmap, int width, int height, int channels, mu_wrap wrap) {
    size_t count = 0;
    *mipmap = (mu_mipmap){.channels = channels, .wrap = wrap};
    for (int w = width, h = height; mipmap->levels < MU_MIPMAP_LEVELS; w = (w + 1) / 2, h = (h + 1) / 2) {
        const int i = mipmap->levels++;
        mipmap->level[i].width = w, mipmap->level[i].height = h, mipmap->level[i].at = count;
        count += (size_t)w * (size_t)h * (size_t)channels;
        if (w == 1 && h == 1) break;
    }
    mipmap->texels = malloc(count * sizeof *mipmap->texels);
    return mipmap->texels != NULL;
}

void mu_mipmap_free(mu_mipmap *mipmap) {
    free(mipmap->texels);
    *mipmap = (mu_mipmap){.channels = 0};
}

size_t mu_mipmap_bytes(const mu_mipmap *mipmap) {
    if (!mipmap->levels) return 0;
    return (mipmap->level[mipmap->levels - 1].at + (size_t)mipmap->channels) * sizeof *mipmap->texels;
}

/* The texels of `fine` that lie under texel i of `coarse`: the first, how many, and the share of each. */
static int shares(int fine, int coarse, int i, int *first, double share[4]) {
    const double ratio = (double)fine / coarse, from = i * ratio, to = (i + 1) * ratio;
    int count = 0;
    *first = (int)from;
    for (int k = *first; k < fine && k < to && count < 4; k++)
        share[count++] = fmin(to, k + 1) - fmax(from, k);
    return count;
}

static void shrink(mu_mipmap *p, int level) {
    const float *from = p->texels + p->level[level - 1].at;
    float *to = p->texels + p->level[level].at;
    const int width = p->level[level].width, height = p->level[level].height,
              fine = p->level[level - 1].width;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double across[4], down[4];
            int left, top;
            const int columns = shares(fine, width, x, &left, across),
                      rows = shares(p->level[level - 1].height, height, y, &top, down);
            for (int c = 0; c < p->channels; c++) {
                const float *at =
                    from + ((size_t)top * (size_t)fine + (size_t)left) * (size_t)p->channels + c;
                const double first = (double)*at;
                double sum = 0, weight = 0;
                for (int j = 0; j < rows; j++)
                    for (int i = 0; i < columns; i++) {
                        const size_t step = ((size_t)j * (size_t)fine + (size_t)i) * (size_t)p->channels;
                        sum += across[i] * down[j] * ((double)at[step] - first);
                        weight += across[i] * down[j];
                    }
                *to++ = (float)(first + sum / weight);
            }
        }
}

void mu_mipmap_build(mu_mipmap *mipmap) {
    for (int level = 1; level < mipmap->levels; level++) shrink(mipmap, level);
}

/* Into [0, 1]. */
static double wrapped(mu_wrap wrap, double x) {
    if (!isfinite(x)) return 0;
    if (wrap == MU_WRAP_CLAMP) return fmin(fmax(x, 0), 1);
    if (wrap == MU_WRAP_MIRROR) return fabs(x - 2 * nearbyint(x / 2));
    return x - floor(x);
}

/* The two texels around x of `count`, and how far it is from the first to the second. */
static double neighbours(mu_wrap wrap, double x, int count, int at[2]) {
    const double place = x * count - 0.5, first = floor(place);
    at[0] = (int)first, at[1] = at[0] + 1;
    if (at[0] < 0) at[0] = wrap == MU_WRAP_REPEAT ? count - 1 : 0;
    if (at[1] >= count) at[1] = wrap == MU_WRAP_REPEAT ? 0 : count - 1;
    return place - first;
}

static void bilinear(const mu_mipmap *p, int level, double u, double v, double *out) {
    const int width = p->level[level].width, height = p->level[level].height;
    int x[2], y[2];
    const double s = neighbours(p->wrap, wrapped(p->wrap, u), width, x),
                 t = neighbours(p->wrap, 1 - wrapped(p->wrap, v), height, y);
    const float *corner[4];
    for (int k = 0; k < 4; k++)
        corner[k] = p->texels + p->level[level].at +
                    ((size_t)y[k / 2] * (size_t)width + (size_t)x[k % 2]) * (size_t)p->channels;
    for (int c = 0; c < p->channels; c++) {
        const double a = (double)corner[0][c], b = (double)corner[2][c];
        const double top = a + s * ((double)corner[1][c] - a), bottom = b + s * ((double)corner[3][c] - b);
        out[c] = top + t * (bottom - top);
    }
}

static void trilinear(const mu_mipmap *p, double level, double u, double v, double *out) {
    double coarse[MU_MIPMAP_CHANNELS];
    const int first = (int)level;
    bilinear(p, first, u, v, out);
    if (level == first) return;
    bilinear(p, first + 1, u, v, coarse);
    for (int c = 0; c < p->channels; c++) out[c] += (level - first) * (coarse[c] - out[c]);
}

/* Of the ellipse of these two half-axes: the radii, larger first, and the direction of that. */
static void ellipse(const double a[4], double radius[2], double along[2]) {
    const double xx = a[0] * a[0] + a[2] * a[2], yy = a[1] * a[1] + a[3] * a[3],
                 xy = a[0] * a[1] + a[2] * a[3];
    const double mean = (xx + yy) / 2, spread = hypot((xx - yy) / 2, xy),
                 angle = atan2(xy, (xx - yy) / 2) / 2;
    radius[0] = sqrt(mean + spread);
    radius[1] = fabs(a[0] * a[3] - a[1] * a[2]) / radius[0]; /* their product is the area's */
    along[0] = cos(angle), along[1] = sin(angle);
}

/* The coarsest level whose footprint, two of its texels, varies by no more; -1 if that of level `from` does not. */
static int kept_within(const mu_mipmap *p, const double uv[2], double from, const mu_mipmap_limit *limit) {
    const double last = p->levels - 1;
    double found[MU_MIPMAP_CHANNELS];
    trilinear(p, fmin(from + 1, last), uv[0], uv[1], found);
    if (found[limit->channel] <= limit->most) return -1;
    int level = (int)fmin(ceil(from), last - 1);
    for (; level > 0; level--) {
        bilinear(p, level + 1, uv[0], uv[1], found);
        if (found[limit->channel] <= limit->most) break;
    }
    return level > 0 ? level : 0;
}

/* The mean of `probes` along the ellipse. */
static void along_axis(const mu_mipmap *p, const double uv[2], double level, int probes, const double step[2],
                       double *out) {
    double sum[MU_MIPMAP_CHANNELS] = {0}, probe[MU_MIPMAP_CHANNELS];
    for (int i = 0; i < probes; i++) {
        const double t = (2 * i + 1) / (double)probes - 1;
        trilinear(p, level, uv[0] + t * step[0], uv[1] + t * step[1], probe);
        for (int c = 0; c < p->channels; c++) sum[c] += probe[c] - out[c];
    }
    for (int c = 0; c < p->channels; c++) out[c] += sum[c] / probes;
}

void mu_mipmap_at(const mu_mipmap *mipmap, const double uv[2], const double axes[4],
                  const mu_mipmap_limit *limit, double *out) {
    const double width = mipmap->level[0].width, height = mipmap->level[0].height, last = mipmap->levels - 1;
    double radius[2] = {0, 0}, along[2] = {0, 0};
    if (axes)
        ellipse((const double[4]){axes[0] * width, axes[1] * height, axes[2] * width, axes[3] * height},
                radius, along);
    if (axes && !(radius[0] < 1e9)) radius[0] = radius[1] = 1e9;
    if (!(radius[0] > 0)) radius[0] = radius[1] = 0;
    /* A texel of the level is half as wide as the footprint: with the probe's own width (variance 1/4 of a texel's
     * square) that is a footprint's, w^2 / 16 for the w^2 / 12 of a box. */
    const double least = fmax(radius[1], 1);
    const int probes = (int)fmin(fmax(ceil(radius[0] / least), 1), MOST_PROBES);
    const double level = fmin(fmax(log2(fmax(least, radius[0] / probes)), 0), last);
    const int kept = limit && radius[0] > 0.5 ? kept_within(mipmap, uv, log2(fmax(radius[0], 1)), limit) : -1;
    trilinear(mipmap, kept >= 0 ? fmin(kept, level) : level, uv[0], uv[1], out);
    if (probes > 1 && kept < 0)
        along_axis(mipmap, uv, level, probes,
                   (const double[2]){radius[0] * along[0] / width, radius[0] * along[1] / height}, out);
}
