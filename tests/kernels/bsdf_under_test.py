# SPDX-License-Identifier: GPL-3.0-or-later
"""One shader node's closures through ``include/opal_test_bsdf.h``, and directions to try them with."""

from __future__ import annotations

import ctypes
from ctypes import POINTER, byref, c_float, c_int32, c_uint32

import numpy as np
from opal_kernels import binding

N_WAVELENGTHS = 8
NODES = ("DIFFUSE", "TRANSLUCENT", "GLOSSY", "GLASS", "REFRACTION", "TRANSPARENT", "SHEEN", "METAL_F82", "CONDUCTOR", "PRINCIPLED", "GEM")
REFLECT, TRANSMIT, DIFFUSE, GLOSSY, SPECULAR, STRAIGHT, DISPERSIVE = (1 << i for i in range(7))

PRINCIPLED = {
    "metallic": 0, "alpha": 1, "diffuse_roughness": 0, "subsurface": 0, "specular": 0.5, "transmission": 0, "coat": 0,
    "coat_roughness": 0.03, "coat_ior": 1.5, "sheen": 0, "sheen_roughness": 0.5, "emission": 0,
    "specular_tint": (1, 1, 1), "coat_tint": (1, 1, 1), "sheen_tint": (1, 1, 1),
}  # fmt: skip

_float_p = POINTER(c_float)


class Description(ctypes.Structure):
    _fields_ = [
        *((name, c_int32) for name in ("node", "multiscatter", "backfacing", "schlick", "flux")),
        *((name, c_float * 3) for name in ("wo", "geometric_normal", "shading_normal", "normal", "tangent", "color", "color_2")),
        *((name, c_float) for name in ("roughness", "ior", "anisotropy", "rotation")),
        ("eta", c_float * N_WAVELENGTHS),
        ("principled", c_float * 21),
    ]


def direction(theta: float, phi: float = 0) -> np.ndarray:
    """Unit vector at ``theta`` degrees from z and ``phi`` degrees round it."""
    t, p = np.radians([theta, phi])
    return np.array([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)])


def points(n: int, dimensions: int = 3) -> np.ndarray:
    """Evenly spread points of the unit cube (Roberts 2018, the R sequence), shape (n, dimensions), float32 below 1."""
    phi = 2.0
    for _ in range(40):
        phi = (1 + phi) ** (1 / (dimensions + 1))
    steps = np.array([(1 / phi) ** (i + 1) % 1 for i in range(dimensions)])
    return np.minimum((0.5 + np.arange(n)[:, None] * steps) % 1, 1 - 2**-24).astype(np.float32)


class Bsdf:
    """A node's closures seen from ``wo``; further keywords are the fields of the description or sockets of the Principled BSDF."""

    def __init__(self, node: str, wo=(0, 0, 1), **fields):
        self.fields = {"node": node, "wo": wo, **fields}
        d = self.description = Description(node=NODES.index(node), ior=1.5, roughness=0)
        d.geometric_normal[:] = d.shading_normal[:] = (0, 0, 1)
        d.color[:] = d.color_2[:] = (1, 1, 1)
        d.wo[:] = wo
        d.eta[:] = [1.5] * N_WAVELENGTHS
        sockets = dict(PRINCIPLED)
        for name, value in fields.items():
            if name in sockets:
                sockets[name] = value
            elif np.ndim(value):
                getattr(d, name)[:] = [float(x) for x in value]
            else:
                setattr(d, name, value)
        d.principled[:] = np.hstack(list(sockets.values())).tolist()
        self._library = binding.library()

    def but(self, **fields) -> Bsdf:
        """The same with some fields changed."""
        return Bsdf(**{**self.fields, **fields})

    def eval(self, wi, rough_only: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """f |cos| and pdf, each of shape (n, 8)."""
        wi = np.ascontiguousarray(np.atleast_2d(wi), np.float32)
        value, pdf = (np.empty((len(wi), N_WAVELENGTHS), np.float32) for _ in range(2))
        self._library.opal_test_bsdf_eval(
            byref(self.description),
            len(wi),
            wi.ctypes.data_as(_float_p),
            int(rough_only),
            *(a.ctypes.data_as(_float_p) for a in (value, pdf)),
        )
        return value.astype(float), pdf.astype(float)

    def sample(self, u) -> dict[str, np.ndarray]:
        """wi (n, 3), weight and pdf (n, 8), scattering and eta (n,); scattering is 0 where there is no sample."""
        u = np.ascontiguousarray(u, np.float32)
        out = {k: np.empty((len(u), w), np.float32) for k, w in (("wi", 3), ("weight", N_WAVELENGTHS), ("pdf", N_WAVELENGTHS))}
        scattering, eta = np.empty(len(u), np.uint32), np.empty(len(u), np.float32)
        self._library.opal_test_bsdf_sample(
            byref(self.description), len(u), u.ctypes.data_as(_float_p), *(a.ctypes.data_as(_float_p) for a in out.values()),
            scattering.ctypes.data_as(POINTER(c_uint32)), eta.ctypes.data_as(_float_p),
        )  # fmt: skip
        return {**{k: v.astype(float) for k, v in out.items()}, "scattering": scattering, "eta": eta.astype(float)}

    def summary(self) -> dict[str, np.ndarray | float | int]:
        out = np.empty(10, np.float32)
        count = self._library.opal_test_bsdf_summary(byref(self.description), out.ctypes.data_as(_float_p))
        return {"emission": out[:3], "transparency": out[3:6], "albedo": out[6:9], "sample_weight": float(out[9]), "lobes": count}

    def furnace(self, n: int = 1 << 14) -> np.ndarray:
        """What comes back of radiance 1 from everywhere, shape (8,)."""
        return self.sample(points(n))["weight"].mean(axis=0)
