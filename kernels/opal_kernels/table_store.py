# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables that took long to compute, kept on disk: checked when read, bounded in size, the least recently used going first.

A file is one line of JSON (magic, key, shape, SHA-256 of the rest) and the zlib-compressed little-endian float32 values. Its name
is the hash of its key, which holds every parameter and the version of the code: what was computed otherwise is never found. A
file is written beside its place and moved into it, so that several processes may share a folder.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import tempfile
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

MOST_BYTES = 64 * 1024 * 1024
_MAGIC = "opal table 1"
_SUFFIX = ".opaltable"
_LONGEST_HEADER = 65536


def _ignore(_message: str) -> None:
    pass


@dataclass(frozen=True)
class TableStore:
    """A folder of tables.

    Attributes
    ----------
    folder : Path or None
        Made when first written to; None keeps nothing.
    most_bytes : int
        What all files together may take.
    warn : callable
        Takes a sentence when a file is damaged or cannot be written; neither stops anything.
    """

    folder: Path | None = None
    most_bytes: int = MOST_BYTES
    warn: Callable[[str], None] = _ignore

    def path(self, key: str) -> Path | None:
        """Where the table of a key lies, if it is kept."""
        if self.folder is None:
            return None
        return Path(self.folder) / (hashlib.sha256(key.encode()).hexdigest()[:32] + _SUFFIX)

    def read(self, key: str) -> np.ndarray | None:
        """Return the table of a key, or None where there is none or it is damaged; reading counts as use."""
        path = self.path(key)
        if path is None or not path.is_file():
            return None
        try:
            values = _decode(path.read_bytes(), key)
        except (OSError, ValueError, KeyError, zlib.error) as error:
            self.warn(f"The table {path.name} is damaged ({error}) and is computed again.")
            with contextlib.suppress(OSError):
                path.unlink()
            return None
        with contextlib.suppress(OSError):
            os.utime(path)
        return values

    def write(self, key: str, values: np.ndarray) -> None:
        """Keep a table; older ones go where the folder would grow beyond its bound."""
        path = self.path(key)
        if path is None:
            return
        data = _encode(values, key)
        if len(data) > self.most_bytes:
            return
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._make_room(len(data), path)
            handle, name = tempfile.mkstemp(dir=path.parent, prefix="new-", suffix=".part")
            try:
                with os.fdopen(handle, "wb") as file:
                    file.write(data)
                os.replace(name, path)
            except BaseException:
                with contextlib.suppress(OSError):
                    os.unlink(name)
                raise
        except OSError as error:
            self.warn(f"The table cannot be kept in {path.parent}: {error.strerror or error}.")

    def bytes(self) -> int:
        """What the tables take now."""
        return sum(size for _, size, _ in self._files())

    def _files(self) -> list[tuple[float, int, Path]]:
        """(last use, size, path) of every table, oldest first."""
        files = []
        if self.folder is not None and Path(self.folder).is_dir():
            for path in Path(self.folder).glob("*" + _SUFFIX):
                with contextlib.suppress(OSError):
                    status = path.stat()
                    files.append((status.st_mtime, status.st_size, path))
        return sorted(files)

    def _make_room(self, wanted: int, replaced: Path) -> None:
        files = [row for row in self._files() if row[2] != replaced]
        total = wanted + sum(size for _, size, _ in files)
        for _, size, path in files:
            if total <= self.most_bytes:
                return
            with contextlib.suppress(OSError):
                path.unlink()
                total -= size


def _encode(values: np.ndarray, key: str) -> bytes:
    values = np.ascontiguousarray(values, "<f4")
    body = zlib.compress(values.tobytes(), 6)
    header = {"magic": _MAGIC, "key": key, "shape": values.shape, "sha256": hashlib.sha256(body).hexdigest()}
    return json.dumps(header).encode() + b"\n" + body


def _decode(data: bytes, key: str) -> np.ndarray:
    end = data.find(b"\n", 0, _LONGEST_HEADER)
    if end < 0:
        raise ValueError("it has no header")
    header = json.loads(data[:end])
    body = data[end + 1 :]
    if not isinstance(header, dict) or header.get("magic") != _MAGIC:
        raise ValueError("it is not a table")
    if header["key"] != key:
        raise ValueError("it is another table")
    if hashlib.sha256(body).hexdigest() != header["sha256"]:
        raise ValueError("its checksum is wrong")
    values = np.frombuffer(zlib.decompress(body), "<f4")
    shape = tuple(int(n) for n in header["shape"])
    if values.size != np.prod(shape):
        raise ValueError("its size is wrong")
    return values.reshape(shape).astype(np.float32)
