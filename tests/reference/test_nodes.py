# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes beside Cycles': what a node gives, shown as emission, is what Opal's program gives at the same points.

Continuous nodes are held to 1e-3 everywhere. Nodes with edges (cells, steps) may differ in the few pixels whose centre lies
on one, as the two renderers' points differ by rounding.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
from node_images import difference, emission_material, new_tree, node, out, set_inputs, stage, world_difference  # noqa: E402

CASES: dict = {}


def case(name: str, edges: bool = False, tolerance: float = 1e-3):
    def register(build):
        CASES[name] = (build, edges, tolerance)
        return build

    return register


def coordinate(tree, which="Generated"):
    return out(node(tree, "TexCoord"), which)


for which in ("Generated", "Normal", "UV", "Object", "Camera", "Window", "Reflection"):
    case(f"coordinate {which}")(lambda t, w=which: coordinate(t, w))
for which in ("Position", "Normal", "True Normal", "Incoming", "Tangent", "Backfacing"):
    case(f"geometry {which}")(lambda t, w=which: out(node(t, "NewGeometry"), w))
for which in ("Location", "Color", "Alpha", "Object Index"):
    case(f"object {which}")(lambda t, w=which: out(node(t, "ObjectInfo"), w))
for which in ("View Vector", "View Z Depth", "View Distance"):
    case(f"camera {which}")(lambda t, w=which: out(node(t, "CameraData"), w))
for which in ("Color", "Fac", "Alpha"):
    case(f"attribute {which}")(lambda t, w=which: out(node(t, "Attribute", attribute_name="Shade"), w))
for which in ("Is Camera Ray", "Is Shadow Ray", "Ray Depth"):
    case(f"light path {which}")(lambda t, w=which: out(node(t, "LightPath"), w))
case("colour attribute")(lambda t: out(node(t, "VertexColor", layer_name="Shade")))
case("fresnel")(lambda t: out(node(t, "Fresnel", {"IOR": 1.7})))
case("layer weight fresnel")(lambda t: out(node(t, "LayerWeight", {"Blend": 0.3}), "Fresnel"))
case("layer weight facing")(lambda t: out(node(t, "LayerWeight", {"Blend": 0.7}), "Facing"))
case("tangent radial")(lambda t: out(node(t, "Tangent", direction_type="RADIAL", axis="X")))
case("tangent UV", tolerance=2e-2)(lambda t: out(node(t, "Tangent", direction_type="UV_MAP")))


def two_numbers(tree):
    """Two numbers that vary over the ball, from about -1 to 1."""
    xyz = node(tree, "SeparateXYZ", {"Vector": coordinate(tree, "Object")})
    return out(xyz, "X"), out(xyz, "Y")


MATHS = (
    "ADD SUBTRACT MULTIPLY DIVIDE MULTIPLY_ADD POWER LOGARITHM SQRT INVERSE_SQRT ABSOLUTE EXPONENT MINIMUM MAXIMUM LESS_THAN "
    "GREATER_THAN SIGN COMPARE SMOOTH_MIN SMOOTH_MAX ROUND FLOOR CEIL TRUNC FRACT MODULO FLOORED_MODULO WRAP SNAP PINGPONG "
    "SINE COSINE TANGENT ARCSINE ARCCOSINE ARCTANGENT ARCTAN2 SINH COSH TANH RADIANS DEGREES"
).split()
STEPS = "LESS_THAN GREATER_THAN SIGN COMPARE ROUND FLOOR CEIL TRUNC FRACT MODULO FLOORED_MODULO WRAP SNAP DIVIDE ARCTAN2".split()


def soft(tree, socket):
    """Brings numbers of any size into 0..1, so that tolerances mean something."""
    half = node(tree, "Math", {"Value": socket, "Value_001": 0.25}, operation="MULTIPLY")
    return out(node(tree, "Math", {"Value": out(half)}, operation="TANH"))


for operation in MATHS:

    def math(tree, operation=operation):
        x, y = two_numbers(tree)
        return soft(tree, out(node(tree, "Math", {"Value": x, "Value_001": y, "Value_002": 0.3}, operation=operation)))

    case(f"math {operation}", edges=operation in STEPS)(math)

