# SPDX-License-Identifier: GPL-3.0-or-later
"""GemCad's ``.asc`` files: cutting instructions as half-spaces.

GemCad (Robert W. Strickland) is how faceters share designs. One record a line, told by its first word::

    GemCad 5.0                      first line
    g 96 0.0                        teeth of the index gear (negative: numbered clockwise) and the gear's offset in teeth
    y 8 y                           order of the symmetry, and whether mirror images belong to it
    I 1.54                          refractive index
    H title                         header lines; F: footnotes
    a -43.1 0.65 96 n P1 12 24 G …  a tier: angle from the girdle plane in degrees (negative: pavilion; 0: table), distance of the plane from
                                    the origin, then indices, a name after each `n`, and cutting notes after `G`

Index lists, names and notes may go on over the next lines; a record may stand without the blank after its letter (``g96``). A culet is an angle of 0 that is negative, or 0 with a negative distance. Index i stands for the
azimuth 360°·(i − offset)/gear. Sources: GemCad User's Manual 4.51 (rockhounds.com/oplc/cd_online/gemcad_docs/refman.htm), gemcad.com, and
the survey of 5,759 such files in the documentation of the ``indicatrix`` project. The index lists are complete, so symmetry is only reported.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field

import numpy as np

from .stone import FacetPlanes, Stone

MAX_FACETS = 2000
"""More than any stone has been given; what a broken file may ask for."""
MEET_LENGTH = 2e-4
"""Files carry six to eight digits of facets made to meet by eye: edges shorter than this part of the stone's width are one corner."""


class GemCadError(ValueError):
    """A file that cannot be read; the message names the line."""


@dataclass(frozen=True)
class Tier:
    """Facets of one angle and one distance.

    Attributes
    ----------
    angle : float
        From the girdle plane, radians; negative below the girdle. For the table 0, for a culet −0.0.
    distance : float
        From the origin, in the file's unit; positive.
    indices : tuple of float
        Positions on the gear.
    name : str
        The first name given, or "".
    """

    angle: float
    distance: float
    indices: tuple[float, ...]
    name: str


@dataclass
class Design:
    """What a GemCad file says."""

    gear: int = 0
    offset: float = 0.0
    symmetry: int = 1
    mirror: bool = False
    refractive_index: float = 0.0
    headers: list[str] = field(default_factory=list)
    footnotes: list[str] = field(default_factory=list)
    tiers: list[Tier] = field(default_factory=list)

    def cut(self, meet_length: float = MEET_LENGTH) -> Stone:
        """Cut the design.

        Parameters
        ----------
        meet_length : float
            Edges shorter than this fraction of the stone's width become one corner.

        Raises
        ------
        GemCadError
            If its planes do not close a stone.
        """
        facets = self._facets()
        try:
            stone = facets.cut()
        except ValueError as error:
            raise GemCadError(f"the facets do not make a stone: {error}") from error
        solid = stone.solid.contracted(meet_length * float(stone.extent()[:2].min()))
        return Stone(solid, tuple(facets.names[plane] for plane in solid.planes))

    def outside(self, stone: Stone, meet_length: float = MEET_LENGTH) -> list[str]:
        """Names of the facets whose planes lie outside a stone that `cut` made, so that they cut nothing.

        Parameters
        ----------
        meet_length : float
            Planes nearer than this fraction of the stone's width touch it: they are another facet's, or meet a corner.
        """
        facets = self._facets()
        reach = (np.array(facets.normals) @ stone.solid.vertices.T).max(axis=1)
        gap = meet_length * float(stone.extent()[:2].min())
        return [name for name, distance, far in zip(facets.names, facets.distances, reach, strict=True) if distance - far > gap]

    def _facets(self) -> FacetPlanes:
        facets = FacetPlanes()
        for tier in self.tiers:
            down = math.copysign(1.0, tier.angle) < 0.0
            name = tier.name or (
                "table" if tier.angle == 0.0 and not down else f"{'P' if down else 'C'}{abs(math.degrees(tier.angle)):.2f}"
            )
            name = "girdle" if abs(abs(tier.angle) - 0.5 * math.pi) < math.radians(0.01) else name
            for index in tier.indices or (0.0,):
                azimuth = math.tau * (index - self.offset) / self.gear
                slope = abs(tier.angle)
                normal = np.array(
                    (
                        math.sin(slope) * math.cos(azimuth),
                        math.sin(slope) * math.sin(azimuth),
                        -math.cos(slope) if down else math.cos(slope),
                    )
                )
                facets.through(name, normal, tier.distance * normal)
        return facets


