# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tracer has to know of a program beforehand: does it emit, let light straight through, make caustics?

Whatever depends on a texture counts as if it did.
"""

from __future__ import annotations

from typing import NamedTuple

from .operations import Op
from .program import Input, ProgramBuilder, Value

SHARP_ROUGHNESS = 0.3  # a glossy lobe rougher than this gathers light into nothing that looks like a caustic


class Flags(NamedTuple):
    """See `CompiledProgram`."""

    emissive: bool
    caster: bool
    transparent_shadow: bool


def _may_exceed(value: Input, lane: int, limit: float) -> bool:
    return value is None or value.constant is None or value.constant[lane] > limit


def _may_be_under(value: Input, lane: int, limit: float) -> bool:
    return value is None or value.constant is None or value.constant[lane] < limit


def _may_colour(value: Value) -> bool:
    return value.constant is None or any(c != 0 for c in value.constant[:3])


def flags_of(builder: ProgramBuilder) -> Flags:
    """Looks at every lobe of a program."""
    emissive = caster = transparent = False
    for op, _mode, inputs in builder.lobes:
        if op is Op.EMISSION:
            emissive |= _may_colour(inputs[1]) and _may_colour(inputs[2])
        elif op is Op.TRANSPARENT:
            transparent |= _may_colour(inputs[1])
        elif op is Op.GLASS or op is Op.REFRACTION:
            caster |= _may_be_under(inputs[2], 0, SHARP_ROUGHNESS)
        elif op is Op.GLOSSY:
            caster |= _may_be_under(inputs[2], 0, SHARP_ROUGHNESS)
        elif op is Op.METALLIC:
            caster |= _may_be_under(inputs[3], 0, SHARP_ROUGHNESS)
        elif op is Op.PRINCIPLED:
            emissive |= _may_colour(inputs[8]) and _may_exceed(inputs[8], 3, 0)
            transparent |= _may_be_under(inputs[9], 3, 1)
            caster |= _principled_casts(inputs)
    return Flags(emissive, caster, transparent)


def _principled_casts(inputs: tuple[Input, ...]) -> bool:
    """Metal, transmission or coat that is there and sharp. The faint reflection of a dielectric alone makes no caustic worth
    photons, as paths find its light."""
    coat, base, layers = inputs[6], inputs[9], inputs[11]
    sharp = _may_be_under(base, 1, SHARP_ROUGHNESS)
    metal, clear = _may_exceed(base, 0, 0), _may_exceed(layers, 0, 0)
    coated = _may_exceed(coat, 3, 0) and _may_be_under(layers, 1, SHARP_ROUGHNESS)
    return (sharp and (metal or clear)) or coated