VECTOR_MATHS = (
    "ADD SUBTRACT MULTIPLY DIVIDE MULTIPLY_ADD CROSS_PRODUCT PROJECT REFLECT REFRACT FACEFORWARD DOT_PRODUCT DISTANCE LENGTH SCALE "
    "NORMALIZE ABSOLUTE POWER SIGN MINIMUM MAXIMUM FLOOR CEIL FRACTION MODULO WRAP SNAP SINE COSINE TANGENT"
).split()
VECTOR_STEPS = "DIVIDE FACEFORWARD SIGN FLOOR CEIL FRACTION MODULO WRAP SNAP".split()
for operation in VECTOR_MATHS:

    def vector_math(tree, operation=operation):
        inputs = {
            "Vector": coordinate(tree, "Object"),
            "Vector_001": coordinate(tree, "Normal"),
            "Vector_002": (0.3, -0.4, 0.2),
            "Scale": 0.7,
        }
        made = node(tree, "VectorMath", inputs, operation=operation)
        number = operation in ("DOT_PRODUCT", "DISTANCE", "LENGTH")
        return (
            soft(tree, out(made, "Value")) if number else out(node(tree, "VectorMath", {"Vector": out(made, "Vector")}, operation="COSINE"))
        )

    case(f"vector math {operation}", edges=operation in VECTOR_STEPS)(vector_math)

BLENDS = (
    "MIX DARKEN MULTIPLY BURN LIGHTEN SCREEN DODGE ADD OVERLAY SOFT_LIGHT LINEAR_LIGHT DIFFERENCE EXCLUSION SUBTRACT DIVIDE HUE "
    "SATURATION COLOR VALUE"
).split()
for blend_type in BLENDS:

    def blend(tree, blend_type=blend_type):
        inputs = {"Factor_Float": 0.7, "A_Color": coordinate(tree), "B_Color": coordinate(tree, "UV")}
        return out(node(tree, "Mix", inputs, data_type="RGBA", blend_type=blend_type, clamp_result=True), "Result_Color")

    case(f"mix {blend_type}", edges=blend_type in ("BURN", "DIVIDE", "HUE", "COLOR"))(blend)


@case("mix vector, a factor a component")
def _(tree):
    inputs = {"Factor_Vector": coordinate(tree), "A_Vector": (0, 0.5, 1), "B_Vector": coordinate(tree, "Normal")}
    return out(node(tree, "Mix", inputs, data_type="VECTOR", factor_mode="NON_UNIFORM"), "Result_Vector")


@case("mix float, unclamped")
def _(tree):
    x, y = two_numbers(tree)
    return out(node(tree, "Mix", {"Factor_Float": x, "A_Float": y, "B_Float": 0.8}, clamp_factor=False), "Result_Float")


@case("mix, the older node")
def _(tree):
    return out(node(tree, "MixRGB", {"Fac": 0.4, "Color1": coordinate(tree), "Color2": (0.2, 0.9, 0.1, 1)}, blend_type="SCREEN"))


for interpolation in ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP"):

    def map_range(tree, interpolation=interpolation):
        x, y = two_numbers(tree)
        inputs = {"Value": x, "From Min": 0.6, "From Max": -0.5, "To Min": y, "To Max": 0.9, "Steps": 3}
        return out(node(tree, "MapRange", inputs, interpolation_type=interpolation, clamp=True), "Result")

    def map_range_vector(tree, interpolation=interpolation):
        inputs = {"Vector": coordinate(tree), "From_Min_FLOAT3": (0.2, 0.9, 0.3), "From_Max_FLOAT3": (0.6, 0.1, 0.3)}
        made = node(tree, "MapRange", inputs, data_type="FLOAT_VECTOR", interpolation_type=interpolation, clamp=True)
        return out(made, "Vector")

    case(f"map range {interpolation}", edges=interpolation == "STEPPED")(map_range)
    case(f"map range {interpolation}, vector", edges=interpolation == "STEPPED")(map_range_vector)

for clamp_type in ("MINMAX", "RANGE"):
    case(f"clamp {clamp_type}")(
        lambda t, c=clamp_type: out(node(t, "Clamp", {"Value": two_numbers(t)[0], "Min": 0.5, "Max": 0.1}, clamp_type=c))
    )