def parse(text: str) -> Design:
    """Read the text of an ``.asc`` file.

    Parameters
    ----------
    text : str
        The whole file, with any line endings.

    Raises
    ------
    GemCadError
        With the number of the line and what is wrong with it.
    """
    lines = text.lstrip("\ufeff").splitlines()
    if not lines or not lines[0].strip().lower().startswith("gemcad"):
        raise GemCadError("line 1: a GemCad file begins with the word GemCad and a version")
    design = Design()
    records: list[tuple[int, str]] = []
    for number, line in enumerate(lines[1:], start=2):
        stripped = line.strip()
        if not stripped or stripped.startswith(";"):
            continue
        tier = records[-1][1] if records and records[-1][1][0] == "a" else ""
        if tier and _continues(tier, stripped):
            records[-1] = (records[-1][0], f"{tier} {stripped}")
        elif stripped[0] in _RECORDS:
            records.append((number, stripped))
        else:
            raise GemCadError(f"line {number}: expected a record (g, y, I, H, F or a), found {stripped[:20]!r}")
    for number, record in records:
        _RECORDS[record[0]](design, number, record[1:].strip())
    if not design.gear:
        raise GemCadError("the file has no line g with the gear's teeth")
    if not design.tiers:
        raise GemCadError("the file has no facets (lines a)")
    return design


def _continues(tier: str, line: str) -> bool:
    """Whether a line goes on with the tier above it."""
    words = iter(tier[1:].split()[2:])
    for word in words:
        if word == "n" and next(words, None) is None:
            return True  # the name is still to come, whatever letter it begins with
        if word.startswith("G"):  # notes, which may begin with any word
            return not _RECORD.match(line)
    first = line.split()[0]
    return first[0] not in _RECORDS or first == "n"


def decode(data: bytes) -> str:
    """Bytes of a file to text: UTF-8, or Windows-1252 as GemCad itself writes."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")


def _number(line: int, what: str, word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise GemCadError(f"line {line}: {what} must be a number, not {word!r}")
    return value


def _words(line: int, rest: str, wanted: str) -> list[str]:
    words = rest.split()
    if not words:
        raise GemCadError(f"line {line}: expected {wanted}")
    return words


def _gear(design: Design, line: int, rest: str) -> None:
    words = _words(line, rest, "the gear's number of teeth")
    teeth = _number(line, "the gear's number of teeth", words[0])
    if teeth != int(teeth) or not 1 <= abs(teeth) <= 720:
        raise GemCadError(f"line {line}: the gear must have 1 to 720 teeth, not {words[0]}")
    design.gear = int(teeth)
    design.offset = _number(line, "the gear's offset", words[1]) if len(words) > 1 else 0.0


def _symmetry(design: Design, line: int, rest: str) -> None:
    words = _words(line, rest, "the order of the symmetry")
    order = _number(line, "the order of the symmetry", words[0])
    if order != int(order) or order < 1:
        raise GemCadError(f"line {line}: the order of the symmetry must be a whole number from 1, not {words[0]}")
    design.symmetry = int(order)
    design.mirror = len(words) > 1 and words[1].lower() == "y"


def _refractive_index(design: Design, line: int, rest: str) -> None:
    words = _words(line, rest, "a refractive index")
    design.refractive_index = _number(line, "the refractive index", words[0])
    if not 1.0 <= design.refractive_index <= 5.0:
        raise GemCadError(f"line {line}: the refractive index must lie between 1 and 5, not {words[0]}")


def _tier(design: Design, line: int, rest: str) -> None:
    words = rest.split()
    if len(words) < 2:
        raise GemCadError(f"line {line}: a facet needs an angle and a distance")
    angle, distance = _number(line, "the angle", words[0]), _number(line, "the distance", words[1])
    if abs(angle) > 90.0:
        raise GemCadError(f"line {line}: the angle must lie between -90 and 90 degrees, not {words[0]}")
    if angle == 0.0 and distance < 0.0:
        angle, distance = -0.0, -distance
    if distance <= 0.0:
        raise GemCadError(f"line {line}: the distance must be positive, not {words[1]}")
    indices, names = [], []
    rest_of_words = iter(words[2:])
    for word in rest_of_words:
        if word == "n":
            name = next(rest_of_words, None)
            if name is None:
                raise GemCadError(f"line {line}: a name must follow n")
            names.append(name)
        elif word.startswith("G"):
            break
        else:
            indices.append(_number(line, "an index", word))
    if not indices and angle != 0.0:
        raise GemCadError(f"line {line}: a facet at {words[0]} degrees needs at least one index")
    design.tiers.append(Tier(math.radians(angle), distance, tuple(indices), names[0] if names else ""))
    if sum(max(1, len(tier.indices)) for tier in design.tiers) > MAX_FACETS:
        raise GemCadError(f"line {line}: more than {MAX_FACETS} facets")


# A record as it has to begin to be told from a note: its letter alone, or before a number where it takes one.
_RECORD = re.compile(r"[HF](\s|$)|[gyIa]\s*[-+.\d]")

_RECORDS = {
    "g": _gear,
    "y": _symmetry,
    "I": _refractive_index,
    "H": lambda design, line, rest: design.headers.append(rest),
    "F": lambda design, line, rest: design.footnotes.append(rest),
    "a": _tier,
}
