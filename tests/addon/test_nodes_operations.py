# SPDX-License-Identifier: GPL-3.0-or-later
"""The operations' numbers in Python are those of the C header."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

pytest.importorskip("bpy")
ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "reference"))
import node_images  # noqa: E402, F401  (makes the source importable)
from opal_source.addon.nodes import operations as ops  # noqa: E402

HEADER = (ROOT / "kernels" / "include" / "opal_shader.h").read_text()
WITHOUT_COMMENTS = re.sub(r"/\*.*?\*/", "", HEADER, flags=re.DOTALL)


def enumeration(prefix: str) -> dict[str, int]:
    """Names (without prefix) and numbers of the C enumeration whose items begin with `prefix`."""
    for body in re.findall(r"enum\s*\w*\s*\{(.*?)\}", WITHOUT_COMMENTS, flags=re.DOTALL):
        items, number = {}, 0
        for item in filter(None, (i.strip() for i in body.split(","))):
            name, _, value = (part.strip() for part in item.partition("="))
            number = int(value) if value else number
            items[name] = number
            number += 1
        if all(name.startswith(prefix) for name in items):
            return {name.removeprefix(prefix): n for name, n in items.items() if not name.endswith("_COUNT")}
    raise LookupError(prefix)


def test_operations_have_the_headers_numbers():
    assert {op.name: int(op) for op in ops.Op} == enumeration("OPAL_OP_")


RENAMED = {
    "CROSS_PRODUCT": "CROSS",
    "DOT_PRODUCT": "DOT",
    "X_AXIS": "X",
    "Y_AXIS": "Y",
    "Z_AXIS": "Z",
    "EULER_XYZ": "EULER",
    "EXTEND": "EDGE",
}
MODES = {
    "OPAL_GREY_": ops.GREY,
    "OPAL_MATH_": ops.MATH,
    "OPAL_VECTOR_": ops.VECTOR_MATH,
    "OPAL_RANGE_": ops.MAP_RANGE,
    "OPAL_MAPPING_": ops.MAPPING,
    "OPAL_ROTATE_": ops.VECTOR_ROTATE,
    "OPAL_TRANSFORM_": ops.TRANSFORM,
    "OPAL_COLOR_": ops.COLOR,
    "OPAL_COORDINATE_": ops.COORDINATE,
    "OPAL_ATTRIBUTE_": ops.ATTRIBUTE,
    "OPAL_GEOMETRY_": ops.GEOMETRY,
    "OPAL_OBJECT_": ops.OBJECT,
    "OPAL_PATH_": ops.PATH,
    "OPAL_NORMAL_": ops.NORMAL_MAP,
    "OPAL_PROJECT_": ops.PROJECTION,
    "OPAL_EXTEND_": ops.EXTENSION,
    "OPAL_NOISE_": ops.NOISE,
    "OPAL_VORONOI_": ops.VORONOI,
    "OPAL_GRADIENT_": ops.GRADIENT,
}


@pytest.mark.parametrize("prefix", MODES)
def test_modes_have_the_headers_numbers(prefix):
    assert {RENAMED.get(name, name): n for name, n in MODES[prefix].items()} == enumeration(prefix)


def test_blend_modes_have_the_headers_numbers():
    assert ops.MIX == {k: v for k, v in enumeration("OPAL_MIX_").items() if not k.startswith("FLAG")}


def test_as_many_registers_as_the_kernels_keep():
    assert int(re.search(r"OPAL_MAX_REGISTERS (\d+)", HEADER)[1]) == ops.MAX_REGISTERS
