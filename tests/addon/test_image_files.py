# SPDX-License-Identifier: GPL-3.0-or-later
"""Tiles of UDIM images and frames of sequences are read from their files: they have to hold what Blender holds of a plain image."""

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


def shown_by(image, **user):
    """The colour in the middle of a card that glows with an image."""
    material = stage.glowing()
    texture = material.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    for key, value in user.items():
        setattr(texture.image_user, key, value)
    emission = next(node for node in material.node_tree.nodes if node.type == "EMISSION")
    material.node_tree.links.new(texture.outputs["Color"], emission.inputs["Color"])
    stage.plane(size=20, material=material)
    return texture.image_user


def test_a_sequence_shows_the_frame_that_its_user_says(tmp_path):
    """It was magenta where no window had shown it. The numbers are of Cycles, seen at each of these frames."""
    scene = stage.scene(samples=64)
    stage.camera((0, 0, 5))
    for number in range(3):
        image = bpy.data.images.new("frame", 2, 2)
        image.pixels.foreach_set(np.tile(np.float32([*np.eye(3)[number], 1]), 4))
        image.filepath_raw, image.file_format = str(tmp_path / f"v2_take_{number + 1:03d}.png"), "PNG"
        image.save()
    image = bpy.data.images.load(str(tmp_path / "v2_take_001.png"))
    image.source = "SEQUENCE"
    user = shown_by(image, frame_duration=3)
    frame_shown = stage.addon("nodes.images").frame_shown
    for (cyclic, offset, start), expected in {
        (False, 0, 1): (1, 2, 3, 3, 0),
        (True, 0, 2): (3, 1, 2, 1, 3),
        (False, 1, 0): (3, 4, 4, 4, 1),
        (True, -1, 3): (1, 2, 0, 2, 1),
    }.items():
        user.use_cyclic, user.frame_offset, user.frame_start = cyclic, offset, start
        assert tuple(frame_shown(user, frame) for frame in (1, 2, 3, 5, -2)) == expected, (cyclic, offset, start)
    user.use_cyclic, user.frame_offset, user.frame_start = False, 0, 1
    for frame, channel in ((1, 0), (2, 1), (3, 2)):
        scene.frame_set(frame)
        color = stage.render(tmp_path)[..., :3].mean(axis=(0, 1))
        assert color == pytest.approx(np.eye(3)[channel], abs=0.05), frame
    assert not stage.problems()


def test_tiles_that_were_painted_and_not_saved_are_named(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    image = bpy.data.images.new("Painted", 4, 4, tiled=True)
    image.pixels.foreach_set(np.ones(64, np.float32))
    shown_by(image)
    stage.render(tmp_path)
    assert any(entry.startswith("Painted: Tiles that were painted") for entry in stage.problems()), stage.problems()
