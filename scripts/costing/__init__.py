# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What accuracy costs on explicit surfaces: error against time and memory by grid, points, realisations, images and tracers."""
