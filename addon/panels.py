# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal's panels: what is drawn, in Blender's manner; nothing is computed here."""

from __future__ import annotations

from typing import Any

import bpy

from . import preset_panels


class OpalPanel(bpy.types.Panel):
    """Shown while Opal is the engine."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {"OPAL"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.engine in cls.COMPAT_ENGINES


class _RenderPanel(OpalPanel):
    bl_context = "render"

    def draw(self, context: Any) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        self.draw_settings(layout, context.scene.opal, context)

    def draw_settings(self, layout: Any, opal: Any, context: Any) -> None:
        raise NotImplementedError


class OPAL_RENDER_PT_sampling(_RenderPanel):
    bl_label = "Sampling"

    def draw_header_preset(self, _context: Any) -> None:
        preset_panels.OPAL_PT_render_presets.button(self.layout)

    def draw_settings(self, layout: Any, opal: Any, context: Any) -> None:
        column = layout.column(align=True)
        column.prop(opal, "passes")
        column.prop(opal, "samples_per_pass")
        layout.prop(opal, "use_adaptive_sampling")
        column = layout.column(align=True)
        column.prop(opal, "noise_threshold")
        column.prop(opal, "time_limit")
        layout.prop(opal, "seed")


class OPAL_RENDER_PT_denoise(_RenderPanel):
    bl_label = "Denoise"
    bl_parent_id = "OPAL_RENDER_PT_sampling"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: Any) -> None:
        from opal_kernels import denoise

        self.layout.active = not denoise.unavailable()
        self.layout.enabled = not denoise.unavailable()
        self.layout.prop(context.scene.opal, "denoise", text="")

    def draw_settings(self, layout: Any, opal: Any, context: Any) -> None:
        from opal_kernels import denoise

        reason = denoise.unavailable()
        layout.label(text=reason or "Open Image Denoise, guided by albedo and normals.", icon="ERROR" if reason else "NONE")


class OPAL_RENDER_PT_photons(_RenderPanel):
    bl_label = "Photons"

    def draw_settings(self, layout: Any, opal: Any, context: Any) -> None:
        layout.prop(opal, "photons_carry")
        layout.prop(opal, "photons_per_pass")
        column = layout.column(align=True)
        column.active = opal.photons_per_pass > 0
        column.prop(opal, "gather")
        column.prop(opal, "radius")
        column.prop(opal, "radius_shrink")


class OPAL_RENDER_PT_volume_photons(_RenderPanel):
    bl_label = "Media"
    bl_parent_id = "OPAL_RENDER_PT_photons"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_settings(self, layout: Any, opal: Any, context: Any) -> None:
        layout.active = opal.photons_per_pass > 0
        layout.prop(opal, "volume_estimate", text="Estimate")
        column = layout.column(align=True)
        column.active = opal.volume_estimate == "POINTS"
        column.prop(opal, "march_steps", text="Steps")
        column.prop(opal, "march_tolerance", text="Tolerance")
        column = layout.column(align=True)
        column.prop(opal, "volume_photons_per_pass", text="Photons per Pass")
        column.prop(opal, "volume_radius", text="Radius")


class OPAL_RENDER_PT_light_paths(_RenderPanel):
    bl_label = "Light Paths"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_settings(self, layout: Any, opal: Any, context: Any) -> None:
        column = layout.column(align=True)
        column.prop(opal, "max_depth")
        column.prop(opal, "transparent_depth")
        column = layout.column(align=True)
        column.prop(opal, "clamp_direct")
        column.prop(opal, "clamp_indirect", text="Indirect")


class OPAL_RENDER_PT_spectrum(_RenderPanel):
    bl_label = "Spectrum"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_settings(self, layout: Any, opal: Any, context: Any) -> None:
        column = layout.column(align=True)
        column.prop(opal, "wavelengths", index=0, text="First (nm)")
        column.prop(opal, "wavelengths", index=1, text="Last")


class OPAL_RENDER_PT_spectral_output(_RenderPanel):
    bl_label = "Spectral EXR"
    bl_parent_id = "OPAL_RENDER_PT_spectrum"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: Any) -> None:
        self.layout.prop(context.scene.opal, "use_spectral_output", text="")

    def draw_settings(self, layout: Any, opal: Any, context: Any) -> None:
        layout.active = opal.use_spectral_output
        layout.prop(opal, "spectral_path")
        layout.prop(opal, "spectral_bins")


class OPAL_RENDER_PT_simplify(_RenderPanel):
    """Blender's own stands where it was created last, above everything of an engine's: so Opal has one, as Cycles has."""

    bl_label = "Simplify"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: Any) -> None:
        self.layout.prop(context.scene.render, "use_simplify", text="")

    def draw_settings(self, layout: Any, opal: Any, context: Any) -> None:
        render = context.scene.render
        layout.active = render.use_simplify
        column = layout.column(align=True)
        column.prop(render, "simplify_subdivision", text="Max Subdivision Viewport")
        column.prop(render, "simplify_subdivision_render", text="Render")
        column = layout.column(align=True)
        column.prop(render, "simplify_child_particles", text="Max Child Particles Viewport")
        column.prop(render, "simplify_child_particles_render", text="Render")
        layout.prop(render, "simplify_volumes", text="Volume Resolution")


class OPAL_RENDER_PT_film(_RenderPanel):
    bl_label = "Film"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_settings(self, layout: Any, opal: Any, context: Any) -> None:
        layout.prop(opal, "film_exposure")
        layout.prop(context.scene.render, "film_transparent", text="Transparent")
        column = layout.column(align=True)
        column.prop(opal, "pixel_filter")
        column.prop(opal, "filter_width")


class OPAL_RENDER_PT_motion_blur(_RenderPanel):
    bl_label = "Motion Blur"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: Any) -> None:
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw_settings(self, layout: Any, opal: Any, context: Any) -> None:
        render = context.scene.render
        layout.active = render.use_motion_blur
        layout.prop(render, "motion_blur_position", text="Position")
        layout.prop(render, "motion_blur_shutter")


class OPAL_RENDER_PT_performance(_RenderPanel):
    bl_label = "Performance"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_settings(self, layout: Any, opal: Any, context: Any) -> None:
        render = context.scene.render
        column = layout.column()
        column.prop(render, "threads_mode")
        sub = column.column()
        sub.enabled = render.threads_mode == "FIXED"
        sub.prop(render, "threads")


class OPAL_VIEWLAYER_PT_passes(OpalPanel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: Any) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layer = context.view_layer
        column = layout.column(heading="Data")
        column.prop(layer, "use_pass_z", text="Depth")
        column.prop(layer, "use_pass_normal", text="Normal")
        column.prop(layer, "use_pass_position", text="Position")
        column.prop(layer.opal, "use_pass_albedo")
        column = layout.column(heading="Light")
        column.prop(layer, "use_pass_emit", text="Emission")
        column.prop(layer.opal, "use_pass_direct")
        column.prop(layer.opal, "use_pass_indirect")
        column.prop(layer.opal, "use_pass_caustics")
        column.prop(layer.opal, "use_pass_medium")


class OPAL_VIEWLAYER_PT_filter(OpalPanel):
    """What Opal reads of the filter that Blender's own engines show; of theirs not all is read."""

    bl_label = "Filter"
    bl_context = "view_layer"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column(heading="Include")
        column.prop(context.view_layer, "use_sky", text="Environment")
        column.prop(context.view_layer, "use_solid", text="Surfaces")
        column.prop(context.view_layer, "use_volumes", text="Volumes")


