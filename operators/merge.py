# SPDX-License-Identifier: GPL-3.0-or-later
"""Films of passes that were rendered apart, merged to the bits of one render."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import bpy
from bpy.props import BoolProperty, CollectionProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

# Names of a film's pictures, as Blender's passes have them.
_NAMES = {"COMBINED": "Combined", "DEPTH": "Depth"}


class OPAL_OT_merge(bpy.types.Operator, ImportHelper):
    """Merge films"""

    bl_idname = "opal.merge"
    bl_label = "Merge Films"
    bl_description = "Merge films of different passes of the same picture: passes 1 to 8 and 9 to 16 make the picture of 1 to 16, exactly"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".npz"
    filter_glob: StringProperty(default="*.npz", options={"HIDDEN"})
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    directory: StringProperty(name="Folder", description="Where the films are", subtype="DIR_PATH", options={"HIDDEN"})
    pattern: StringProperty(
        name="Pattern",
        description="Names of the films in the folder, such as film_0001_*.npz; used where no files are chosen",
        default="",
    )
    output: StringProperty(
        name="Picture",
        description="Where the merged picture is written as OpenEXR, with every pass the films keep; # stands for a digit of the frame "
        "number. Empty makes an image in this file only",
        default="",
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    film: StringProperty(
        name="Film",
        description="Where the merged film is written, to be merged further; empty writes none",
        default="",
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    use_denoise: BoolProperty(
        name="Denoise",
        description="Denoise the merged picture by Open Image Denoise; the films have to be rendered with Denoise on, so that they keep its guides",
        default=False,
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        from opal_kernels import film_sums
        from opal_kernels.binding import OpalError

        from . import own_images

        try:
            groups = _by_picture(film_sums.load(path) for path in self._paths())
            for (frame, layer), films in sorted(groups.items()):
                merged = film_sums.merge(films)
                owner = own_images.owner_of(context.scene, context.view_layer)
                told = self._keep(merged, frame, layer, len(groups), owner)
                self.report({"INFO"}, f"Frame {frame}, {layer}: {len(films)} films, {len(merged.passes)} passes" + told)
                if missing := _gaps(merged.passes):
                    self.report({"WARNING"}, f"Frame {frame}, {layer}: the films leave out passes {missing}")
        except OpalError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def _paths(self) -> list[Path]:
        from opal_kernels.binding import OpalError

        folder = Path(bpy.path.abspath(self.directory or "//"))
        chosen = [folder / file.name for file in self.files if file.name]
        if not chosen and self.pattern:
            chosen = sorted(folder.glob(self.pattern))
        if not chosen and self.filepath:
            chosen = [Path(bpy.path.abspath(self.filepath))]
        if not chosen:
            raise OpalError(f"There are no films to merge: nothing in {folder} is called “{self.pattern or '*.npz'}”.")
        return chosen

    def _keep(self, merged: Any, frame: int, layer: str, groups: int, owner: str) -> str:
        from ..addon.film_files import with_frame
        from . import float_images

        picture = merged.picture()
        if self.use_denoise:
            picture = _denoised(merged, picture)
        name = "Opal Merged" if groups == 1 else f"Opal Merged {layer} {frame:04d}"
        image = float_images.put(name, picture, owner)
        told = f", in the image “{image.name}”"
        if self.output:
            path = Path(with_frame(self.output, frame))
            path = path if path.suffix.lower() == ".exr" else path.with_name(path.name + ".exr")
            passes = {_NAMES.get(p.name, p.name.title().replace("_", "")): merged.picture(p) for p in merged.sums if p.name != "SPECTRAL"}
            float_images.write_layers(path, {layer: {**passes, "Combined": picture}})
            told += f", written to {path}"
        if self.film:
            merged.save(with_frame(self.film, frame))
        return told


def _by_picture(films: Iterable[Any]) -> dict[tuple[int, str], list[Any]]:
    """Films of the same frame and layer together."""
    groups: dict[tuple[int, str], list[Any]] = {}
    for film in films:
        groups.setdefault((film.info.get("frame", 0), film.info.get("layer", "ViewLayer")), []).append(film)
    return groups


def _gaps(passes: Iterable[int]) -> str:
    """What lies between passes and is not among them, counted from 1: “3, 5–8”; empty where nothing does."""
    here = sorted(passes)
    holes = [(a + 2, b) for a, b in zip(here, here[1:], strict=False) if b > a + 1]
    return ", ".join(f"{first}" if first == last else f"{first}–{last}" for first, last in holes)


def _denoised(merged: Any, picture: Any) -> Any:
    from opal_kernels import denoise
    from opal_kernels.binding import OpalError
    from opal_kernels.descriptions import Pass

    if not {Pass.ALBEDO, Pass.NORMAL} <= merged.sums.keys():
        raise OpalError("The films keep no albedo and normals to denoise by: render them with Denoise on.")
    return denoise.denoise(picture, merged.picture(Pass.ALBEDO), merged.picture(Pass.NORMAL))


def register() -> None:
    bpy.utils.register_class(OPAL_OT_merge)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_OT_merge)
