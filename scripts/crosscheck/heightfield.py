# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Periodic Gaussian heightfields whose facets have Beckmann slopes, and the facets themselves.

A heightfield is h[i, j], i along x, j along y, N x N, periodic, cell size 1. Each cell splits along (i+1,j)-(i,j+1)
into L = (i,j),(i+1,j),(i,j+1) and U = (i+1,j+1),(i,j+1),(i+1,j). Facet arrays are [i, j, 0 for L or 1 for U].
"""
import numpy as np


def spectrum(n, correlation, tilt):
    """Power per mode of the autocorrelation exp(-r^2/correlation^2), tilted by exp(tilt kx ky); no mean."""
    k = 2 * np.pi * np.fft.fftfreq(n)
    kx, ky = k[:, None], k[None, :]
    power = np.exp(-(correlation**2) / 4 * (kx**2 + ky**2 + tilt * kx * ky))
    power[0, 0] = 0
    return power


def facet_covariance(power):
    """<sx sx> and <sx sy> of the facets' slopes, the differences of neighbouring heights, from the power of each mode."""
    k = 2 * np.pi * np.fft.fftfreq(len(power))
    dx, dy = np.exp(1j * k)[:, None] - 1, np.exp(1j * k)[None, :] - 1
    return np.sum(power * abs(dx) ** 2), np.sum(power * (dx * np.conj(dy)).real)


def isotropic_spectrum(n, alpha, correlation):
    """Power per mode such that facet slopes have covariance alpha^2/2 times the identity, exactly.

    sx and sy of one facet are differences that share a corner, which correlates them by about 1/(2 correlation^2) on
    an isotropic spectrum; the tilt that cancels this is found by bisection.
    """
    low, high = 0.0, 1.0
    for _ in range(60):
        tilt = (low + high) / 2
        low, high = (tilt, high) if facet_covariance(spectrum(n, correlation, tilt))[1] > 0 else (low, tilt)
    power = spectrum(n, correlation, tilt)
    return power * (alpha**2 / 2 / facet_covariance(power)[0])


def make(n, alpha, correlation, seed):
    """A heightfield of fixed spectrum and random phases: every realisation has the slope covariance exactly.

    The sum of many modes of random phase is Gaussian up to an excess kurtosis of about -1/(number of modes).
    """
    noise = np.fft.fft2(np.random.default_rng(seed).standard_normal((n, n)))
    return np.fft.ifft2(np.sqrt(isotropic_spectrum(n, alpha, correlation)) * noise / abs(noise) * n * n).real


def quantise(h):
    """The heights rounded to the 65536 levels of a 16-bit image, and (levels, lowest, highest)."""
    lowest, highest = float(h.min()), float(h.max())
    step = (highest - lowest) / 65535 if highest > lowest else 1.0
    levels = np.rint((h - lowest) / step).astype(np.uint16)
    return lowest + step * levels, (levels, lowest, lowest + step * 65535)


def slopes(h):
    """dh/dx and dh/dy of every facet, [2, i, j, L|U]."""
    h10, h01 = np.roll(h, -1, 0), np.roll(h, -1, 1)
    h11 = np.roll(h10, -1, 1)
    return np.stack([np.stack([h10 - h, h11 - h01], -1), np.stack([h01 - h, h11 - h10], -1)])