for vector_type in ("POINT", "TEXTURE", "VECTOR", "NORMAL"):
    case(f"mapping {vector_type}")(
        lambda t, v=vector_type: out(
            node(
                t,
                "Mapping",
                {"Vector": coordinate(t, "Object"), "Location": (0.1, 0.2, 0.3), "Rotation": (0.4, -0.5, 0.6), "Scale": (1.5, 2, 0.5)}
                if v != "VECTOR" and v != "NORMAL"
                else {"Vector": coordinate(t, "Object"), "Rotation": (0.4, -0.5, 0.6), "Scale": (1.5, 2, 0.5)},
                vector_type=v,
            )
        )
    )
for rotation_type in ("AXIS_ANGLE", "X_AXIS", "Y_AXIS", "Z_AXIS", "EULER_XYZ"):

    def rotate(tree, rotation_type=rotation_type):
        made = node(
            tree,
            "VectorRotate",
            {"Vector": coordinate(tree, "Object"), "Center": (0.1, 0.2, 0.3)},
            rotation_type=rotation_type,
            invert=True,
        )
        set_inputs(made, {"Axis": (1, 2, 3), "Angle": 0.8, "Rotation": (0.4, -0.5, 0.6)})
        return out(made)

    case(f"rotate {rotation_type}")(rotate)
for vector_type in ("POINT", "VECTOR", "NORMAL"):
    for ends in (
        ("WORLD", "OBJECT"),
        ("OBJECT", "WORLD"),
        ("WORLD", "CAMERA"),
        ("CAMERA", "WORLD"),
        ("OBJECT", "CAMERA"),
        ("CAMERA", "OBJECT"),
    ):

        def transform(tree, vector_type=vector_type, ends=ends):
            source = coordinate(tree, "Normal")
            made = node(tree, "VectorTransform", {"Vector": source}, vector_type=vector_type, convert_from=ends[0], convert_to=ends[1])
            return out(made)

        case(f"transform {vector_type} {ends[0]} to {ends[1]}")(transform)


@case("normal node")
def _(tree):
    made = node(tree, "Normal", {"Normal": coordinate(tree, "Normal")})
    made.outputs["Normal"].default_value = (0.3, 0.4, 0.8)
    return out(made, "Dot")


case("hue and saturation", edges=True)(
    lambda t: out(node(t, "HueSaturation", {"Hue": 0.3, "Saturation": 1.4, "Value": 0.8, "Fac": 0.9, "Color": coordinate(t)}))
)
case("invert")(lambda t: out(node(t, "Invert", {"Fac": 0.8, "Color": coordinate(t)})))
case("gamma")(lambda t: out(node(t, "Gamma", {"Gamma": 2.2, "Color": coordinate(t, "Object")})))
case("bright and contrast")(lambda t: out(node(t, "BrightContrast", {"Bright": 0.1, "Contrast": 0.3, "Color": coordinate(t)})))
case("rgb to bw")(lambda t: out(node(t, "RGBToBW", {"Color": coordinate(t)})))
case("vector to number")(lambda t: out(node(t, "Math", {"Value": coordinate(t), "Value_001": 0.0})))
for mode in ("RGB", "HSV", "HSL"):

    def colors(tree, mode=mode):
        apart = node(tree, "SeparateColor", {"Color": coordinate(tree)}, mode=mode)
        parts = {"Red": out(apart, "Green"), "Green": out(apart, "Blue"), "Blue": out(apart, "Red")}
        return out(node(tree, "CombineColor", parts, mode=mode))

    case(f"colour apart and together {mode}", edges=mode != "RGB")(colors)


def ramp(tree, interpolation):
    made = node(tree, "ValToRGB", {"Fac": two_numbers(tree)[0]})
    made.color_ramp.interpolation = interpolation
    made.color_ramp.elements[0].color = (0.9, 0.1, 0.3, 0.5)
    middle = made.color_ramp.elements.new(0.35)
    middle.color = (0.1, 0.8, 0.2, 0.7)
    return out(made)


for interpolation in ("LINEAR", "EASE", "CONSTANT", "B_SPLINE"):
    case(f"ramp {interpolation}", edges=interpolation == "CONSTANT")(lambda t, i=interpolation: ramp(t, i))


def bent(made, curve):
    point = made.mapping.curves[curve].points.new(0.4, 0.75)
    point.handle_type = "AUTO"
    made.mapping.update()
    return out(made)


