# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Meshes of the figures' scenes, made by formulas: rubber animals in poses, a balloon as it is inflated, a vase, a teapot."""
