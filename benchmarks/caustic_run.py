# SPDX-License-Identifier: GPL-3.0-or-later
"""One renderer on one caustic scene, in a process of its own: their libraries do not share one gladly.

python benchmarks/caustic_run.py RENDERER METHOD SCENE SEED OUTPUT.npz SECONDS [SECONDS...]
"""

import importlib
import os
import sys

import numpy as np
from caustic_scenes import SCENES

if __name__ == "__main__":
    renderer, method, scene, seed, output, *times = sys.argv[1:]
    found = importlib.import_module(f"caustic_{renderer}").snapshots(SCENES[scene](), method, [float(t) for t in times], int(seed))
    np.savez_compressed(output, seconds=[t for t, _ in found], images=np.array([i for _, i in found], np.float32))
    os._exit(0)  # LuxCore 2.11 crashes where Python tears it down; the pictures are written
