# SPDX-License-Identifier: GPL-3.0-or-later
"""What the example scenes share: an empty file, stones, stages, lamps, a camera, and the render.

Scenes are built at real size in metres: a carat diamond is 6.5 mm wide and the camera stands some centimetres from it. Each example
has `build()`, which makes the scene and returns it, and runs as a script in three ways::

    python examples/diamond.py                      # where bpy is a module: .venv/bin/python after `make zip`
    blender -b -P examples/diamond.py               # in Blender, with the extension Opal enabled
    python examples/diamond.py --engine CYCLES      # the same scene as Cycles sees it, for comparison
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
from mathutils import Matrix, Vector

if TYPE_CHECKING:
    import numpy as np

ROOT = Path(__file__).resolve().parent.parent
EXTENSION = "bl_ext.user_default.opal"

try:
    import opal_kernels.cuts  # noqa: F401
except ImportError:
    sys.path.append(str(ROOT / "kernels"))


def empty() -> bpy.types.Scene:
    """Start from nothing: a file without objects, in millimetres, with add-ons as they were."""
    bpy.ops.wm.read_homefile(use_empty=True)
    scene = bpy.context.scene
    scene.unit_settings.length_unit = "MILLIMETERS"
    scene.view_settings.view_transform = "AgX"
    return scene


# Shapes ------------------------------------------------------------------------------------------------------------------------------


def mesh(name: str, vertices: Sequence, faces: Sequence, material: bpy.types.Material, smooth: bool = False) -> bpy.types.Object:
    """An object from corners and polygons, in the scene's collection."""
    data = bpy.data.meshes.new(name)
    data.from_pydata([tuple(v) for v in vertices], [], [tuple(f) for f in faces])
    data.polygons.foreach_set("use_smooth", [smooth] * len(data.polygons))
    data.materials.append(material)
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def stone(name: str, cut, width: float, material: bpy.types.Material) -> bpy.types.Object:
    """A cut stone (`opal_kernels.cuts.Stone`) of this width in metres, table up, girdle about its origin."""
    solid = cut.scaled(width).solid
    return mesh(name, solid.vertices, solid.faces, material)


def sphere(name: str, centre: Sequence[float], radius: float, material: bpy.types.Material) -> bpy.types.Object:
    """A smooth ball of 64 × 128 faces; so fine that its shading normals and its surface part by less than a hundredth of a radian."""
    rings, segments = 64, 128
    vertices = [(0.0, 0.0, radius)]
    for i in range(1, rings):
        polar = math.pi * i / rings
        for j in range(segments):
            azimuth = math.tau * j / segments
            vertices.append(
                (radius * math.sin(polar) * math.cos(azimuth), radius * math.sin(polar) * math.sin(azimuth), radius * math.cos(polar))
            )
    vertices.append((0.0, 0.0, -radius))
    last = len(vertices) - 1
    faces = [(0, 1 + j, 1 + (j + 1) % segments) for j in range(segments)]
    for i in range(rings - 2):
        for j in range(segments):
            a, b = 1 + i * segments + j, 1 + i * segments + (j + 1) % segments
            faces.append((a, a + segments, b + segments, b))
    faces += [(last, last - segments + (j + 1) % segments, last - segments + j) for j in range(segments)]
    obj = mesh(name, vertices, faces, material, smooth=True)
    obj.location = centre
    return obj


def box(name: str, low: Sequence[float], high: Sequence[float], material: bpy.types.Material) -> bpy.types.Object:
    """A box from its lowest to its highest corner."""
    vertices = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    return mesh(name, vertices, [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)], material)


def rest_on_facet(obj: bpy.types.Object, index: int, place: Sequence[float], facing: float, gap: float = 2e-6) -> None:
    """Lay an object on a table top, on one of its faces.

    Parameters
    ----------
    index : int
        The polygon that lies on the table z = 0.
    place : (float, float)
        Where the polygon's centre lies, m.
    facing : float
        Azimuth towards which the object's own +z axis, a stone's table, then leans, radians from +x.
    gap : float
        Height of the face above the table, m: a gem touches its table on specks of dust, not on a plane.
    """
    polygon = obj.data.polygons[index]
    down = polygon.normal.rotation_difference(Vector((0.0, 0.0, -1.0))).to_matrix().to_4x4()
    axis = down @ Vector((0.0, 0.0, 1.0))
    pose = Matrix.Rotation(facing - math.atan2(axis.y, axis.x), 4, "Z") @ down
    low = pose @ polygon.center
    obj.matrix_world = Matrix.Translation(Vector((place[0], place[1], gap)) - low) @ pose


