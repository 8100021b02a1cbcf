# SPDX-License-Identifier: GPL-3.0-or-later
"""A film's sums, apart from any render: saved to a file, merged with those of other passes, read as pictures.

The kernels round what each pass adds to multiples of 2^-32 and sum in double precision, so sums are exact and their order does not
matter: passes 1-8 of one machine and 9-16 of another add up to the same bits as 1-16 of one. The file is NumPy's ``.npz``,
compressed, one array a pass by its name, and a JSON text ``info``.
"""

from __future__ import annotations

import json
import os
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .binding import OpalError
from .descriptions import Pass

_FORMAT = 1


@dataclass
class FilmSums:
    """The sums over passes of everything that a film keeps.

    Attributes
    ----------
    passes : sequence of int
        Numbers of the passes in it.
    depth_pass : int
        Which of them the depth is of; -1 without one.
    sums : dict of Pass to ndarray
        float64 of shape (height, width, channels), rows from the bottom up; depth is no sum.
    squares : ndarray
        (height, width, 1) sums of squared luminance, for the noise.
    info : dict
        Whatever tells renders apart that must not be merged: scene, frame, layer, seed, settings. JSON types only.
    """

    passes: Sequence[int]
    depth_pass: int
    sums: dict[Pass, np.ndarray]
    squares: np.ndarray
    info: dict[str, Any] = field(default_factory=dict)

    def picture(self, which: Pass | str = Pass.COMBINED) -> np.ndarray:
        """The mean over passes, float32: bit for bit what `Render.film` gives for the same passes."""
        number = Pass[which] if isinstance(which, str) else Pass(which)
        if number not in self.sums:
            raise OpalError(f"The film does not keep the pass {number.name}.")
        scale = 1.0 if number is Pass.DEPTH else 1.0 / len(self.passes)
        return (self.sums[number] * scale).astype(np.float32)

    def save(self, path: Path | str) -> None:
        """Writes the file, whole or not at all.

        Raises
        ------
        OpalError
            If it cannot be written.
        """
        path = Path(path)
        info = {"format": _FORMAT, "passes": list(map(int, self.passes)), "depth_pass": self.depth_pass, "info": self.info}
        partial = path.with_name(path.name + ".part")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with open(partial, "wb") as file:
                np.savez_compressed(
                    file, info=np.array(json.dumps(info)), squares=self.squares, **{p.name: a for p, a in self.sums.items()}
                )
            os.replace(partial, path)
        except OSError as error:
            raise OpalError(f"The film {path} cannot be written: {error.strerror or error}.") from error


def load(path: Path | str) -> FilmSums:
    """Reads a film's file.

    Raises
    ------
    OpalError
        If there is none, or it is no film.
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            info = json.loads(str(file["info"]))
            if info["format"] != _FORMAT:
                raise OpalError(f"The film {path} was written by another version of Opal.")
            sums = {Pass[name]: file[name] for name in file.files if name in Pass.__members__}
            return FilmSums(tuple(info["passes"]), info["depth_pass"], sums, file["squares"], info["info"])
    except FileNotFoundError:
        raise OpalError(f"There is no film {path}.") from None
    except (OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
        raise OpalError(f"{path} is not a film of Opal, or is damaged: {error}.") from error


def merge(films: Sequence[FilmSums]) -> FilmSums:
    """The film of all passes together, exactly.

    Parameters
    ----------
    films : sequence of FilmSums
        Of the same picture, with different passes.

    Raises
    ------
    OpalError
        If there is none, a pass is there twice, or they are not of the same picture.
    """
    if not films:
        raise OpalError("There are no films to merge.")
    first = films[0]
    numbers = [number for film in films for number in film.passes]
    twice = sorted({number for number in numbers if numbers.count(number) > 1})
    if twice:
        raise OpalError(f"Pass {twice[0] + 1} is in more than one of the films; a pass counts once.")
    for film in films[1:]:
        if {p: a.shape for p, a in film.sums.items()} != {p: a.shape for p, a in first.sums.items()}:
            raise OpalError("The films differ in size or in the passes that they keep.")
        different = sorted(key for key in {*first.info, *film.info} if first.info.get(key) != film.info.get(key))
        if different:
            key = different[0]
            raise OpalError(
                f"The films are not of the same render: {key} is {first.info.get(key)} in one and {film.info.get(key)} in another."
            )
    nearest = min((film for film in films if film.depth_pass >= 0), key=lambda film: film.depth_pass, default=first)
    sums = {p: nearest.sums[p].copy() if p is Pass.DEPTH else sum((film.sums[p] for film in films[1:]), first.sums[p]) for p in first.sums}
    squares = sum((film.squares for film in films[1:]), first.squares)
    return FilmSums(tuple(sorted(numbers)), nearest.depth_pass, sums, squares, dict(first.info))