case("curves RGB")(lambda t: bent(node(t, "RGBCurve", {"Fac": 0.9, "Color": coordinate(t, "Object")}), 1))
case("curves RGB, together")(lambda t: bent(node(t, "RGBCurve", {"Fac": 0.9, "Color": coordinate(t, "Object")}), 3))
case("curves vector")(lambda t: bent(node(t, "VectorCurve", {"Fac": 0.9, "Vector": coordinate(t, "Normal")}), 2))
case("curve")(lambda t: bent(node(t, "FloatCurve", {"Factor": 0.9, "Value": two_numbers(t)[0]}), 0))
# Planck's law against Cycles' fit of it, and another table of the observer.
case("blackbody", tolerance=2e-2)(lambda t: out(node(t, "Blackbody", {"Temperature": 5200.0})))
case("wavelength", tolerance=1e-2)(
    lambda t: out(
        node(
            t,
            "Wavelength",
            {
                "Wavelength": out(
                    node(t, "MapRange", {"Value": two_numbers(t)[0], "From Min": -1.0, "To Min": 400.0, "To Max": 720.0}), "Result"
                )
            },
        )
    )
)

case("checker", edges=True)(lambda t: out(node(t, "TexChecker", {"Scale": 7.0})))
for dimensions in ("1D", "2D", "3D", "4D"):
    inputs = {"W": 0.7, "Scale": 3.0, "Detail": 2.6, "Roughness": 0.6, "Distortion": 0.4}
    sockets = {"1D": ("W",), "4D": ("W",)}
    for which in ("Fac", "Color"):

        def noise(tree, dimensions=dimensions, which=which, inputs=inputs):
            made = node(tree, "TexNoise", noise_dimensions=dimensions)
            set_inputs(made, inputs)
            if dimensions == "1D":
                tree.links.new(two_numbers(tree)[0], made.inputs["W"])
            return out(made, which)

        case(f"noise {dimensions} {which}")(noise)
    case(f"white noise {dimensions}")(
        lambda t, d=dimensions: out(node(t, "TexWhiteNoise", {"W": 0.3, "Vector": (0.1, 0.2, 0.3)}, noise_dimensions=d), "Color")
    )
for noise_type in ("MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "HETERO_TERRAIN"):

    def fractal(tree, noise_type=noise_type):
        made = node(tree, "TexNoise", noise_type=noise_type)
        set_inputs(made, {"Scale": 3.0, "Detail": 3.4, "Roughness": 0.7, "Lacunarity": 2.1, "Offset": 0.8, "Gain": 1.3})
        return soft(tree, out(made))

    case(f"noise {noise_type}")(fractal)

for feature in ("F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE", "N_SPHERE_RADIUS"):
    for dimensions in ("1D", "2D", "3D", "4D"):
        for which in {"DISTANCE_TO_EDGE": ("Distance",), "N_SPHERE_RADIUS": ("Radius",)}.get(feature, ("Distance", "Color", "Position")):
            if dimensions == "1D" and which == "Position":
                which = "W"

            def voronoi(tree, feature=feature, dimensions=dimensions, which=which):
                made = node(tree, "TexVoronoi", feature=feature, voronoi_dimensions=dimensions)
                set_inputs(made, {"W": 0.7, "Scale": 4.0, "Detail": 1.4, "Roughness": 0.6, "Smoothness": 0.8, "Randomness": 0.9})
                if dimensions == "1D":
                    tree.links.new(two_numbers(tree)[0], made.inputs["W"])
                return out(made, which)

            case(f"voronoi {feature} {dimensions} {which}", edges=feature != "SMOOTH_F1")(voronoi)
for metric in ("MANHATTAN", "CHEBYCHEV", "MINKOWSKI"):
    case(f"voronoi {metric}", edges=True)(
        lambda t, m=metric: out(node(t, "TexVoronoi", {"Scale": 4.0}, distance=m, normalize=True), "Distance")
    )
for wave_type in ("BANDS", "RINGS"):
    for profile in ("SIN", "SAW", "TRI"):
        settings = {"wave_type": wave_type, "wave_profile": profile}
        inputs_wave = {"Scale": 2.0, "Distortion": 1.5, "Detail": 1.5, "Phase Offset": 0.4}
        case(f"wave {wave_type} {profile}", edges=profile == "SAW")(
            lambda t, s=dict(settings), i=dict(inputs_wave): out(node(t, "TexWave", i, **s), "Fac")
        )
for direction in ("X", "Y", "Z", "DIAGONAL"):
    case(f"wave bands {direction}")(lambda t, d=direction: out(node(t, "TexWave", bands_direction=d), "Fac"))
for direction in ("X", "Y", "Z", "SPHERICAL"):
    case(f"wave rings {direction}")(lambda t, d=direction: out(node(t, "TexWave", wave_type="RINGS", rings_direction=d), "Fac"))
for depth in (0, 2, 5, 10):
    case(f"magic {depth}", tolerance=1e-2)(
        lambda t, d=depth: out(node(t, "TexMagic", {"Scale": 2.0, "Distortion": 1.3}, turbulence_depth=d))
    )
case("brick", edges=True)(
    lambda t: out(
        node(t, "TexBrick", {"Scale": 3.0, "Bias": 0.1, "Mortar Size": 0.05, "Mortar Smooth": 0.5}, squash=0.7, offset_frequency=3)
    )
)
case("brick mortar", edges=True)(lambda t: out(node(t, "TexBrick", {"Scale": 2.0}), "Fac"))
for gradient_type in ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "SPHERICAL", "QUADRATIC_SPHERE", "RADIAL"):
    case(f"gradient {gradient_type}", edges=gradient_type == "RADIAL")(
        lambda t, g=gradient_type: out(node(t, "TexGradient", {"Vector": coordinate(t, "Object")}, gradient_type=g), "Fac")
    )