def stage(half: float, material: bpy.types.Material, depth: float = 0.0, wall: float = 0.0) -> bpy.types.Object:
    """A table top z = 0 of this half width; with a wall height, it bends up into a backdrop `depth` behind the origin (+y)."""
    if wall <= 0.0:
        return mesh("Table", [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], [(0, 1, 2, 3)], material)
    bend = 0.5 * wall
    profile = [(-half, 0.0), (depth, 0.0)]
    profile += [(depth + bend * math.sin(a), bend * (1 - math.cos(a))) for a in (math.radians(3.0 * i) for i in range(1, 31))]
    profile += [(depth + bend, wall)]
    vertices = [(x, y, z) for y, z in profile for x in (-half, half)]
    faces = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(profile) - 1)]
    return mesh("Table", vertices, faces, material, smooth=True)


# Materials ---------------------------------------------------------------------------------------------------------------------------


def surface(name: str, colour: Sequence[float], roughness: float = 0.5, metallic: float = 0.0, specular: float = 0.5) -> bpy.types.Material:
    """A Principled surface; colour in linear Rec.709."""
    material = _with_nodes(name)
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (*colour, 1.0)
    shader.inputs["Roughness"].default_value = roughness
    shader.inputs["Metallic"].default_value = metallic
    shader.inputs["Specular IOR Level"].default_value = specular
    return material


def matte(name: str, colour: Sequence[float]) -> bpy.types.Material:
    """A Lambertian surface; colour in linear Rec.709."""
    material = _with_nodes(name)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    shader, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["Color"].default_value = (*colour, 1.0)
    links.new(shader.outputs["BSDF"], output.inputs["Surface"])
    return material


def checker(name: str, first: Sequence[float], second: Sequence[float], tiles: float) -> bpy.types.Material:
    """A Lambertian checkerboard of this many tiles a metre, by the object's own coordinates."""
    material = matte(name, first)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    pattern, coordinates = nodes.new("ShaderNodeTexChecker"), nodes.new("ShaderNodeTexCoord")
    pattern.inputs["Color1"].default_value, pattern.inputs["Color2"].default_value = (*first, 1.0), (*second, 1.0)
    pattern.inputs["Scale"].default_value = tiles
    links.new(coordinates.outputs["Object"], pattern.inputs["Vector"])
    shader = next(node for node in nodes if node.type == "BSDF_DIFFUSE")
    links.new(pattern.outputs["Color"], shader.inputs["Color"])
    return material


# Index at the D line and colour in transmission of the glass that stands for each species where the engine is not Opal.
_PLAIN_GLASS = {
    "DIAMOND": (2.417, (1.0, 1.0, 1.0)),
    "SF11": (1.784, (1.0, 1.0, 1.0)),
    "BK7": (1.517, (1.0, 1.0, 1.0)),
    "RUBY": (1.768, (0.9, 0.05, 0.08)),
    "SAPPHIRE_BLUE": (1.768, (0.05, 0.12, 0.8)),
    "EMERALD": (1.583, (0.05, 0.7, 0.25)),
    "AMETHYST": (1.544, (0.55, 0.25, 0.85)),
}


def gem(name: str, species: str, **settings: object) -> bpy.types.Material:
    """A gem of one of Opal's species; settings go to `material.opal.gem`."""
    material = _with_nodes(name)
    index, colour = _PLAIN_GLASS.get(species, (settings.get("cauchy_b", 1.5), (1.0, 1.0, 1.0)))
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    shader, output = nodes.new("ShaderNodeBsdfGlass"), nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["IOR"].default_value = index
    shader.inputs["Roughness"].default_value = 0.0
    shader.inputs["Color"].default_value = (*colour, 1.0)
    links.new(shader.outputs["BSDF"], output.inputs["Surface"])
    if hasattr(material, "opal"):
        material.opal.kind = "GEM"
        material.opal.gem.species = species
        for key, value in settings.items():
            setattr(material.opal.gem, key, value)
    return material


def glass(
    name: str, index: float, dispersion: float = 0.0, colour: Sequence[float] = (1.0, 1.0, 1.0), depth: float = 0.01
) -> bpy.types.Material:
    """A transparent body by Cauchy's formula n = index + dispersion/λ² (µm²); white light becomes `colour` in `depth` metres of it."""
    return gem(name, "CUSTOM", dispersion="CAUCHY", cauchy_b=index, cauchy_c=dispersion, absorption_color=colour, absorption_depth=depth)


