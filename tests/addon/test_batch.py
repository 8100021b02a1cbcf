# SPDX-License-Identifier: GPL-3.0-or-later
"""Animations and farms: passes merged from parts, seeds by frame, steady caustics, files that are there already."""

import layer_stage
import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


def ring_of_light(width=24, height=18, passes=2):
    """A glass ball in the sun over a white floor, whose caustic fills the picture's middle; the ball is above the camera's view."""
    scene = stage.scene(width, height, passes, samples=2)
    scene.opal.photons_per_pass = 40_000
    scene.opal.radius = 0.05
    stage.plane("Floor", size=10, material=stage.matte(color=(0.8, 0.8, 0.8)))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=0.5, location=(0, 0, 1.2))
    ball = bpy.context.object
    ball.data.polygons.foreach_set("use_smooth", [True] * len(ball.data.polygons))
    glass = layer_stage.body("Glass", "GEM")
    glass.opal.gem.species = "CUSTOM"
    glass.opal.gem.dispersion, glass.opal.gem.cauchy_b, glass.opal.gem.cauchy_c = "CAUCHY", 1.5, 0.0
    ball.data.materials.append(glass)
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy, sun.angle = 3.0, 0.01
    stage.link("Sun", sun)
    stage.camera((0, -3, 0.6), (1.38, 0, 0))
    return scene, ball


def test_the_merge_of_passes_1_to_8_and_9_to_16_is_the_render_of_1_to_16_to_the_bit(tmp_path):
    scene = layer_stage.build(width=24, height=18)
    scene.opal.samples_per_pass, scene.opal.photons_per_pass = 2, 4000
    scene.opal.use_film_file = True
    scene.opal.film_path = str(tmp_path / "film_####.npz")
    for first, passes in ((9, 8), (1, 8)):
        scene.opal.pass_first, scene.opal.passes = first, passes
        stage.render(tmp_path)
    assert sorted(path.name for path in tmp_path.glob("*.npz")) == ["film_0001_0001-0008.npz", "film_0001_0009-0016.npz"]
    merged_film = tmp_path / "merged.npz"
    assert bpy.ops.opal.merge(
        directory=str(tmp_path), pattern="film_0001_*.npz", output=str(tmp_path / "merged_####.exr"), film=str(merged_film)
    ) == {"FINISHED"}
    scene.opal.pass_first, scene.opal.passes, scene.opal.use_film_file = 1, 16, False
    whole = stage.render(tmp_path)
    np.testing.assert_array_equal(layer_stage.pixels("Opal Merged").astype(np.float32), whole)
    np.testing.assert_array_equal(stage.read_layers(tmp_path / "merged_0001.exr")["ViewLayer"]["Combined"], whole)
    from opal_kernels import film_sums

    assert sorted(film_sums.load(merged_film).passes) == list(range(16))


def test_films_of_different_pictures_are_refused(tmp_path):
    scene = layer_stage.build(passes=1, width=8, height=6)
    scene.opal.use_film_file = True
    for name, seed in (("a", 0), ("b", 1)):
        scene.opal.film_path, scene.opal.seed, scene.opal.pass_first = str(tmp_path / f"{name}.npz"), seed, seed + 1
        stage.render(tmp_path)
    with pytest.raises(RuntimeError, match="not of the same render: seed is 0 in one and 1"):
        bpy.ops.opal.merge(directory=str(tmp_path), pattern="*.npz")
    with pytest.raises(RuntimeError, match="no films to merge"):
        bpy.ops.opal.merge(directory=str(tmp_path), pattern="nothing_*.npz")
    (tmp_path / "c.npz").write_bytes(b"not a film")
    with pytest.raises(RuntimeError, match="is not a film"):
        bpy.ops.opal.merge(directory=str(tmp_path), pattern="c.npz")


def test_passes_that_are_missing_between_films_are_told(tmp_path, capfd):
    scene = layer_stage.build(passes=1, width=8, height=6)
    scene.opal.use_film_file, scene.opal.film_path, scene.opal.photons_per_pass = True, str(tmp_path / "film.npz"), 0
    for first, passes in ((1, 1), (3, 1), (7, 2)):
        scene.opal.pass_first, scene.opal.passes = first, passes
        stage.render(tmp_path)
    capfd.readouterr()
    assert bpy.ops.opal.merge(directory=str(tmp_path), pattern="film_*.npz") == {"FINISHED"}
    said = capfd.readouterr().out
    assert "leave out passes 2, 4–6" in said, said


