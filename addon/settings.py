# SPDX-License-Identifier: GPL-3.0-or-later
"""From Blender's and Opal's properties to `RenderSettings`: the frame, the region, the passes, the knobs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from opal_kernels.camera import border_region
from opal_kernels.descriptions import Carry, Filter, Pass, RenderSettings, VolumeEstimate

PREVIEW_PASSES = 16
PREVIEW_SECONDS = 3.0
_PREVIEW_PHOTONS = 4_000


@dataclass(frozen=True)
class Frame:
    """Pixels of the full frame, and of the part that is rendered (x0, y0, x1, y1; y up)."""

    width: int
    height: int
    region: tuple[int, int, int, int]

    @property
    def region_size(self) -> tuple[int, int]:
        """Width and height of the rendered part."""
        return self.region[2] - self.region[0], self.region[3] - self.region[1]


def frame_of(render: Any) -> Frame:
    """The frame that Blender asks for, border and resolution percentage applied as Blender rounds them.

    Parameters
    ----------
    render : bpy.types.RenderSettings
    """
    width = max(1, render.resolution_x * render.resolution_percentage // 100)
    height = max(1, render.resolution_y * render.resolution_percentage // 100)
    region = (0, 0, width, height)
    if render.use_border:
        region = border_region(width, height, (render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y))
    return Frame(width, height, region)


def frame_seed(seed: int, frame: int) -> int:
    """A seed of its own for each frame: 32 bits mixed from both (the finaliser of MurmurHash3)."""
    h = (seed * 0x9E3779B1 + frame) & 0xFFFFFFFF
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35)):
        h = ((h ^ (h >> shift)) * factor) & 0xFFFFFFFF
    return h ^ (h >> 16)


def threads_of(render: Any) -> int:
    """Threads to use; 0 takes every core."""
    return render.threads if render.threads_mode == "FIXED" else 0


def render_settings(scene: Any, frame: Frame, passes: Sequence[Pass] = (), preview: bool = False, layer: Any = None) -> RenderSettings:
    """The kernels' settings of a scene.

    Parameters
    ----------
    scene : bpy.types.Scene
        Evaluated or original.
    frame : Frame
    passes : sequence of Pass
        What the film keeps beside Combined.
    preview : bool
        Fewer photons and no spectral film, for material previews and viewports.
    layer : bpy.types.ViewLayer, optional
        May leave motion blur out.
    """
    opal = scene.opal
    spectral = opal.use_spectral_output and not preview
    photons = min(opal.photons_per_pass, _PREVIEW_PHOTONS) if preview else opal.photons_per_pass
    layer_blurs = getattr(layer, "use_motion_blur", True)  # since Blender 5
    first, last = sorted(opal.wavelengths)
    first = min(first, 829.0)
    return RenderSettings(
        width=frame.width,
        height=frame.height,
        region=frame.region,
        samples_per_pass=1 if preview else opal.samples_per_pass,
        photons_per_pass=photons,
        photons_carry=Carry[opal.photons_carry] if photons else Carry.NONE,
        gather=opal.gather,
        radius=opal.radius,
        radius_shrink=opal.radius_shrink,
        volume_estimate=VolumeEstimate[opal.volume_estimate],
        volume_photons=min(opal.volume_photons_per_pass, photons) if preview else opal.volume_photons_per_pass,
        volume_radius=opal.volume_radius,
        march_steps=opal.march_steps,
        march_tolerance=opal.march_tolerance,
        max_depth=opal.max_depth,
        transparent_depth=opal.transparent_depth,
        wavelength_first=first,
        wavelength_last=max(last, first + 1.0),
        seed=frame_seed(opal.seed, scene.frame_current) if opal.seed_per_frame and not preview else opal.seed,
        filter=Filter[opal.pixel_filter],
        filter_width=opal.filter_width,
        exposure=opal.film_exposure,
        transparent_film=scene.render.film_transparent,
        clamp_direct=opal.clamp_direct,
        clamp_indirect=opal.clamp_indirect,
        motion_blur=scene.render.use_motion_blur and layer_blurs and not preview,
        spectral_bins=opal.spectral_bins if spectral else 0,
        threads=threads_of(scene.render),
        adaptive=opal.use_adaptive_sampling and not preview,
        passes=(*passes, Pass.SPECTRAL) if spectral else tuple(passes),
    )
