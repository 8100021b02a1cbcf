# SPDX-License-Identifier: GPL-3.0-or-later
"""Tiles of UDIM images are read from their files: they have to hold what Blender holds of the same file as a plain image."""

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")

_SPACES = ("sRGB", "Non-Color", "Linear Rec.709", "ACEScg")


def written(path, depth):
    """A picture of which every pixel has another colour and alpha, as a file that holds alpha apart."""
    bpy.utils.expose_bundled_modules()
    import OpenImageIO as oiio

    pixels = np.random.default_rng(5).random((4, 5, 4)).astype(np.float32)
    pixels[..., 3] = np.maximum(pixels[..., 3], 0.3)
    spec = oiio.ImageSpec(5, 4, 4, depth)
    spec.attribute("oiio:UnassociatedAlpha", 1)
    file = oiio.ImageOutput.create(str(path))
    assert file.open(str(path), spec), file.geterror()
    assert file.write_image(pixels), file.geterror()
    file.close()


def loaded(path, alpha_mode, space):
    image = bpy.data.images.load(str(path))
    image.alpha_mode, image.colorspace_settings.name = alpha_mode, space
    return image


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("depth, suffix", [("uint8", "png"), ("uint16", "png"), ("uint8", "tif"), ("uint16", "tif"), ("float", "exr")])
def test_a_tile_holds_what_blender_holds_of_its_file(depth, suffix, packed, tmp_path):
    """Alpha was multiplied in twice in 8 bits, and 16 bits of sRGB were taken as linear."""
    images = stage.addon("nodes.images")
    path = tmp_path / f"tile.1001.{suffix}"
    written(path, depth)
    for space in _SPACES:
        for alpha_mode in ("STRAIGHT", "PREMUL", "CHANNEL_PACKED"):
            plain, tiled = (loaded(path, alpha_mode, space) for _ in range(2))
            tiled.source = "TILED"
            tiled.filepath_raw = str(tmp_path / f"tile.<UDIM>.{suffix}")
            if packed:
                tiled.pack()
            expected, found = images.loaded_pixels(plain), images.tile_pixels(tiled, 0, 1001)
            assert found.dtype == expected.dtype and found.shape == expected.shape, (space, alpha_mode)
            step = 1 if found.dtype == np.uint8 else 2e-3
            worst = np.abs(found.astype(float) - expected).max()
            assert worst <= step, f"{space}, {alpha_mode}: {worst:g} apart, {step} allowed"
            bpy.data.images.remove(plain)
            bpy.data.images.remove(tiled)


def test_tiles_that_were_painted_and_not_saved_are_named(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    material = stage.glowing()
    texture = material.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = bpy.data.images.new("Painted", 4, 4, tiled=True)
    texture.image.pixels.foreach_set(np.ones(64, np.float32))
    emission = next(node for node in material.node_tree.nodes if node.type == "EMISSION")
    material.node_tree.links.new(texture.outputs["Color"], emission.inputs["Color"])
    stage.plane(material=material)
    stage.render(tmp_path)
    assert any(entry.startswith("Painted: Tiles that were painted") for entry in stage.problems()), stage.problems()
