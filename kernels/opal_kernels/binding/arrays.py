# SPDX-License-Identifier: GPL-3.0-or-later
"""From NumPy and plain Python to what the C interface takes, checked at the door.

Arrays are converted where that loses nothing, held to their shape, and refused when a value is not finite where the kernels
need finite ones.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Mapping, Sequence
from ctypes import POINTER, c_float
from typing import Any

import numpy as np

from .library import OpalError
from .structures import FloatPointer, InstructionStruct, ProgramStruct


def as_array(name: str, values: Any, dtype: Any, shape: Sequence[int | None], finite: bool = True) -> np.ndarray:
    """A contiguous array of ``dtype`` and ``shape`` (None: any length), without a copy where none is needed.

    Raises
    ------
    OpalError
        Naming the argument, what was expected and what came.
    """
    array = np.asarray(values)
    if not (np.can_cast(array.dtype, dtype, "same_kind") or (np.dtype(dtype).kind == "f" and array.dtype.kind in "iub")):
        raise OpalError(f"{name} holds {array.dtype} values where {np.dtype(dtype)} is expected.")
    if array.ndim != len(shape) or any(want is not None and want != got for want, got in zip(shape, array.shape, strict=True)):
        wanted = " x ".join("any" if n is None else str(n) for n in shape)
        raise OpalError(f"{name} has the shape {' x '.join(map(str, array.shape)) or 'of one value'} where {wanted} is expected.")
    array = np.ascontiguousarray(array, dtype=dtype)
    if finite and array.dtype.kind == "f" and not np.isfinite(array).all():
        raise OpalError(f"{name} holds values that are not finite.")
    return array


def as_floats(name: str, values: Any, shape: Sequence[int | None], finite: bool = True) -> np.ndarray:
    return as_array(name, values, np.float32, shape, finite)


def pointer(array: np.ndarray | None, kind: Any = FloatPointer) -> Any:
    return None if array is None else array.ctypes.data_as(kind)


def as_transforms(name: str, values: Any, count: int | None = None) -> np.ndarray:
    """Matrices as n x 12; accepts n x 3 x 4, n x 4 x 4 and n x 12."""
    array = np.asarray(values, dtype=np.float32)
    if array.ndim == 3 and array.shape[1:] in ((3, 4), (4, 4)):
        array = array[:, :3, :].reshape(len(array), 12)
    return as_floats(name, array, (count, 12))


def get(description: Any, name: str, default: Any = None) -> Any:
    if isinstance(description, Mapping):
        return description.get(name, default)
    return getattr(description, name, default)


def fill(struct: Any, description: Any, skip: Iterable[str] = ()) -> Any:
    """Copies same-named values of a dataclass or mapping into a structure of numbers; "reserved" stays zero."""
    what = type(description).__name__
    for name, kind in struct._fields_:
        if name == "reserved" or name in skip:
            continue
        value = get(description, name)
        if value is None:
            raise OpalError(f"{what} has no {name}.")
        if issubclass(kind, ctypes.Array):
            flat = np.asarray(value, dtype=np.float64 if kind._type_ is c_float else np.int64)
            if kind._length_ == 12 and flat.shape == (4, 4):
                flat = flat[:3]
            flat = flat.reshape(-1)
            if len(flat) != kind._length_ or not np.isfinite(flat).all():
                raise OpalError(f"{what}.{name} takes {kind._length_} finite numbers.")
            setattr(struct, name, kind(*flat.tolist()))
        elif kind is c_float:
            if not np.isfinite(value):
                raise OpalError(f"{what}.{name} is not finite.")
            setattr(struct, name, float(value))
        else:
            setattr(struct, name, int(value))
    return struct


def program_struct(description: Any, keep: list[Any]) -> ProgramStruct:
    """A program's structure; arrays it points to are put into ``keep``, which has to outlive the call."""
    code = as_array("program.code", get(description, "code"), np.int32, (None, 16))
    constants = as_floats("program.constants", get(description, "constants"), (None, 4))
    keep += [code, constants]
    return ProgramStruct(
        code=code.ctypes.data_as(POINTER(InstructionStruct)),
        n_instructions=len(code),
        n_constants=len(constants),
        constants=pointer(constants),
        n_registers=int(get(description, "n_registers")),
    )


def numbers(struct: Any) -> dict[str, Any]:
    return {name: getattr(struct, name) for name, _ in struct._fields_}
