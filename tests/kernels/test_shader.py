# SPDX-License-Identifier: GPL-3.0-or-later
"""The interpreter of register programs: what it refuses, what it gives, and that garbage never reaches memory.

That nodes give what Blender's give is `tests/reference/test_nodes.py`'s business.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))
from program_under_test import OP, Program, run  # noqa: E402


def value_of(build, point=(0.0, 0.0, 1.0)):
    """Emission of a program whose emitted register `build(program)` gives, at one point."""
    program = Program()
    register = build(program)
    return run(*program.emit(register).arrays(), points=[point])[0][0]


# ---- What is given ----


def test_a_constant_is_emitted_everywhere_alike():
    assert value_of(lambda p: p.constant(0.25, 0.5, 0.75, 1.0)) == pytest.approx([0.25, 0.5, 0.75])


def test_the_worlds_position_is_the_direction():
    assert value_of(lambda p: p.op("COORDINATE", mode=4), (0.6, 0.0, 0.8)) == pytest.approx([0.6, 0.0, 0.8])


@pytest.mark.parametrize(
    ("mode", "a", "b", "expected"),
    [(3, 1.0, 0.0, 0.0), (5, -2.0, 0.5, 0.0), (5, 0.0, 0.0, 1.0), (6, -1.0, 2.0, 0.0), (7, -1.0, 0.0, 0.0), (24, 1.0, 0.0, 0.0)],
)
def test_maths_without_an_answer_gives_a_number(mode, a, b, expected):
    assert value_of(lambda p: p.op("MATH", p.constant(a), p.constant(b), mode=mode))[0] == expected


def test_a_table_is_met_at_its_entries_and_between_them():
    def at(t, mode):
        def build(p):
            first = p.constant(0.0, 0.0, 0.0, 1.0)
            p.constant(1.0, 2.0, 4.0, 1.0)
            p.constant(3.0, 6.0, 8.0, 1.0)
            return p.op("TABLE", p.constant(t), first, 3, mode=mode)

        return value_of(build)

    assert at(0.5, 1) == pytest.approx([1, 2, 4])
    assert at(0.75, 1) == pytest.approx([2, 4, 6])
    assert at(0.75, 0) == pytest.approx([1, 2, 4])
    assert at(1.5, 3) == pytest.approx([5, 10, 12])
    assert at(7.0, 1) == pytest.approx([3, 6, 8])
    assert at(float("nan"), 1) == pytest.approx([0, 0, 0])


def test_what_is_not_finite_is_not_emitted():
    assert value_of(lambda p: p.op("MATH", p.constant(1000.0), mode=10)) == pytest.approx([0, 0, 0])  # e^1000


def test_transmittance_adds_up_transparent_lobes_and_what_alpha_leaves():
    program = Program()
    half = program.constant(0.5)
    program.op("TRANSPARENT", half, program.constant(1.0, 0.5, 0.0, 1.0), outputs=0)
    zero, one = program.constant(0.0), program.constant(1.0, 1.0, 1.0, 0.0)
    body = program.constant(0.0, 0.5, 1.5, 0.2)
    program.op("PRINCIPLED", half, one, -1, -1, -1, one, one, one, one, body, zero, zero, zero, outputs=0)
    assert run(*program.arrays())[1][0] == pytest.approx([0.9, 0.65, 0.4])


def test_a_program_without_instructions_is_black_and_opaque():
    emission, transmittance = run(np.zeros((0, 16)), np.zeros((0, 4)), 0)
    assert not emission.any()
    assert not transmittance.any()


def test_noise_is_centred_and_bounded():
    program = Program()
    numbers = [program.constant(x) for x in (0.0, 3.0, 0.0, 0.5, 2.0, 0.0, 1.0, 0.0)]
    position = program.op("COORDINATE", mode=4)
    factor = program.op("NOISE", position, *numbers, 3, 1, mode=3, outputs=2)
    points = np.random.default_rng(3).uniform(-20, 20, (4000, 3))
    values = run(*program.emit(factor).arrays(), points=points)[0][:, 0]
    assert 0 <= values.min() < 0.3
    assert 0.7 < values.max() <= 1
    # 4000 almost independent samples of standard deviation about 0.14.
    assert values.mean() == pytest.approx(0.5, abs=4 * 0.14 / 4000**0.5)


# ---- What is refused ----


def emission_program(**changes):
    """A good program of one emission, then changed."""
    program = Program()
    program.emit(program.constant(1.0))
    code, constants, n = program.arrays()
    for key, value in changes.items():
        row, column = map(int, key[1:].split("_"))
        code[row, column] = value
    return code, constants, n


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"c0_0": 9999}, "no operation 9999"),
        ({"c0_0": -1}, "no operation -1"),
        ({"c0_1": 7}, "no mode 7"),
        ({"c0_4": 64}, "reads register 64"),
        ({"c0_4": -2}, "reads register -2"),
        ({"c0_3": 2**31 - 1}, "reads register 2147483647"),
        ({"c0_5": -1}, "reads register -1"),
    ],
)
def test_a_bad_operand_is_named(change, sentence):
    with pytest.raises(ValueError, match=sentence):
        run(*emission_program(**change))


def test_reading_before_writing_is_refused():
    program = Program()
    program.op("MATH", 65, 0)
    program.constant(1.0)
    program.op("MATH", 0, 0)
    with pytest.raises(ValueError, match="nothing has written"):
        run(*program.arrays())


def test_writing_a_constant_is_refused():
    program = Program()
    program.constant(1.0)
    program.op("MATH", 0, 0)
    code, constants, n = program.arrays()
    code[0, 2] = 0
    with pytest.raises(ValueError, match="cannot write register 0"):
        run(code, constants, n)


@pytest.mark.parametrize(("first", "size"), [(63, 2), (-1, 2), (0, 0), (0, -5), (0, 65), (2**31 - 1, 2**31 - 1)])
def test_a_table_outside_of_the_constants_is_refused(first, size):
    program = Program()
    program.op("TABLE", program.constant(0.5), first, size)
    with pytest.raises(ValueError, match="constants"):
        run(*program.arrays())


def test_an_image_that_does_not_exist_is_refused():
    program = Program()
    position = program.op("COORDINATE", mode=4)
    program.op("IMAGE", position, 0, 0, 0, 0, -1, -1, 0)
    with pytest.raises(ValueError, match="no image 0"):
        run(*program.arrays())


def test_too_many_registers_are_refused():
    code, constants, _ = emission_program()
    with pytest.raises(ValueError, match="cannot be read"):
        run(code, constants, len(constants) + 513)


def test_garbage_is_refused_or_runs():
    """Random programs: a sentence or a finite answer, and no read out of bounds (the sanitizer build looks)."""
    rng = np.random.default_rng(7)
    numbers = list(OP.values())
    ran = 0
    for _ in range(3000):
        n_constants, n_variables = int(rng.integers(1, 6)), int(rng.integers(0, 12))
        n = n_constants + n_variables
        code = rng.integers(-2, n + 2, (int(rng.integers(1, 8)), 16))
        code[:, 0] = rng.choice(numbers, len(code))
        code[:, 1] = rng.integers(0, 4, len(code))
        code[:, 2] = rng.integers(n_constants, n + 1, len(code))
        constants = rng.normal(0, 10.0 ** rng.integers(0, 12), (n_constants, 4))
        constants[rng.random(constants.shape) < 0.05] = np.nan
        try:
            emission, transmittance = run(code, constants, n, points=rng.normal(size=(3, 3)))
        except ValueError as error:
            assert "instruction" in str(error)
            continue
        ran += 1
        assert np.isfinite(emission).all()
        assert np.isfinite(transmittance).all()
    assert ran > 30, "too few random programs were good enough to run"


@pytest.mark.parametrize("coat", [0.0, 0.5])
def test_a_principled_surface_emits_what_alpha_and_coat_leave(coat):
    program = Program()
    plain = program.constant(1.0, 1.0, 1.0, 0.0)
    emission = program.constant(0.5, 1.0, 0.25, 2.0)
    layers = program.constant(0.0, 0.03, 1.5, 0.5)
    body = program.constant(0.0, 0.5, 1.5, 0.5)
    over = program.constant(1.0, 1.0, 1.0, coat)
    zero = program.constant(0.0)
    program.op("PRINCIPLED", -1, plain, -1, -1, -1, plain, over, plain, emission, body, zero, layers, zero, outputs=0)
    seen = run(*program.arrays())[0][0]
    assert seen / seen[1] == pytest.approx([0.5, 1.0, 0.25])
    # Half of it by alpha; a coat seen straight on (0.04 reflected) takes 2 % at half weight.
    assert seen[1] == pytest.approx(1.0 - 0.04 * coat, rel=0.01)
