# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Numerical stability of `musurf eval`, measured over stiff and extreme materials; see scripts/stability."""
