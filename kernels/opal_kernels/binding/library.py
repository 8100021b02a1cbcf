# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled library: found, checked, opened once, and how its failures become exceptions."""

from __future__ import annotations

import ctypes
import threading
from typing import Any

from .. import libraries
from .functions import SIGNATURES

API_VERSION = 1
CANCELLED = -4


class OpalError(RuntimeError):
    """The kernels refused or failed; the message is one sentence."""


class Cancelled(OpalError):
    """What ran was cancelled: a pass (the film holds complete passes only), a commit, or the denoising of a picture."""


_library: ctypes.CDLL | None = None
_library_lock = threading.Lock()


def library() -> ctypes.CDLL:
    """The compiled library for this processor, opened on first use.

    Raises
    ------
    OpalError
        If the file is missing, does not open, or speaks another version of the interface.
    """
    global _library
    with _library_lock:
        if _library is None:
            _library = _open_library()
        return _library


def _open_library() -> ctypes.CDLL:
    native = libraries.opal_library("native")
    if native.exists():
        return _declare(native)
    baseline = _declare(libraries.opal_library("v2"))
    fast = libraries.opal_library("v3")
    if baseline.opal_cpu_level() >= 3 and fast.exists():
        return _declare(fast)
    return baseline


def _declare(path: Any) -> ctypes.CDLL:
    if not path.exists():
        raise OpalError(f"Opal's compiled library is missing: looked for {path}.")
    try:
        opened = ctypes.CDLL(str(path))
    except OSError as error:
        raise OpalError(f"Opal's compiled library {path} does not open: {error}.") from error
    for name, (result, arguments) in SIGNATURES.items():
        try:
            function = getattr(opened, name)
        except AttributeError as error:
            raise OpalError(f"{path} has no function {name}: it is not the library of this version of Opal.") from error
        function.restype, function.argtypes = result, arguments
    if (found := opened.opal_api_version()) != API_VERSION:
        raise OpalError(f"{path} speaks version {found} of Opal's interface, this package version {API_VERSION}.")
    return opened


def last_error() -> str:
    """The sentence of the last failure on this thread; empty when there was none."""
    return library().opal_last_error().decode("utf-8", "replace")


def cpu_level() -> int:
    """Micro-architecture level of this processor: 3 (AVX2, FMA), 2 (x86-64-v2), 0 elsewhere."""
    return library().opal_cpu_level()


def checked(status: int) -> int:
    if status >= 0:
        return status
    message = last_error() or f"The kernels failed with status {status}."
    raise Cancelled(message) if status == CANCELLED else OpalError(message)