def medium(name: str, extinction: float, albedo: Sequence[float] = (1.0, 1.0, 1.0), anisotropy: float = 0.0) -> bpy.types.Material:
    """A homogeneous medium.

    Parameters
    ----------
    extinction : float
        σt, 1/m.
    albedo : (float, float, float)
        σs / σt, linear Rec.709.
    anisotropy : float
        Mean cosine of Henyey and Greenstein's phase function; 0 is isotropic.
    """
    material = _with_nodes(name)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    volume, output = nodes.new("ShaderNodeVolumePrincipled"), nodes.new("ShaderNodeOutputMaterial")
    volume.inputs["Density"].default_value = extinction
    volume.inputs["Color"].default_value = (*albedo, 1.0)
    volume.inputs["Anisotropy"].default_value = anisotropy
    links.new(volume.outputs["Volume"], output.inputs["Volume"])
    if hasattr(material, "opal"):
        material.opal.kind = "MEDIUM"
        settings = material.opal.medium
        settings.extinction, settings.albedo = extinction, albedo
        settings.phase = "HENYEY_GREENSTEIN" if anisotropy else "ISOTROPIC"
        settings.anisotropy = anisotropy
    return material


def limit(scene: bpy.types.Scene, passes: int, photons: int, seconds: float = 160.0, **settings: object) -> None:
    """Passes and photons a pass of Opal, denoised, the time after which the render ends at the latest, and other settings of
    `scene.opal`; nothing without the engine."""
    if hasattr(scene, "opal"):
        scene.opal.passes, scene.opal.photons_per_pass, scene.opal.time_limit = passes, photons, seconds
        scene.opal.denoise = True
        for key, value in settings.items():
            setattr(scene.opal, key, value)


def _with_nodes(name: str) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    if material.node_tree is None:  # Blender 5 makes it with the material; 4.5 on demand.
        material.use_nodes = True
    return material


# Light -------------------------------------------------------------------------------------------------------------------------------


def lamp(name: str, kind: str, place: Sequence[float], target: Sequence[float], energy: float, **settings: object) -> bpy.types.Object:
    """A lamp that looks from its place at a target; energy in W (sun: W/m²)."""
    data = bpy.data.lights.new(name, kind)
    data.energy = energy
    for key, value in settings.items():
        setattr(data, key, value)
    obj = bpy.data.objects.new(name, data)
    obj.matrix_world = _looking(place, target)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def studio_light(name: str) -> Path:
    """One of the HDRIs that come with Blender (city, courtyard, forest, interior, night, studio, sunrise, sunset)."""
    folder = Path(bpy.utils.resource_path("LOCAL")) / "datafiles" / "studiolights" / "world"
    path = folder / f"{name}.exr"
    if not path.exists():
        raise FileNotFoundError(f"this Blender brings no {path.name} in {folder}; it has {sorted(p.name for p in folder.glob('*.exr'))}")
    return path


def hdri(path: Path, strength: float, turn: float = 0.0) -> bpy.types.World:
    """A world lit by an image, turned about the vertical by some radians."""
    world = bpy.data.worlds.new("World")
    bpy.context.scene.world = world
    if world.node_tree is None:
        world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    coordinates, mapping = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeMapping")
    image, background = nodes.new("ShaderNodeTexEnvironment"), nodes.new("ShaderNodeBackground")
    output = nodes.new("ShaderNodeOutputWorld")
    image.image = bpy.data.images.load(str(path))
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, turn)
    background.inputs["Strength"].default_value = strength
    links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], image.inputs["Vector"])
    links.new(image.outputs["Color"], background.inputs["Color"])
    links.new(background.outputs["Background"], output.inputs["Surface"])
    return world


def plain_world(colour: Sequence[float], strength: float) -> bpy.types.World:
    """A world of one colour; linear Rec.709 radiance times strength."""
    world = bpy.data.worlds.new("World")
    bpy.context.scene.world = world
    if world.node_tree is None:
        world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    background, output = nodes.new("ShaderNodeBackground"), nodes.new("ShaderNodeOutputWorld")
    background.inputs["Color"].default_value = (*colour, 1.0)
    background.inputs["Strength"].default_value = strength
    links.new(background.outputs["Background"], output.inputs["Surface"])
    return world


# Camera and render -------------------------------------------------------------------------------------------------------------------


def camera(
    place: Sequence[float], target: Sequence[float], lens: float, fstop: float = 0.0, focus: Sequence[float] | None = None
) -> bpy.types.Object:
    """A camera that looks from its place at a target.

    Parameters
    ----------
    place, target : sequence of 3 floats
        World coordinates, m.
    lens : float
        Focal length for a 36 mm wide sensor, mm.
    fstop : float
        Aperture number; 0 keeps everything sharp.
    focus : sequence of 3 floats, optional
        The point that is sharp; the target when left out.
    """
    data = bpy.data.cameras.new("Camera")
    data.lens, data.sensor_width = lens, 36.0
    data.clip_start, data.clip_end = 1e-4, 1e3
    obj = bpy.data.objects.new("Camera", data)
    obj.matrix_world = _looking(place, target)
    if fstop > 0.0:
        ahead = (Vector(target) - Vector(place)).normalized()
        data.dof.use_dof = True
        data.dof.aperture_fstop = fstop
        data.dof.focus_distance = (Vector(focus or target) - Vector(place)).dot(ahead)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.scene.camera = obj
    return obj