class OPAL_LIGHT_PT_spread(OpalPanel):
    bl_label = "Beam Shape"
    bl_context = "data"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and context.light is not None and context.light.type == "AREA"

    def draw(self, context: Any) -> None:
        self.layout.use_property_split = True
        self.layout.prop(context.light, "spread")


class OPAL_LIGHT_PT_nodes(OpalPanel):
    bl_label = "Nodes"
    bl_context = "data"
    bl_order = 10  # below the spectrum
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and context.light is not None

    def draw(self, context: Any) -> None:
        light = context.light
        self.layout.prop(light, "use_nodes")
        output = light.node_tree.get_output_node("ALL") if light.use_nodes and light.node_tree else None
        if output is not None:
            self.layout.template_node_view(light.node_tree, output, output.inputs["Surface"])


class OPAL_OBJECT_PT_ray_visibility(OpalPanel):
    bl_label = "Ray Visibility"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        types = {"MESH", "CURVE", "SURFACE", "FONT", "META", "LIGHT"}
        return super().poll(context) and context.object is not None and context.object.type in types

    def draw(self, context: Any) -> None:
        self.layout.use_property_split = True
        column = self.layout.column()
        obj = context.object
        for kind in ("camera", "diffuse", "glossy", "transmission", "volume_scatter", "shadow"):
            column.prop(obj, f"visible_{kind}", text=kind.replace("_", " ").title())
        if obj.type != "LIGHT":
            column.separator()
            column.prop(obj, "is_holdout")


CLASSES = (
    OPAL_RENDER_PT_sampling,
    OPAL_RENDER_PT_denoise,
    OPAL_RENDER_PT_photons,
    OPAL_RENDER_PT_volume_photons,
    OPAL_RENDER_PT_light_paths,
    OPAL_RENDER_PT_spectrum,
    OPAL_RENDER_PT_spectral_output,
    OPAL_RENDER_PT_simplify,
    OPAL_RENDER_PT_film,
    OPAL_RENDER_PT_motion_blur,
    OPAL_RENDER_PT_performance,
    OPAL_VIEWLAYER_PT_passes,
    OPAL_VIEWLAYER_PT_filter,
    OPAL_LIGHT_PT_spread,
    OPAL_LIGHT_PT_nodes,
    OPAL_OBJECT_PT_ray_visibility,
)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
