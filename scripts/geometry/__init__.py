# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A plate of explicit mirror facets in POV-Ray beside the same plate with the fitted material in musurf."""
