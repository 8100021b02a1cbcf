# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing a picture as PNG with the standard library alone, for scripts that run without Blender (PNG specification, third edition)."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np


def write(path: Path, encoded: np.ndarray) -> None:
    """Write display values (h, w, 3) in [0, 1], rows from the top, as 8-bit RGB.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    rows = np.rint(np.clip(encoded, 0, 1) * 255).astype(np.uint8)
    height, width = rows.shape[:2]
    unfiltered = np.zeros((height, 1 + 3 * width), np.uint8)
    unfiltered[:, 1:] = rows.reshape(height, -1)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    body = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(unfiltered.tobytes(), 6)) + chunk(b"IEND", b"")
    Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + body)
