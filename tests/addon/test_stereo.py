# SPDX-License-Identifier: GPL-3.0-or-later
"""Views of a stereo or multi-view render: each eye sees what Cycles shows it, in a picture and files of its own."""

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


@pytest.fixture
def scene():
    """Two cards that glow, one behind the other, before a stereo camera."""
    scene = stage.scene(width=32, height=24, passes=2, samples=16)
    stage.camera((0, 0, 5), lens=35, shift_x=0.05)
    stage.plane("Near", size=0.8, location=(0.2, 0, 2.5), material=stage.glowing("Red", (1, 0.2, 0.1)))
    stage.plane("Far", size=5, location=(0.5, 0.3, -3), material=stage.glowing("Blue", (0.1, 0.3, 1)))
    scene.render.use_multiview = True
    yield scene
    scene.render.use_multiview = False


def eyes(engine, folder):
    """The pictures of the left and the right eye, by their suffix."""
    scene = bpy.context.scene
    scene.render.engine = engine
    if engine == "CYCLES":
        scene.cycles.samples, scene.cycles.use_adaptive_sampling, scene.cycles.use_denoising = 64, False, False
    image_settings = scene.render.image_settings
    if hasattr(image_settings, "media_type"):
        image_settings.media_type = "IMAGE"
    # Radiance files are linear too, and know of no views: Blender 4.5 takes an OpenEXR file of one view for one of many layers.
    image_settings.file_format, image_settings.views_format = "HDR", "INDIVIDUAL"
    scene.render.filepath = str(folder / f"{engine}.hdr")
    bpy.ops.render.render(write_still=True)
    found = []
    for suffix in ("_L", "_R"):
        image = bpy.data.images.load(str(folder / f"{engine}{suffix}.hdr"))
        found.append(np.array(image.pixels, np.float32).reshape(24, 32, 4)[..., :3])
    return found


@pytest.mark.parametrize("mode", ["OFFAXIS", "PARALLEL", "TOE"])
def test_each_eye_sees_what_cycles_shows_it(mode, scene, tmp_path):
    stereo = scene.camera.data.stereo
    stereo.convergence_mode, stereo.interocular_distance, stereo.convergence_distance = mode, 0.6, 4.0
    ours, theirs = eyes("OPAL", tmp_path), eyes("CYCLES", tmp_path)
    assert np.abs(ours[0] - ours[1]).mean() > 0.05, "the eyes see different pictures"
    for eye, other in zip(ours, theirs, strict=True):
        difference = np.abs(eye - other).mean()
        assert difference < 0.01, f"mean difference {difference:.4f}"
    assert not stage.problems()


def test_a_moving_camera_and_its_eyes_are_blurred_as_by_cycles(scene, tmp_path):
    scene.camera.data.stereo.interocular_distance = 0.6
    for frame, x in ((0, -0.5), (2, 0.5)):
        scene.camera.location.x = x
        scene.camera.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter, scene.render.motion_blur_position = True, 1.0, "START"
    for eye, other in zip(eyes("OPAL", tmp_path), eyes("CYCLES", tmp_path), strict=True):
        difference = np.abs(eye - other).mean()
        assert difference < 0.015, f"mean difference {difference:.4f}"


def test_views_of_cameras_of_their_own_and_their_files(scene, tmp_path):
    """Multi-View finds each view's camera by its suffix; it has a lens of its own."""
    left = scene.camera
    left.name = "Cam_L"
    right = stage.camera((0.8, 0, 5), (0, 0.15, 0), lens=60)
    right.name = "Cam_R"
    scene.camera = left
    scene.render.views_format = "MULTIVIEW"
    scene.opal.use_spectral_output, scene.opal.spectral_path, scene.opal.spectral_bins = True, str(tmp_path / "s.exr"), 4
    scene.opal.use_film_file, scene.opal.film_path = True, str(tmp_path / "film.npz")
    ours, theirs = eyes("OPAL", tmp_path), eyes("CYCLES", tmp_path)
    for eye, other in zip(ours, theirs, strict=True):
        difference = np.abs(eye - other).mean()
        assert difference < 0.01, f"mean difference {difference:.4f}"
    names = {path.name for path in tmp_path.iterdir()}
    assert {"s_L.exr", "s_R.exr", "film_L_0001-0002.npz", "film_R_0001-0002.npz"} <= names, names