def test_a_film_that_cannot_be_written_is_a_sentence_and_the_picture_stands(tmp_path):
    scene = layer_stage.build(passes=1, width=8, height=6)
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    scene.opal.use_film_file, scene.opal.film_path = True, str(blocked / "film.npz")
    assert stage.render(tmp_path)[..., :3].mean() > 0
    assert any("cannot be written" in entry for entry in stage.problems()), stage.problems()


def test_seeds_stand_still_or_vary_by_frame_as_chosen(tmp_path):
    scene = layer_stage.build(passes=1, width=16, height=12)

    def frames():
        pictures = []
        for frame in (1, 2):
            scene.frame_set(frame)
            pictures.append(stage.render(tmp_path))
        return pictures

    still = frames()
    np.testing.assert_array_equal(*still)
    scene.opal.seed_per_frame = True
    varied = frames()
    assert (varied[0] != varied[1]).mean() > 0.5
    np.testing.assert_array_equal(varied, frames())


def test_a_turntables_caustic_does_not_flicker_beyond_its_noise(tmp_path):
    """Ten frames of a ball that turns about its own axis are the same picture: the caustic's light varies between frames by what
    its own noise between passes lets expect, with seeds that vary; with a fixed seed no more than that."""
    scene, ball = ring_of_light()
    bpy.context.view_layer.opal.use_pass_caustics = True
    for frame, turn in ((1, 0.0), (10, 2 * np.pi * 9 / 10)):
        ball.rotation_euler.z = turn
        ball.keyframe_insert("rotation_euler", frame=frame)
    scene.frame_start, scene.frame_end = 1, 10

    def light(vary):
        scene.opal.seed_per_frame = vary
        sums = []
        for frame in range(1, 11):
            scene.frame_set(frame)
            sums.append(stage.render_passes(tmp_path)["Caustics"].mean(axis=2))
        return np.array(sums)

    varied, fixed = light(True), light(False)
    assert varied.mean() > 0.01
    totals = varied.mean(axis=(1, 2))
    # 10 frames of 2 passes of 40,000 photons, a few thousand of which are seen: below 3 % of the whole.
    assert totals.std() < 0.03 * totals.mean(), totals
    assert fixed.mean(axis=(1, 2)).std() < 0.03 * fixed.mean()
    bright = varied.mean(axis=0) > 0.3 * varied.mean(axis=0).max()
    assert fixed.std(axis=0)[bright].mean() <= 1.1 * varied.std(axis=0)[bright].mean()


def test_frames_that_are_there_are_kept_and_placeholders_are_made(tmp_path):
    scene = stage.scene(width=8, height=8, passes=1, samples=1)
    stage.camera()
    stage.world()
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.filepath = str(tmp_path / "frame_")
    image_settings = scene.render.image_settings
    if hasattr(image_settings, "media_type"):
        image_settings.media_type = "IMAGE"
    image_settings.file_format = "PNG"
    scene.render.use_overwrite, scene.render.use_placeholder = False, True
    (tmp_path / "frame_0002.png").write_bytes(b"mine")
    bpy.ops.render.render(animation=True)
    assert sorted(path.name for path in tmp_path.glob("*.png")) == [f"frame_{i:04d}.png" for i in (1, 2, 3)]
    assert (tmp_path / "frame_0002.png").read_bytes() == b"mine"
    assert all((tmp_path / f"frame_{i:04d}.png").stat().st_size > 50 for i in (1, 3))


def test_a_layers_file_that_is_there_is_kept_where_overwriting_is_off(tmp_path):
    scene = layer_stage.build(passes=1, width=8, height=6)
    scene.render.use_overwrite = False
    path = tmp_path / "layers.exr"
    path.write_bytes(b"mine")
    assert bpy.ops.opal.render_layers(use_file=True, filepath=str(path)) == {"FINISHED"}
    assert path.read_bytes() == b"mine"
