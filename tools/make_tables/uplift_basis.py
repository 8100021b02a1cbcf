# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve for the linear uplift basis of `opal_kernels/data/uplift_basis.npy` (needs SciPy; a minute).

    PYTHONPATH=kernels python tools/make_tables/uplift_basis.py

Three curves R, G, B on 360-830 nm with R + G + B = 1 and each in [0, 1], so that rgb(D65 * B_i) is exactly e_i: Mallett and
Yuksel 2019, "Spectral Primary Decomposition for Rendering with sRGB Reflectance". Their least-squares smoothness fixes the
curves; here the products B_i B_j and B_i B_j B_k are asked to behave as products of RGB do as well, because light that bounces
between coloured walls multiplies reflectances, and a render must look like one of an RGB renderer.

Curves are cubic B-splines with 5 nm between knots: convex weights in [0, 1] that sum to 1 make curves that do the same.
"""

from __future__ import annotations

import sys
from itertools import combinations_with_replacement
from pathlib import Path

import numpy as np
from opal_kernels.optics import colour
from scipy.interpolate import BSpline
from scipy.optimize import minimize

DATA = Path(__file__).resolve().parents[2] / "kernels" / "opal_kernels" / "data"
KNOT_NM = 5.0
SMOOTHNESS = 3e-4  # weight of the squared second differences of the spline's coefficients
VIOLET_END_NM = 400  # green reflects nothing below: the film hardly sees it there, a spectrometer would
PAIRS = list(combinations_with_replacement(range(3), 2))
TRIPLES = list(combinations_with_replacement(range(3), 3))


def spline_matrix() -> np.ndarray:
    nm = colour.WAVELENGTHS_NM
    inner = np.arange(nm[0], nm[-1] + KNOT_NM, KNOT_NM)
    knots = np.concatenate([inner[0] - KNOT_NM * np.arange(3, 0, -1), inner, inner[-1] + KNOT_NM * np.arange(1, 4)])
    return BSpline.design_matrix(nm, knots, 3).toarray()


def product_errors(basis: np.ndarray, film: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """rgb(D65 B_i B_j) - delta_ij e_i, and the same for triples; `film` (3, 471) is D65 times the response."""
    unit = np.eye(3)
    pairs = [film @ (basis[i] * basis[j]) - (unit[i] if i == j else 0) for i, j in PAIRS]
    triples = [film @ (basis[i] * basis[j] * basis[k]) - (unit[i] if i == j == k else 0) for i, j, k in TRIPLES]
    return np.array(pairs), np.array(triples)


def multiplicity(indices) -> float:
    """How often a product occurs among ordered ones."""
    return {1: 1, 2: 2 if len(indices) == 2 else 3, 3: 6}[len(set(indices))]


def solve(smoothness: float = SMOOTHNESS) -> np.ndarray:
    film = colour.rec709_response() * colour.white()
    splines = spline_matrix()
    n = splines.shape[1]
    pair_weight = np.array([multiplicity(p) for p in PAIRS])[:, None]
    triple_weight = 0.3 * np.array([multiplicity(t) for t in TRIPLES])[:, None]
    second = np.diff(np.eye(n), 2, axis=0)

    def curves(c):
        red, green = c[:n], c[n:]
        return np.array([red, green, 1 - red - green])

    def objective(c, bend_weight):
        coefficients = curves(c)
        basis = coefficients @ splines.T
        pairs, triples = product_errors(basis, film)
        bend = coefficients @ second.T
        value = (pair_weight * pairs**2).sum() + (triple_weight * triples**2).sum() + bend_weight * (bend**2).sum()
        gradient = np.zeros_like(basis)
        for (i, j), weight, error in zip(PAIRS, pair_weight, pairs, strict=True):
            slope = 2 * weight * (error @ film)
            gradient[i] += slope * basis[j]
            gradient[j] += slope * basis[i]
        for (i, j, k), weight, error in zip(TRIPLES, triple_weight, triples, strict=True):
            slope = 2 * weight * (error @ film)
            gradient[i] += slope * basis[j] * basis[k]
            gradient[j] += slope * basis[i] * basis[k]
            gradient[k] += slope * basis[i] * basis[j]
        full = gradient @ splines + 2 * bend_weight * bend @ second
        return value, np.concatenate([full[0] - full[2], full[1] - full[2]])

    seen = film @ splines  # rgb of each spline under D65
    round_trip = np.block([[seen, np.zeros_like(seen)], [np.zeros_like(seen), seen]])
    target = np.concatenate([np.eye(3)[0], np.eye(3)[1]])
    constraints = [
        {"type": "eq", "fun": lambda c: round_trip @ c - target, "jac": lambda c: round_trip},
        {"type": "ineq", "fun": lambda c: 1 - c[:n] - c[n:], "jac": lambda c: -np.hstack([np.eye(n), np.eye(n)])},
    ]
    centre = 360 + KNOT_NM * (np.arange(n) - 1)
    step = 1 / (1 + np.exp(-(centre - 590) / 10))
    low = 1 / (1 + np.exp((centre - 490) / 10))
    start = np.concatenate([step, 1 - step - low]).clip(0, 1)
    for weight in (10 * smoothness, 3 * smoothness, smoothness):  # from smooth to wanted: fewer local minima on the way
        result = minimize(
            objective,
            start,
            args=(weight,),
            jac=True,
            method="SLSQP",
            bounds=[(0, 1)] * n + [(0, 0 if nm < VIOLET_END_NM else 1) for nm in centre],
            constraints=constraints,
            options={"maxiter": 600, "ftol": 1e-12},
        )
        start = result.x
        print(f"{result.message}: {result.fun:.6g} after {result.nit} steps", file=sys.stderr)
    return curves(start) @ splines.T


def report(name: str, basis: np.ndarray) -> None:
    film = colour.rec709_response() * colour.white()
    pairs, triples = product_errors(basis, film)
    print(
        f"{name:16} round trip {abs(basis @ film.T - np.eye(3)).max():.1e}  range [{basis.min():.4f}, {basis.max():.4f}]"
        f"  pairs rms {np.sqrt((pairs**2).mean()):.4f} max {abs(pairs).max():.4f}"
        f"  triples rms {np.sqrt((triples**2).mean()):.4f} max {abs(triples).max():.4f}"
        f"  steepest {abs(np.diff(basis)).max():.4f}/nm"
    )


def mallett_yuksel() -> np.ndarray:
    import colour as colour_science

    table = colour_science.recovery.MSDS_BASIS_FUNCTIONS_sRGB_MALLETT2019
    return np.array([np.interp(colour.WAVELENGTHS_NM, table.wavelengths, table.values[:, i]) for i in range(3)])


if __name__ == "__main__":
    basis = solve(float(sys.argv[1]) if len(sys.argv) > 1 else SMOOTHNESS)
    report("Opal", basis)
    try:
        report("Mallett-Yuksel", mallett_yuksel())
    except ImportError:
        print("(colour-science is not installed: no comparison)")
    if len(sys.argv) == 1:
        np.save(DATA / "uplift_basis.npy", basis.clip(0, 1))
