# SPDX-License-Identifier: GPL-3.0-or-later
"""Building a register program: values, instructions, and the tidying that makes it small.

While a tree is read, a value is either four constants or one result of an instruction. `ProgramBuilder.emit` works constants
out at once where that takes one line, and gives the same result for the same question twice. `ProgramBuilder.finish` drops
what no lobe needs, numbers constants and registers, and reuses registers whose value is spent.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from . import operations as ops
from .operations import Op

Four = tuple[float, float, float, float]


@dataclass(frozen=True)
class Value:
    """A constant (``constant`` set) or output ``output`` of instruction ``instruction``."""

    constant: Four | None = None
    instruction: int = -1
    output: int = 0

    @property
    def number(self) -> float | None:
        """The constant's first lane; None for what is not constant."""
        return None if self.constant is None else self.constant[0]


@dataclass(frozen=True)
class Table:
    """Consecutive constants: ``rows`` of four numbers."""

    rows: tuple[Four, ...]


Input = Value | Table | int | None
_N_INPUTS = 13


def constant(*lanes: float) -> Value:
    """One number in all lanes, three with 1 as the fourth, or four."""
    if len(lanes) == 1:
        lanes = lanes * 4
    elif len(lanes) == 3:
        lanes = (*lanes, 1.0)
    return Value(tuple(float(x) for x in lanes))


ZERO, ONE = constant(0.0), constant(1.0)


def _grey(mode: int, values: list[Four]) -> Four:
    x, y, z, _ = values[0]
    g = (x + y + z) / 3 if mode == ops.GREY["AVERAGE"] else 0.2126729 * x + 0.7151522 * y + 0.0721750 * z
    return (g,) * 4


_FOLDED_MATH = {
    ops.MATH["ADD"]: lambda a, b: a + b,
    ops.MATH["SUBTRACT"]: lambda a, b: a - b,
    ops.MATH["MULTIPLY"]: lambda a, b: a * b,
    ops.MATH["DIVIDE"]: lambda a, b: a / b if b else 0.0,
    ops.MATH["MINIMUM"]: min,
    ops.MATH["MAXIMUM"]: max,
}


def _math(mode: int, values: list[Four]) -> Four | None:
    if mode not in _FOLDED_MATH or len(values) < 2:
        return None
    return (_FOLDED_MATH[mode](values[0][0], values[1][0]),) * 4


_FOLDED_VECTOR_MATH = {
    ops.VECTOR_MATH["ADD"]: lambda a, b: a + b,
    ops.VECTOR_MATH["SUBTRACT"]: lambda a, b: a - b,
    ops.VECTOR_MATH["MULTIPLY"]: lambda a, b: a * b,
}


def _vector_math(mode: int, values: list[Four]) -> Four | None:
    if mode not in _FOLDED_VECTOR_MATH or len(values) < 2:
        return None
    f = _FOLDED_VECTOR_MATH[mode]
    return (*(f(a, b) for a, b in zip(values[0][:3], values[1][:3], strict=True)), 0.0)


def _pack(mode: int, values: list[Four]) -> Four:
    if mode == 1:
        return (*values[0][:3], values[1][0])
    lanes = [v[0] for v in values]
    return tuple(lanes + [0.0] * (4 - len(lanes)))


def _clamp(mode: int, values: list[Four]) -> Four:
    low, high = values[1][0], values[2][0]
    if mode == 1 and low > high:
        low, high = high, low
    return (min(max(values[0][0], low), high),) * 4


def _combine(mode: int, values: list[Four]) -> Four | None:
    return (values[0][0], values[1][0], values[2][0], 1.0) if mode == ops.COLOR["RGB"] else None


# Operations worked out at once when every input is constant; None: leave it to the kernels.
_FOLDS = {
    Op.GREY: _grey,
    Op.MATH: _math,
    Op.VECTOR_MATH: _vector_math,
    Op.PACK: _pack,
    Op.CLAMP: _clamp,
    Op.COMBINE: _combine,
}


