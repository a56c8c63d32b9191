# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Renders the paper's Figures 6, 7 and 8 again, and a balloon as it is inflated."""