# ---- Images ----


def picture(width=7, height=5, is_float=False, alpha=1.0, space=None, alpha_mode="STRAIGHT"):
    """A small image of known, irregular pixels."""
    image = bpy.data.images.new("picture", width, height, alpha=True, float_buffer=is_float)
    values = np.random.default_rng(1).random((height, width, 4), np.float32)
    values[:, :, 3] = alpha if alpha is not None else 0.2 + 0.7 * values[:, :, 3]
    if alpha_mode == "PREMUL":
        values[:, :, :3] *= values[:, :, 3:]
    image.pixels.foreach_set(values.ravel())
    image.update()
    if alpha_mode == "PREMUL":  # comes from files alone: what is in memory is straight
        image.filepath_raw = str(Path(tempfile.mkdtemp()) / "picture.png")
        image.file_format = "PNG"
        image.save()
        image = bpy.data.images.load(image.filepath_raw)
    else:
        image.pack()
    if space:
        image.colorspace_settings.name = space
    image.alpha_mode = alpha_mode
    if alpha_mode == "PREMUL":
        image.reload()
    return image


def textured(tree, image, scale=1.7, source="Object", **settings):
    vector = out(node(tree, "Mapping", {"Vector": coordinate(tree, source), "Scale": (scale,) * 3, "Location": (0.2, 0.1, 0.3)}))
    return node(tree, "TexImage", {"Vector": vector}, image=image, **settings)


for interpolation in ("Linear", "Closest", "Cubic", "Smart"):
    case(f"image {interpolation}", edges=interpolation == "Closest", tolerance=2e-3)(
        lambda t, i=interpolation: out(textured(t, picture(), interpolation=i))
    )
for extension in ("REPEAT", "EXTEND", "CLIP", "MIRROR"):
    case(f"image {extension}", edges=True, tolerance=2e-3)(lambda t, e=extension: out(textured(t, picture(), extension=e)))
for projection in ("BOX", "SPHERE", "TUBE"):
    case(f"image {projection}", edges=True, tolerance=2e-3)(
        lambda t, p=projection: out(textured(t, picture(), source="Generated", scale=1.0, projection=p, projection_blend=0.3))
    )
case("image of floats")(lambda t: out(textured(t, picture(is_float=True))))
case("image that is data")(lambda t: out(textured(t, picture(space="Non-Color"))))
case("image of floats that is data")(lambda t: out(textured(t, picture(is_float=True, space="Non-Color"))))
# Blender 4.5's Cycles multiplies premultiplied files by alpha once more; 5 mended it.
for alpha_mode in ("STRAIGHT", "CHANNEL_PACKED", "NONE", "PREMUL")[: 4 if bpy.app.version >= (5, 0) else 3]:
    # 8-bit colours are multiplied by alpha in 8 bits, with Cycles' rounding.
    case(f"image alpha {alpha_mode}, colour alone", tolerance=6e-3)(
        lambda t, a=alpha_mode: out(textured(t, picture(alpha=None, alpha_mode=a)))
    )
    case(f"image alpha {alpha_mode}, alpha")(lambda t, a=alpha_mode: out(textured(t, picture(alpha=None, alpha_mode=a)), "Alpha"))

    def both(tree, alpha_mode=alpha_mode):
        made = textured(tree, picture(alpha=None, alpha_mode=alpha_mode))
        return out(node(tree, "Mix", {"Factor_Float": out(made, "Alpha"), "A_Color": out(made)}, data_type="RGBA"), "Result_Color")

    case(f"image alpha {alpha_mode}, both", tolerance=2e-2)(both)