@dataclass
class _Instruction:
    op: Op
    mode: int
    inputs: tuple[Input, ...]


class ProgramBuilder:
    """A program in the making."""

    def __init__(self) -> None:
        self._code: list[_Instruction] = []
        self._known: dict[tuple, int] = {}

    def emit(self, op: Op, mode: int, *inputs: Input) -> Value:
        """Adds an operation and returns its first output.

        Parameters
        ----------
        op : Op
            The operation.
        mode : int
            Its mode.
        *inputs
            In the order of ``opal_shader.h``: values, plain integers, tables, None for what is left out.
        """
        if op in _FOLDS and all(isinstance(i, Value) and i.constant is not None for i in inputs):
            folded = _FOLDS[op](mode, [i.constant for i in inputs])
            if folded is not None and all(map(math.isfinite, folded)):
                return Value(folded)
        if op is Op.SEPARATE and mode == ops.COLOR["RGB"] and isinstance(inputs[0], Value) and inputs[0].constant:
            return constant(inputs[0].constant[inputs[1]])
        key = (op, mode, inputs)
        if op in ops.LOBES or key not in self._known:
            self._known[key] = len(self._code)
            self._code.append(_Instruction(op, mode, inputs))
        return Value(instruction=self._known[key])

    def emit_all(self, op: Op, mode: int, *inputs: Input) -> list[Value]:
        """`emit` for operations with several outputs: all of them."""
        first = self.emit(op, mode, *inputs)
        return [Value(instruction=first.instruction, output=i) for i in range(ops.OUTPUTS[op])]

    # ---- Shorthands ----

    def math(self, name: str, a: Value, b: Value) -> Value:
        """One of Blender's Math operations on two numbers."""
        if name == "MULTIPLY" and ONE in (a, b):
            return b if a == ONE else a
        return self.emit(Op.MATH, ops.MATH[name], a, b)

    def scale(self, color: Value, factor: Value) -> Value:
        """Colour times number; multiplies by one are left out."""
        if factor == ONE:
            return color
        if color == ONE:
            return factor
        return self.emit(Op.VECTOR_MATH, ops.VECTOR_MATH["MULTIPLY"], color, factor)

    def component(self, color: Value, i: int) -> Value:
        """Lane ``i`` (3 is alpha) as a number."""
        return self.emit(Op.SEPARATE, ops.COLOR["RGB"], color, i)

    def pack(self, *numbers: Value) -> Value:
        """Up to four numbers in one register."""
        return self.emit(Op.PACK, 0, *numbers)

    def pack_color(self, color: Value, number: Value) -> Value:
        """A colour and a number in the fourth lane."""
        return self.emit(Op.PACK, 1, color, number)

    def scaled_attribute(self, value: Value) -> tuple[float, int | None] | None:
        """(scale, attribute number) of a value that is a constant times an attribute's number; number None: the constant alone."""
        scale = 1.0
        while value.constant is None:
            made = self._code[value.instruction]
            if made.op is Op.ATTRIBUTE and made.mode == ops.ATTRIBUTE["FACTOR"]:
                return scale, made.inputs[0]
            if made.op is Op.GREY and isinstance(made.inputs[0], Value) and made.inputs[0].constant is None:
                inner = self._code[made.inputs[0].instruction]
                if inner.op is Op.ATTRIBUTE and inner.mode == ops.ATTRIBUTE["COLOR"]:
                    return scale, inner.inputs[0]  # of one component: all lanes alike
            if made.op is not Op.MATH or made.mode != ops.MATH["MULTIPLY"]:
                if made.op is Op.MATH and made.mode == ops.MATH["MAXIMUM"] and ZERO in made.inputs and scale >= 0:
                    value = made.inputs[0] if made.inputs[1] == ZERO else made.inputs[1]  # grids are never negative
                    continue
                return None
            a, b = made.inputs[:2]
            fixed, value = (a, b) if a.constant is not None else (b, a)
            if fixed.constant is None:
                return None
            scale *= fixed.constant[0]
        return scale * value.constant[0], None

    # ---- The end ----

    @property
    def lobes(self) -> list[tuple[Op, int, tuple[Input, ...]]]:
        """The lobes so far: operation, mode, inputs."""
        return [(i.op, i.mode, i.inputs) for i in self._code if i.op in ops.LOBES]

    def finish(self) -> tuple[np.ndarray, np.ndarray, int]:
        """The program: code (n, 16) int32, constants (m, 4) float32, number of registers.

        Raises
        ------
        OverflowError
            If more than ``MAX_REGISTERS`` values are alive at once.
        """
        live = self._live()
        constants, tables = self._constants(live)
        registers, n_variables = _assign_registers(self._code, live)
        n_constants = len(constants)

        def operand(i: Input) -> int:
            if i is None:
                return -1
            if isinstance(i, int):
                return i
            if isinstance(i, Table):
                return tables[i]
            if i.constant is not None:
                return tables[Table((i.constant,))]
            return n_constants + registers[i.instruction] + i.output

        code = np.full((len(live), 16), -1, np.int32)
        for row, number in zip(code, live, strict=True):
            c = self._code[number]
            row[0], row[1] = c.op, c.mode
            row[2] = n_constants + registers[number] if number in registers else -1
            row[3 : 3 + len(c.inputs)] = [operand(i) for i in c.inputs]
        with np.errstate(over="ignore"):
            rows = np.nan_to_num(np.array(constants, np.float64).reshape(n_constants, 4)).astype(np.float32)
        rows = np.nan_to_num(rows)
        return code, rows, n_constants + n_variables

    def finish_value(self, value: Value) -> tuple[np.ndarray, np.ndarray, int]:
        """A program, as `finish` gives it, whose emission is this value; the builder is as before."""
        self._code.append(_Instruction(Op.EMISSION, 0, (ONE, value, ONE)))
        try:
            return self.finish()
        finally:
            self._code.pop()

    def _live(self) -> list[int]:
        """Numbers of the instructions that a lobe depends on, in order."""
        needed: set[int] = set()
        for number in range(len(self._code) - 1, -1, -1):
            c = self._code[number]
            if c.op in ops.LOBES or number in needed:
                needed.add(number)
                needed.update(i.instruction for i in c.inputs if isinstance(i, Value) and i.constant is None)
        return sorted(needed)

    def _constants(self, live: Sequence[int]) -> tuple[list[Four], dict[Table, int]]:
        rows: list[Four] = []
        tables: dict[Table, int] = {}
        for number in live:
            for i in self._code[number].inputs:
                if isinstance(i, Value) and i.constant is not None:
                    i = Table((i.constant,))
                if isinstance(i, Table) and i not in tables:
                    tables[i] = len(rows)
                    rows.extend(i.rows)
        return rows, tables


def _assign_registers(code: list[_Instruction], live: Sequence[int]) -> tuple[dict[int, int], int]:
    """Registers for the results of the live instructions: the first of each, and how many there are in all.

    A register is free again after its last reader.
    """
    last_use: dict[int, int] = {}
    for number in live:
        for i in code[number].inputs:
            if isinstance(i, Value) and i.constant is None:
                last_use[i.instruction] = number
    registers: dict[int, int] = {}
    free: list[int] = []
    n_registers = 0
    expiring: dict[int, list[int]] = {}
    for i, number in last_use.items():
        expiring.setdefault(number, []).append(i)
    for number in live:
        if code[number].op not in ops.LOBES:
            count = ops.OUTPUTS.get(code[number].op, 1)
            if count == 1 and free:
                registers[number] = free.pop()
            else:
                registers[number] = n_registers
                n_registers += count
        for i in expiring.get(number, ()):
            free.extend(range(registers[i], registers[i] + ops.OUTPUTS.get(code[i].op, 1)))
    if n_registers > ops.MAX_REGISTERS:
        raise OverflowError(f"it needs {n_registers} registers, and there are {ops.MAX_REGISTERS}")
    return registers, n_registers
