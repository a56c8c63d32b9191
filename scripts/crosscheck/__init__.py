# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Cross-check of musurf with POV-Ray: explicit heightfield microsurfaces, their linear images, and what is seen of them.

Frame: macrosurface normal +z, heights along z, cells of size 1, arrays indexed [i, j] with i along x and j along y.
Equation numbers are those of *Microsurface Transformations* (Atanasov et al. 2022).
"""
