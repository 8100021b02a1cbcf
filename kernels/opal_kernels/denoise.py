# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoising by the Open Image Denoise 2 that Blender's build carries, through its C interface.

The filter is "RT": a network for path-traced pictures, guided by albedo and normal, which it cleans first. Functions and constants after
https://www.openimagedenoise.org/documentation.html (version 2).
"""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable
from ctypes import c_bool, c_char_p, c_double, c_int, c_size_t, c_void_p
from typing import Any

import numpy as np

from . import libraries
from .binding import Cancelled, OpalError, as_array

_DEVICE_CPU = 1
_FORMAT_FLOAT3 = 3
_ERROR_CANCELLED = 6
# Called by Open Image Denoise's threads with the part that is done; false ends the filter.
_Monitor = ctypes.CFUNCTYPE(c_bool, c_void_p, c_double)
_SIGNATURES: dict[str, tuple[Any, list[Any]]] = {
    "oidnNewDevice": (c_void_p, [c_int]),
    "oidnCommitDevice": (None, [c_void_p]),
    "oidnReleaseDevice": (None, [c_void_p]),
    "oidnGetDeviceError": (c_int, [c_void_p, ctypes.POINTER(c_char_p)]),
    "oidnSetDeviceInt": (None, [c_void_p, c_char_p, c_int]),
    "oidnNewFilter": (c_void_p, [c_void_p, c_char_p]),
    "oidnSetSharedFilterImage": (
        None,
        [c_void_p, c_char_p, c_void_p, c_int, c_size_t, c_size_t, c_size_t, c_size_t, c_size_t],
    ),
    "oidnSetFilterBool": (None, [c_void_p, c_char_p, c_bool]),
    "oidnSetFilterProgressMonitorFunction": (None, [c_void_p, _Monitor, c_void_p]),
    "oidnCommitFilter": (None, [c_void_p]),
    "oidnExecuteFilter": (None, [c_void_p]),
    "oidnReleaseFilter": (None, [c_void_p]),
}

_library: ctypes.CDLL | None = None
_reason: str | None = None
_lock = threading.Lock()


def unavailable() -> str:
    """Why nothing can be denoised here, in one sentence; empty where it can."""
    global _library, _reason
    with _lock:
        if _reason is None:
            _library, _reason = _open()
        return _reason


def _open() -> tuple[ctypes.CDLL | None, str]:
    path = libraries.open_image_denoise()
    if path is None:
        return None, "This build of Blender carries no Open Image Denoise."
    try:
        opened = ctypes.CDLL(path)
        for name, (result, arguments) in _SIGNATURES.items():
            function = getattr(opened, name)
            function.restype, function.argtypes = result, arguments
    except (OSError, AttributeError) as error:
        return None, f"Open Image Denoise at {path} cannot be used: {error}."
    return opened, ""


def denoise(
    color: np.ndarray,
    albedo: np.ndarray,
    normal: np.ndarray,
    threads: int = 0,
    wants_stop: Callable[[], bool] | None = None,
) -> np.ndarray:
    """A picture without its noise.

    Parameters
    ----------
    color : ndarray
        (height, width, 3 or 4) linear; a fourth channel, alpha, is kept as it is.
    albedo, normal : ndarray
        (height, width, 3) guides; normals in world space, -1 to 1.
    threads : int
        0 takes every core.
    wants_stop : callable, optional
        Asked again and again, from other threads, whether to give up.

    Returns
    -------
    ndarray
        float32 of the shape of ``color``.

    Raises
    ------
    OpalError
        If there is no Open Image Denoise, or it fails.
    Cancelled
        If ``wants_stop`` said so.
    """
    if reason := unavailable():
        raise OpalError(reason)
    color = as_array("color", color, np.float32, (None, None, None))
    height, width, _ = color.shape
    stop = wants_stop or (lambda: False)

    def clean(**images: np.ndarray) -> np.ndarray:
        output = np.empty((height, width, 3), np.float32)
        _run({**{name.encode(): image for name, image in images.items()}, b"output": output}, threads, stop)
        return output

    # In media a guide has the very noise of the picture, of the same paths: some meet the wall, some the fog. Taken as it is, that noise
    # would pass for a pattern of the wall's and stay.
    guides = {
        "albedo": clean(albedo=as_array("albedo", albedo, np.float32, (height, width, 3))),
        "normal": clean(normal=as_array("normal", normal, np.float32, (height, width, 3))),
    }
    out = color.copy()
    out[..., :3] = clean(color=np.ascontiguousarray(color[..., :3]), **guides)
    return out


def _run(images: dict[bytes, np.ndarray], threads: int, wants_stop: Callable[[], bool]) -> None:
    """One filter: of the colour by clean guides, or of a guide alone."""
    api = _library
    assert api is not None
    height, width, _ = images[b"output"].shape
    monitor = _Monitor(lambda _user, _done: not wants_stop())
    device = api.oidnNewDevice(_DEVICE_CPU)
    if not device:
        raise OpalError("Open Image Denoise has no device for this processor.")
    try:
        if threads:
            api.oidnSetDeviceInt(device, b"numThreads", threads)
        api.oidnCommitDevice(device)
        filter_handle = api.oidnNewFilter(device, b"RT")
        if filter_handle:
            for name, pixels in images.items():
                api.oidnSetSharedFilterImage(filter_handle, name, pixels.ctypes.data, _FORMAT_FLOAT3, width, height, 0, 0, 0)
            if b"color" in images:
                api.oidnSetFilterBool(filter_handle, b"hdr", True)
                api.oidnSetFilterBool(filter_handle, b"cleanAux", True)
            api.oidnSetFilterProgressMonitorFunction(filter_handle, monitor, None)
            api.oidnCommitFilter(filter_handle)
            api.oidnExecuteFilter(filter_handle)
            api.oidnReleaseFilter(filter_handle)
        message = c_char_p()
        error = api.oidnGetDeviceError(device, ctypes.byref(message))
        if error == _ERROR_CANCELLED:
            raise Cancelled("Cancelled")
        if error:
            raise OpalError(f"Open Image Denoise failed: {(message.value or b'').decode('utf-8', 'replace')}.")
    finally:
        api.oidnReleaseDevice(device)
