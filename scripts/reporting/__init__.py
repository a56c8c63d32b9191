# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Makes one self-contained page of rendered plates, the cross-check, versions and command lines."""
