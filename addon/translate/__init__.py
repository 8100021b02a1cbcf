# SPDX-License-Identifier: GPL-3.0-or-later
"""From Blender's evaluated scene to the kernels' scene, one subject a module."""
