# SPDX-License-Identifier: GPL-3.0-or-later
"""GemCad files: designs that come back as the solids they describe, and broken files that say where."""

import math

import numpy as np
import pytest
from opal_kernels.cuts import gemcad, round_brilliant

HEADER = "GemCad 5.0\ng 96 0.0\ny 8 y\nI 1.54\nH Test\n"
CUBE = "a 90 0.5 96 24 48 72 n G\na 0 0.5 n T\na -0.0 0.5 n C\n"


def test_a_cube_is_cut_from_six_facets():
    stone = gemcad.parse(HEADER + CUBE).cut()
    assert stone.solid.volume() == pytest.approx(1.0, rel=1e-12)
    assert stone.counts() == {"girdle": 4, "T": 1, "C": 1}


def test_everything_a_file_says_is_read():
    design = gemcad.parse(
        "\ufeffGemCad 5.0\r\ng -64 1.5\r\ny 4 n\r\nI 1.76\r\nH one\r\nH two\r\n; a remark\r\na -42.5 0.6 64 n P1 16 32\r\n48\r\nF end\r\na 0 .3\r\n"
    )
    assert (design.gear, design.offset, design.symmetry, design.mirror, design.refractive_index) == (-64, 1.5, 4, False, 1.76)
    assert (design.headers, design.footnotes) == (["one", "two"], ["end"])
    tier = design.tiers[0]
    assert (tier.angle, tier.distance, tier.indices, tier.name) == (math.radians(-42.5), 0.6, (64, 16, 32, 48), "P1")
    assert math.copysign(1.0, design.tiers[1].angle) == 1.0


@pytest.mark.parametrize("culet", ["a 0 -0.5 96", "a -0.000 0.5", "a -0 0.5 96 n C G polish"])
def test_a_culet_is_told_from_the_table_by_its_sign(culet):
    stone = gemcad.parse(f"{HEADER}a 90 0.5 96 24 48 72\na 0 0.25\n{culet}\n").cut()
    assert stone.solid.vertices[:, 2].min() == pytest.approx(-0.5)
    assert stone.solid.vertices[:, 2].max() == pytest.approx(0.25)


def test_the_offset_turns_the_stone():
    turned = gemcad.parse(HEADER.replace("96 0.0", "96 12") + CUBE).cut()
    assert turned.extent()[:2] == pytest.approx([math.sqrt(2.0)] * 2)


def test_a_brilliant_written_with_six_decimals_comes_back_with_its_facets():
    """Rounded distances no longer meet in points; the tolerance has to restore every meeting."""
    stone = round_brilliant()
    lines = []
    for face, plane_normal in zip(stone.solid.faces, stone.solid.area_vectors(), strict=True):
        normal = plane_normal / np.linalg.norm(plane_normal)
        angle = math.degrees(math.acos(min(1.0, abs(normal[2]))))
        index = math.degrees(math.atan2(normal[1], normal[0])) / 360.0 * 96.0 if angle else 96.0
        distance = normal @ stone.solid.vertices[face[0]]
        lines.append(f"a {'-' if normal[2] < -1e-9 else ''}{angle:.6f} {distance:.6f} {index:.6f}")
    back = gemcad.parse(HEADER + "\n".join(lines)).cut()
    assert len(back.solid.faces) == len(stone.solid.faces)
    assert len(back.solid.vertices) == len(stone.solid.vertices)
    assert back.solid.is_watertight()
    assert back.solid.euler_characteristic() == 2
    assert back.solid.volume() == pytest.approx(stone.solid.volume(), rel=1e-5)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "line 1"),
        ("hello", "line 1: a GemCad file begins"),
        ("GemCad 5.0\ng ninety 0\n", "line 2: the gear's number of teeth must be a number, not 'ninety'"),
        ("GemCad 5.0\ng 0 0\n", "line 2: the gear must have 1 to 720 teeth"),
        ("GemCad 5.0\ng\n", "line 2: expected the gear's"),
        ("GemCad 5.0\n?\n", "line 2: expected a record"),
        (HEADER + "a 41\n", "line 6: a facet needs an angle and a distance"),
        (HEADER + "a 141 0.5 96\n", "line 6: the angle must lie between"),
        (HEADER + "a 41 -0.5 96\n", "line 6: the distance must be positive"),
        (HEADER + "a 41 nan 96\n", "line 6: the distance must be a number"),
        (HEADER + "a 41 0.5\n", "line 6: a facet at 41 degrees needs at least one index"),
        (HEADER + "a 41 0.5 96\n12 twelve\n", "line 6: an index must be a number, not 'twelve'"),
        (HEADER + "a 41 0.5 96 n\n", "line 6: a name must follow n"),
        (HEADER + "a 41 0.5 " + "1 " * 3000, "line 6: more than 2000 facets"),
        (HEADER.replace("1.54", "0.3") + CUBE, "line 4: the refractive index must lie between"),
        (HEADER.replace("y 8", "y 0") + CUBE, "line 3: the order of the symmetry"),
        ("GemCad 5.0\n" + CUBE, "no line g"),
        (HEADER, "no facets"),
    ],
)
def test_a_broken_file_gets_a_sentence_with_its_line(text, sentence):
    with pytest.raises(gemcad.GemCadError, match=sentence.replace("?", r"\?")):
        gemcad.parse(text)


def test_facets_that_leave_the_stone_open_are_refused():
    with pytest.raises(gemcad.GemCadError, match="do not make a stone: .*open"):
        gemcad.parse(HEADER + "a 90 0.5 96 24 48 72\na 0 0.5\n").cut()


def test_bytes_of_old_files_are_windows_1252():
    assert gemcad.decode("H 43°".encode("cp1252")) == "H 43°"
    assert gemcad.decode("\ufeffGemCad".encode()) == "GemCad"


@pytest.mark.parametrize(
    "tier",
    [
        "a 90 0.5 96 24 48 72 n\ngirdle G",
        "a 90 0.5 96 24 n\nF1\n48 72",
        "a 90 0.5 96 24\n48 n Hips 72 G cut to\nFinish with the gear\nand a level girdle\nIgnore this",
        "a90 0.5 96 24 48 72",
    ],
)
def test_names_and_notes_go_on_over_lines_whatever_letter_they_begin_with(tier):
    design = gemcad.parse(f"GemCad 5.0\ng96 0\ny8 y\nI1.54\nH Test\n{tier}\na 0 0.5 n T\na -0.0 0.5 n C\nF end\n")
    assert (design.gear, design.symmetry, design.refractive_index) == (96, 8, 1.54)
    assert design.headers == ["Test"] and design.footnotes == ["end"]
    assert design.tiers[0].indices == (96, 24, 48, 72) and len(design.tiers) == 3
    assert design.cut().solid.volume() == pytest.approx(1.0, rel=1e-12)


def test_facets_outside_the_stone_are_known_and_doubled_ones_are_not_among_them():
    design = gemcad.parse(HEADER + CUBE + "a 45 0.9 12 36 n Far\na 90 0.5 0 n Twice\na 45 0.7 96 n Cuts\n")
    assert design.outside(design.cut()) == ["Far", "Far"]
    assert gemcad.parse(HEADER + CUBE).outside(gemcad.parse(HEADER + CUBE).cut()) == []