def tiles(packed):
    """An image of two tiles on disk, 1001 and 1012, of different sizes."""
    folder = Path(tempfile.mkdtemp())
    for number, size in ((1001, (5, 4)), (1012, (8, 8))):
        tile = bpy.data.images.new("tile", *size)
        values = np.ones((size[1], size[0], 4), np.float32)
        values[..., :3] = np.random.default_rng(number).random((size[1], size[0], 3))
        tile.pixels.foreach_set(values.ravel())
        tile.filepath_raw, tile.file_format = str(folder / f"tiles.{number}.png"), "PNG"
        tile.save()
        bpy.data.images.remove(tile)
    image = bpy.data.images.load(str(folder / "tiles.1001.png"))
    image.source = "TILED"
    image.filepath_raw = str(folder / "tiles.<UDIM>.png")
    if all(tile.number != 1012 for tile in image.tiles):
        image.tiles.new(1012)
    image.reload()
    if packed:
        image.pack()
    return image


for packed in (False, True):

    @case(f"image of tiles{', packed' if packed else ''}", edges=True, tolerance=2e-3)
    def tiled(tree, packed=packed):
        """The ball spans both tiles and places that no tile covers."""
        vector = out(node(tree, "Mapping", {"Vector": coordinate(tree), "Location": (1.1, 1.1, 0), "Scale": (0.9, 0.9, 0.9)}))
        return out(node(tree, "TexImage", {"Vector": vector}, image=tiles(packed), interpolation="Closest"))


@case("image by its UV map")
def _(tree):
    return out(node(tree, "TexImage", image=picture()))


@case("environment on a ball", edges=True, tolerance=2e-3)
def _(tree):
    return out(node(tree, "TexEnvironment", {"Vector": coordinate(tree, "Normal")}, image=picture(16, 8)))


@case("mirror ball on a ball", tolerance=2e-3)
def _(tree):
    return out(node(tree, "TexEnvironment", {"Vector": coordinate(tree, "Normal")}, image=picture(16, 8), projection="MIRROR_BALL"))


# ---- Normals ----


def shown(tree, normal):
    """A normal as a colour."""
    return out(node(tree, "VectorMath", {"Vector": normal, "Vector_001": (0.5,) * 3, "Vector_002": (0.5,) * 3}, operation="MULTIPLY_ADD"))


for space in ("TANGENT", "OBJECT", "WORLD", "BLENDER_OBJECT", "BLENDER_WORLD"):
    for strength in (1.0, 0.6):

        def normal_map(tree, space=space, strength=strength):
            made = node(tree, "NormalMap", {"Color": (0.7, 0.4, 0.9, 1), "Strength": strength}, space=space)
            return shown(tree, out(made))

        case(f"normal map {space} {strength}", tolerance=2e-2 if space == "TANGENT" else 1e-3)(normal_map)


# The two renderers compare heights at other distances, so steep fine heights differ a little.
for inverted in (False, True):

    def bump(tree, inverted=inverted):
        height = node(tree, "TexNoise", {"Scale": 2.0, "Detail": 1.0})
        made = node(tree, "Bump", {"Height": out(height), "Distance": 0.3, "Strength": 0.8}, invert=inverted)
        return shown(tree, out(made))

    case(f"bump{', inverted' * inverted}", tolerance=1e-2)(bump)


@case("bump of an image by UV", tolerance=3e-2, edges=True)
def _(tree):
    height = node(tree, "TexImage", image=picture(space="Non-Color"), interpolation="Cubic")
    return shown(tree, out(node(tree, "Bump", {"Height": out(height), "Distance": 0.05})))


