# SPDX-License-Identifier: GPL-3.0-or-later
"""What a phase function's sampler draws is the phase function: chi-squared over direction, p > 0.001 (PHYSICS §5.14)."""

import ctypes
import math

import numpy as np
import pytest
from opal_kernels import binding, droplets
from opal_kernels.descriptions import Phase, PhaseKind
from opal_kernels.droplets import Drops
from opal_kernels.scene import Scene

N = 400_000
BOWS = droplets.phase(Drops("AIRY", 250.0))
PHASES = {
    "isotropic": Phase(),
    "forward": Phase(kind=PhaseKind.HENYEY_GREENSTEIN, anisotropy=0.85),
    "backward": Phase(kind=PhaseKind.HENYEY_GREENSTEIN, anisotropy=-0.4),
    "rayleigh": Phase(kind=PhaseKind.RAYLEIGH),
    "airy": BOWS,
    "corona": droplets.phase(Drops("MIE", 4.0, spread=0.1, diffraction=True)),
}


def sampled(phase, nm, seed=1):
    """Directions (N, 3), densities and values of N samples of light along +Z."""
    u = np.random.default_rng(seed).random((N, 3), np.float32) * np.float32(1 - 2**-24)
    direction, density, value = np.empty((N, 3), np.float32), np.empty(N, np.float32), np.empty(N, np.float32)
    pointers = [a.ctypes.data_as(ctypes.POINTER(ctypes.c_float)) for a in (u, direction, density, value)]
    with Scene(threads=1) as scene:
        number = binding.scene_add_phase(scene.handle, phase)
        call = binding.library().opal_test_sample_phase
        call.restype = ctypes.c_int32
        handle = ctypes.c_void_p(scene.handle)
        assert call(handle, ctypes.c_int32(number), ctypes.c_float(nm), ctypes.c_int64(N), *pointers) == 0
    return direction.astype(float), density.astype(float), value.astype(float)


def survival(chi2, degrees):
    """P(chi-squared > chi2), by Wilson and Hilferty's normal approximation."""
    z = ((chi2 / degrees) ** (1 / 3) - (1 - 2 / (9 * degrees))) / math.sqrt(2 / (9 * degrees))
    return 0.5 * math.erfc(z / math.sqrt(2))


@pytest.mark.parametrize("nm", [431.0, 550.0])
@pytest.mark.parametrize("name", PHASES)
def test_samples_follow_the_phase_function(name, nm):
    phase = PHASES[name]
    direction, density, value = sampled(phase, nm)
    np.testing.assert_allclose(density, value, rtol=2e-5)
    np.testing.assert_allclose(np.linalg.norm(direction, axis=1), 1, atol=1e-5)
    # Cells of equal probability over the cosine, from the density itself; the table's own by its trapezoids.
    cosine = np.clip(direction[:, 2], -1, 1)
    if phase.values is not None:
        rows = np.array([np.interp(nm, phase.wavelengths, column) for column in np.asarray(phase.values).T])[::-1]
        nodes = np.cos(np.asarray(phase.angles, float))[::-1]
        cumulative = np.concatenate([[0], np.cumsum((rows[1:] + rows[:-1]) / 2 * np.diff(nodes))])
        edges = nodes[:: max(1, len(nodes) // 300)]
        edges = np.append(edges[edges < 1], 1.0)
        mass = np.interp(edges, nodes, cumulative / cumulative[-1])
    else:
        edges = np.linspace(-1, 1, 201)
        g = phase.anisotropy
        if phase.kind == PhaseKind.ISOTROPIC:
            mass = (edges + 1) / 2
        elif phase.kind == PhaseKind.RAYLEIGH:
            mass = 0.5 + 0.375 * edges + 0.125 * edges**3
        else:
            mass = (1 - g * g) / (2 * g) * (1 / np.sqrt(1 + g * g - 2 * g * edges) - 1 / (1 + g))
    expected = np.diff(mass) * N
    found = np.histogram(cosine, edges)[0]
    keep = expected > 20
    chi2 = ((found - expected)[keep] ** 2 / expected[keep]).sum()
    assert survival(chi2, keep.sum() - 1) > 1e-3, f"chi2 {chi2:.0f} of {keep.sum() - 1} degrees"
    # Round the axis every azimuth is alike.
    turns = np.histogram(np.arctan2(direction[:, 1], direction[:, 0]), 36, (-np.pi, np.pi))[0]
    chi2 = ((turns - N / 36) ** 2 / (N / 36)).sum()
    assert survival(chi2, 35) > 1e-3
