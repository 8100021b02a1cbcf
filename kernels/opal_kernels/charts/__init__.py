# SPDX-License-Identifier: GPL-3.0-or-later
"""Charts drawn with NumPy alone, so that they need nothing that Blender does not bring."""
