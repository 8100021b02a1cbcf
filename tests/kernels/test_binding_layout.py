# SPDX-License-Identifier: GPL-3.0-or-later
"""The ctypes structures have the sizes and offsets that a C compiler gives the header's structures."""

import ctypes
import shutil
import subprocess
from pathlib import Path

import pytest
from opal_kernels import binding

HEADER = Path(__file__).resolve().parents[2] / "kernels" / "include" / "opal.h"
COMPILER = next(filter(None, map(shutil.which, ("cc", "gcc", "clang", "c++"))), None)


@pytest.fixture(scope="module")
def layout(tmp_path_factory):
    """{(struct, field): (offset, size)} as the C compiler sees it; field "" is the whole structure."""
    folder = tmp_path_factory.mktemp("layout")
    lines = []
    for c_name, struct in binding.STRUCTURES.items():
        lines.append(f'printf("{c_name}  0 %zu\\n", sizeof({c_name}));')
        for field, *_ in struct._fields_:
            place = f"offsetof({c_name}, {field}), sizeof((({c_name} *)0)->{field})"
            lines.append(f'printf("{c_name} {field} %zu %zu\\n", {place});')
    source = folder / "layout.c"
    source.write_text(f'#include "{HEADER}"\n#include <stddef.h>\n#include <stdio.h>\nint main(void) {{\n' + "\n".join(lines) + "\n}\n")
    subprocess.run([COMPILER, "-x", "c", str(source), "-o", str(folder / "layout")], check=True)
    printed = subprocess.run([folder / "layout"], check=True, capture_output=True, text=True).stdout
    rows = [line.split(" ") for line in printed.splitlines()]
    return {(name, field): (int(offset), int(size)) for name, field, offset, size in rows}


@pytest.mark.skipif(COMPILER is None, reason="no C compiler to ask for the header's layout")
@pytest.mark.parametrize("name", sorted(binding.STRUCTURES))
def test_structure_is_laid_out_as_in_the_header(layout, name):
    struct = binding.STRUCTURES[name]
    assert ctypes.sizeof(struct) == layout[name, ""][1]
    for field, *_ in struct._fields_:
        mirrored = getattr(struct, field)
        assert (mirrored.offset, mirrored.size) == layout[name, field], field


def test_every_function_of_the_header_is_bound():
    words = HEADER.read_text().replace("(", " ").replace("*", " ").split()
    declared = {word for word in words if word.startswith("opal_")}
    exported = [line for line in HEADER.read_text().splitlines() if line.startswith("OPAL_EXPORT")]
    functions = {word for line in exported for word in line.replace("(", " ").replace("*", " ").split() if word in declared}
    functions = {name for name in functions if name not in binding.STRUCTURES} - {"opal_scene", "opal_render"}
    assert functions == set(binding.SIGNATURES)
