# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What masking and samplers are worth: Figures 9 and 10 of Microsurface Transformations measured through the command musurf."""
