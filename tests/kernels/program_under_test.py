# SPDX-License-Identifier: GPL-3.0-or-later
"""Register programs written by hand and run through the kernels' door for tests (`opal_test_shader.h`)."""

from __future__ import annotations

import ctypes
import re
from pathlib import Path

import numpy as np
from opal_kernels import binding

HEADER = (Path(__file__).resolve().parents[2] / "kernels" / "include" / "opal_shader.h").read_text()
OP = {name: int(number) for name, number in re.findall(r"OPAL_OP_(\w+) = (\d+)", HEADER)}


class Program:
    """A program in the making: constants first, then instructions; registers are handed out in order."""

    def __init__(self) -> None:
        self.constants: list[tuple[float, ...]] = []
        self.code: list[list[int]] = []
        self.n_variables = 0
        self.n_constants = 64  # registers kept for constants

    def constant(self, *lanes: float) -> int:
        """A register that holds one number in all lanes, or four."""
        self.constants.append(lanes * 4 if len(lanes) == 1 else lanes)
        return len(self.constants) - 1

    def op(self, name: str, *inputs: int, mode: int = 0, outputs: int = 1) -> int:
        """Adds an operation and returns the first register it writes."""
        out = self.n_constants + self.n_variables if outputs else -1
        self.n_variables += outputs
        self.code.append([OP[name], mode, out, *inputs, *[-1] * (13 - len(inputs))])
        return out

    def emit(self, register: int) -> Program:
        """Makes a register the program's emission."""
        self.op("EMISSION", -1, register, self.constant(1.0), outputs=0)
        return self

    def arrays(self) -> tuple[np.ndarray, np.ndarray, int]:
        constants = np.zeros((self.n_constants, 4), np.float32)
        if self.constants:
            constants[: len(self.constants)] = self.constants
        return np.array(self.code, np.int32).reshape(-1, 16), constants, self.n_constants + self.n_variables


class _Structure(ctypes.Structure):
    """`opal_program` of opal.h."""

    _fields_ = [
        ("code", ctypes.c_void_p),
        ("n_instructions", ctypes.c_int32),
        ("n_constants", ctypes.c_int32),
        ("constants", ctypes.c_void_p),
        ("n_registers", ctypes.c_int32),
        ("reserved", ctypes.c_int32),
    ]


def _address(array):
    return None if array is None else ctypes.c_void_p(array.ctypes.data)


def run(code, constants, n_registers, points=((0.0, 0.0, 1.0),), scene=None, hits=None, ray_length=1.0):
    """Emission and transmittance at points, each (n, 3); arguments as in `opal_test_shader.h`.

    Raises
    ------
    ValueError
        With the kernels' sentence, if they refuse the program.
    """
    code = np.ascontiguousarray(code, np.int32)
    constants = np.ascontiguousarray(constants, np.float32)
    points = np.ascontiguousarray(points, np.float32)
    hits = None if hits is None else np.ascontiguousarray(hits, np.int32)
    structure = _Structure(code.ctypes.data, len(code), len(constants), constants.ctypes.data, n_registers)
    emission, transmittance = (np.zeros((len(points), 3), np.float32) for _ in range(2))
    message = ctypes.create_string_buffer(256)
    function = binding.library().opal_test_run_program
    function.restype = ctypes.c_int32
    status = function(
        ctypes.c_void_p(scene),
        ctypes.byref(structure),
        ctypes.c_int64(len(points)),
        _address(points),
        _address(hits),
        ctypes.c_float(ray_length),
        _address(emission),
        _address(transmittance),
        message,
        ctypes.c_int32(256),
    )
    if status:
        raise ValueError(message.value.decode())
    return emission, transmittance
