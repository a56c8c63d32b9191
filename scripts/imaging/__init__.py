# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What techniques of image-based lighting cost and how far their pictures are from the path-traced truth."""
