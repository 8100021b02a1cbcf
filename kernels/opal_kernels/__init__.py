# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal's spectral photon tracer and its optics, without Blender.

Importing this package loads nothing: the compiled library opens with the first scene, tables with the first look-up.
"""

__version__ = "0.1.0"
