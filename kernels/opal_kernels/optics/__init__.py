# SPDX-License-Identifier: GPL-3.0-or-later
"""The readable reference of Opal's physics, in NumPy: the C++ tracer is tested against these modules.

Modules load one by one (``from opal_kernels.optics import colour``); importing this package loads none.
Wavelengths are nm (µm only inside dispersion formulas), angles radians, lengths metres unless a name says otherwise.
"""