@case("bump on a normal map on a bump", tolerance=3e-2)
def _(tree):
    first = node(tree, "Bump", {"Height": out(node(tree, "TexWave", {"Scale": 0.5}), "Fac"), "Distance": 0.2})
    return shown(
        tree, out(node(tree, "Bump", {"Height": out(node(tree, "TexNoise", {"Scale": 1.0})), "Distance": 0.3, "Normal": out(first)}))
    )


# ---- Shaders that only emit ----


def emitting(build):
    """A material whose surface is what `build(tree)` gives: a shader socket."""
    material = bpy.data.materials.new("tested")
    tree, output = new_tree(material)
    tree.links.new(build(tree), output.inputs["Surface"])
    return material


def emission(tree, color, strength=1.0):
    return out(node(tree, "Emission", {"Color": color, "Strength": strength}))


def mix_of_mixes(tree):
    inner = node(
        tree,
        "MixShader",
        {"Fac": two_numbers(tree)[0], "Shader": emission(tree, (1, 0, 0, 1)), "Shader_001": emission(tree, coordinate(tree))},
    )
    outer = node(tree, "MixShader", {"Fac": 0.3, "Shader": out(inner), "Shader_001": emission(tree, (0, 0, 1, 1), 2.0)})
    return out(node(tree, "AddShader", {"Shader": out(outer), "Shader_001": out(inner)}))


def mix_with_an_empty_input(tree):
    return out(node(tree, "MixShader", {"Fac": 0.3, "Shader_001": emission(tree, coordinate(tree))}))


def principled_emission(tree):
    inputs = {"Base Color": (0, 0, 0, 1), "Specular IOR Level": 0.0, "Emission Color": coordinate(tree), "Emission Strength": 1.5}
    return out(node(tree, "BsdfPrincipled", inputs))


SHADERS = {f.__name__: f for f in (mix_of_mixes, mix_with_an_empty_input, principled_emission)}


@pytest.mark.parametrize("name", SHADERS)
def test_emission_of_mixed_shaders_is_what_cycles_shows(name):
    material = emitting(SHADERS[name])
    off, problems = difference(stage(material), material)
    assert not problems, problems
    assert off.max() <= 1e-3, f"the most they differ is {off.max():.3g}"


WORLDS = {
    "colour": lambda t: (0.2, 0.4, 0.9, 1),
    "generated": lambda t: coordinate(t, "Generated"),
    "object": lambda t: coordinate(t, "Object"),
    "normal": lambda t: coordinate(t, "Normal"),
    "reflection": lambda t: coordinate(t, "Reflection"),
    "incoming": lambda t: out(node(t, "NewGeometry"), "Incoming"),
    "equirectangular": lambda t: out(node(t, "TexEnvironment", image=picture(16, 8))),
    "turned": lambda t: out(
        node(
            t,
            "TexEnvironment",
            {"Vector": out(node(t, "Mapping", {"Vector": coordinate(t), "Rotation": (0.3, 0.2, 1.0)}))},
            image=picture(16, 8),
        )
    ),
    "mirror ball": lambda t: out(node(t, "TexEnvironment", image=picture(16, 8), projection="MIRROR_BALL")),
    "noise": lambda t: out(node(t, "TexNoise", {"Scale": 2.0}), "Color"),
    "camera": lambda t: coordinate(t, "Camera"),
    "window": lambda t: coordinate(t, "Window"),
}


@pytest.mark.parametrize("name", WORLDS)
def test_world_gives_what_it_gives_in_cycles(name):
    world = bpy.data.worlds.new("tested")
    tree, output = new_tree(world, "ShaderNodeOutputWorld")
    background = node(tree, "Background", {"Color": WORLDS[name](tree), "Strength": 0.8})
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    off, problems = world_difference(world)
    assert not problems, problems
    wrong = (off > 2e-3).mean()
    assert wrong <= 0.01, f"{wrong:.1%} of the pixels differ, the most by {off.max():.3g}"


@pytest.mark.parametrize("name", CASES)
def test_node_gives_what_it_gives_in_cycles(name):
    build, edges, tolerance = CASES[name]
    material = emission_material(build)
    off, problems = difference(stage(material), material)
    assert not problems, problems
    wrong = (off > tolerance).mean()
    allowed = 0.02 if edges else 0.0
    assert wrong <= allowed, f"{wrong:.1%} of the pixels differ by more than {tolerance}, the most by {off.max():.3g}"
