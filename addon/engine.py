# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine that Blender calls. The kernels load with the first render, not with this module."""

from __future__ import annotations

from typing import Any

import bpy

from . import empty_result


class OpalRenderEngine(bpy.types.RenderEngine):
    """Spectral path tracing with photons for what paths cannot find."""

    bl_idname = "OPAL"
    bl_label = "Opal"
    bl_use_preview = True
    bl_use_postprocess = True
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True
    bl_use_spherical_stereo = False

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._viewport: Any = None

    def __del__(self) -> None:
        # Blender has taken its half of the object away: only Python's own attributes can be read.
        viewport = object.__getattribute__(self, "__dict__").get("_viewport")
        if viewport is not None:
            viewport.close()

    def update_render_passes(self, scene: Any = None, renderlayer: Any = None) -> None:
        """Tells the compositor which passes there are."""
        from . import render_passes

        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        for row in render_passes.wanted(renderlayer):
            self.register_pass(scene, renderlayer, row.name, len(row.channels), row.channels, row.socket)

    def render(self, depsgraph: Any) -> None:
        """A final render or a material preview, of one view layer."""
        try:
            from .final_render import render
        except Exception as error:  # Blender 4.5 crashes when it writes the picture of an engine that raised
            empty_result.hand_back(self, depsgraph)
            self.report({"ERROR"}, f"Opal's kernels do not load: {error}")
            return
        render(self, depsgraph)

    def view_update(self, context: Any, depsgraph: Any) -> None:
        """Something in the scene changed."""
        self._view().update(depsgraph)

    def view_draw(self, context: Any, depsgraph: Any) -> None:
        """Draws what the viewport's render has so far."""
        self._view().draw(context, depsgraph)

    def _view(self) -> Any:
        if self._viewport is None:
            from .viewport import Viewport

            self._viewport = Viewport(self)
        return self._viewport


def register() -> None:
    bpy.utils.register_class(OpalRenderEngine)


def unregister() -> None:
    bpy.utils.unregister_class(OpalRenderEngine)