def _looking(place: Sequence[float], target: Sequence[float]) -> Matrix:
    direction = Vector(target) - Vector(place)
    return Matrix.Translation(Vector(place)) @ direction.to_track_quat("-Z", "Y").to_matrix().to_4x4()


def use_engine(scene: bpy.types.Scene, engine: str) -> None:
    """Choose the render engine, enabling the installed extension if it is not enabled yet.

    Raises
    ------
    RuntimeError
        If Opal is asked for and not installed.
    """
    if engine == "OPAL" and not hasattr(bpy.types.Scene, "opal"):
        raise RuntimeError(
            f"the extension Opal is not enabled: install the zip that `make zip` leaves in {ROOT / 'dist'}, or pass --engine CYCLES"
        )
    scene.render.engine = engine


def enable_opal() -> None:
    """Enable the installed extension, if there is one and it is not enabled; properties exist only from then on."""
    if not hasattr(bpy.types.Scene, "opal"):
        import addon_utils

        if any(module.__name__ == EXTENSION for module in addon_utils.modules()):
            addon_utils.enable(EXTENSION, default_set=False)


def render(scene: bpy.types.Scene, path: Path) -> Path:
    """Render one picture to a PNG and return its path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return path


def passes_of_render(scene: bpy.types.Scene, path: Path) -> dict[str, np.ndarray]:
    """The passes of the render that was just made, kept in a multilayer OpenEXR file: by name, (height, width, channels), linear,
    rows from the bottom up."""
    import numpy as np

    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
    bpy.data.images["Render Result"].save_render(str(path), scene=scene)
    bpy.utils.expose_bundled_modules()
    import OpenImageIO as oiio

    found: dict[str, dict[str, np.ndarray]] = {}
    for part in range(oiio.ImageBuf(str(path)).nsubimages):
        image = oiio.ImageBuf(str(path), part, 0)
        pixels = image.get_pixels(oiio.FLOAT)[::-1]
        for i, name in enumerate(image.spec().channelnames):
            _, pass_name, letter = name.rsplit(".", 2)
            found.setdefault(pass_name, {})[letter] = pixels[..., i]
    return {name: np.stack([planes[letter] for letter in "RGBAXYZV" if letter in planes], axis=-1) for name, planes in found.items()}


def write_picture(scene: bpy.types.Scene, picture: np.ndarray, path: Path) -> None:
    """A linear picture, rows from the bottom up, as a PNG through the scene's view."""
    import numpy as np

    height, width, _ = picture.shape
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_depth = "PNG", "8"
    image = bpy.data.images.new(path.stem, width, height, float_buffer=True)
    image.colorspace_settings.name = "Linear Rec.709"
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = picture
    image.pixels.foreach_set(pixels.reshape(-1))
    image.save_render(str(path), scene=scene)
    bpy.data.images.remove(image)


def run(build: Callable[[], bpy.types.Scene], name: str, afterwards: Callable[[bpy.types.Scene, Path], None] | None = None) -> None:
    """The scripts' `main`: build the scene, render it, print where the picture is; then do with the render what `afterwards` does."""
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:] if not bpy.app.binary_path else []
    parser = argparse.ArgumentParser(prog=name, description=sys.modules["__main__"].__doc__)
    parser.add_argument("--engine", default="OPAL", help="OPAL, or CYCLES to compare")
    parser.add_argument("--passes", type=int, help="passes of Opal, samples of Cycles")
    parser.add_argument("--percent", type=int, default=100, help="size of the picture, percent")
    parser.add_argument("--output", type=Path, default=ROOT / "renders" / f"{name}.png")
    parser.add_argument("--save", type=Path, help="also save the scene as a .blend")
    options = parser.parse_args(arguments)
    enable_opal()
    scene = build()
    use_engine(scene, options.engine)
    scene.render.resolution_percentage = options.percent
    if options.engine == "CYCLES":
        scene.cycles.samples = options.passes or 64
        scene.cycles.use_denoising = False
    elif options.passes:
        scene.opal.passes = options.passes
    if options.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(options.save.resolve()))
    path = render(scene, options.output.resolve())
    if afterwards is not None and options.engine == "OPAL":
        afterwards(scene, path)
    print(path, flush=True)
