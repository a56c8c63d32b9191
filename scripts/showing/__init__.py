# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Pictures for the report of what musurf makes: surfaces with their slopes, and lobes of the BRDF."""
