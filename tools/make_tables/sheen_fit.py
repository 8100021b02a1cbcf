# SPDX-License-Identifier: GPL-3.0-or-later
"""Make `kernels/src/bsdf/sheen_fit.inc`: polynomials through the published parameters of the sheen lobe.

    python tools/make_tables/sheen_fit.py shader.tables > kernels/src/bsdf/sheen_fit.inc

`shader.tables` is `src/scene/shader.tables` of Cycles' sources, whose `table_sheen_ltc` holds the parameters that Zeltner,
Burley and Chiang 2022 ("Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines") published: a, b and albedo
on 32 roughnesses by 32 cosines. Each becomes a product of Chebyshev polynomials in sqrt(roughness) and sqrt(cosine), the
albedo through its logarithm. Errors are printed as a comment. Roughness below the first row, 1/31, is left to the caller.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import numpy as np
from numpy.polynomial import chebyshev

N_COS, N_ROUGH = 7, 8  # degrees
FAINT = 2e-4  # albedos below carry no weight: their a and b are noise


def published(path: Path) -> np.ndarray:
    """Return a, b and albedo, shape (3, 32 roughnesses, 32 cosines)."""
    body = re.search(r"table_sheen_ltc\[3072\] = \{(.*?)\};", path.read_text(), re.S)[1]
    return np.array([float(x) for x in re.findall(r"-?[\d.]+(?=f)", body)]).reshape(3, 32, 32)


def fit(target: np.ndarray, weight: np.ndarray, basis: np.ndarray) -> np.ndarray:
    w = weight.ravel()
    return np.linalg.lstsq(basis * w[:, None], target.ravel() * w, rcond=None)[0]


def main() -> None:
    a, b, albedo = published(Path(sys.argv[1]))[:, 1:, :]
    rough, cosine = np.meshgrid(np.arange(1, 32) / 31, np.arange(32) / 31, indexing="ij")
    low = np.sqrt(1 / 31)
    x, y = 2 * np.sqrt(cosine) - 1, 2 * (np.sqrt(rough) - low) / (1 - low) - 1
    basis = chebyshev.chebvander2d(x.ravel(), y.ravel(), [N_COS, N_ROUGH])
    seen = albedo > FAINT
    # Where nothing is seen a and b continue the last value of their row, and hardly pull.
    for table in (a, b):
        for row, ok in zip(table, seen, strict=True):
            last = np.flatnonzero(ok)[-1]
            row[last + 1 :] = row[last]
    weight = np.where(seen, np.sqrt(albedo), 3e-3)
    jobs = [
        ("kSheenA", a, weight, lambda v: v),
        ("kSheenB", b, weight, lambda v: v),
        ("kSheenLogAlbedo", np.log(np.maximum(albedo, 1e-6)), np.maximum(albedo, 1e-3), np.exp),
    ]
    print("// SPDX-License-Identifier: GPL-3.0-or-later\n// Made by tools/make_tables/sheen_fit.py: do not edit.")
    print(f"inline constexpr int kSheenCosTerms = {N_COS + 1}, kSheenRoughTerms = {N_ROUGH + 1};")
    for name, target, w, undo in jobs:
        c = fit(target, w, basis)
        error = np.abs(undo((basis @ c).reshape(target.shape)) - undo(target))[albedo > 0.01]
        print(f"// Error where the albedo is above 0.01: {error.mean():.4f} in the mean, {error.max():.4f} at most.")
        values = ", ".join(f"{v:.6g}f" if "." in f"{v:.6g}" or "e" in f"{v:.6g}" else f"{v:.6g}.0f" for v in c)
        print(f"inline constexpr float {name}[kSheenCosTerms * kSheenRoughTerms] = {{{values}}};")


if __name__ == "__main__":
    main()
