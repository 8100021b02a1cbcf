# SPDX-License-Identifier: GPL-3.0-or-later
"""The binding refuses at the door, hands over what it takes, and turns each failure into one sentence."""

import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from opal_kernels import binding, libraries, programs
from opal_kernels.binding import OpalError
from opal_kernels.descriptions import Carry, Light, LightType, MaterialFlag, Pass, World
from opal_kernels.render import Render
from opal_kernels.scene import Scene

SQUARE = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], np.float32)
HALVES = np.array([(0, 1, 2), (0, 2, 3)], np.int32)
ABOVE = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 5]]  # a camera at z = 5 that looks down


def embree_is_here():
    try:
        Scene().close()
    except OpalError:
        return False
    return True


needs_embree = pytest.mark.skipif(not embree_is_here(), reason="no Embree 4: neither in this process nor in an installed bpy")


@pytest.fixture
def scene():
    with Scene() as made:
        yield made


def floor(scene, size=10.0, program=None):
    mesh = scene.add_mesh(SQUARE * size, HALVES)
    material = scene.add_material(program or programs.diffuse((0.5, 0.5, 0.5)))
    scene.add_instances(mesh, [np.eye(4)], [material])


def test_importing_the_package_takes_under_100_ms_and_opens_no_library():
    code = (
        "import sys, time; t = time.perf_counter(); import opal_kernels; "
        "print(time.perf_counter() - t, 'numpy' in sys.modules, 'opal_kernels.binding' in sys.modules)"
    )
    seconds, *loaded = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.split()
    assert float(seconds) < 0.1
    assert loaded == ["False", "False"]


def test_the_library_speaks_this_version_of_the_interface():
    assert binding.library().opal_api_version() == binding.API_VERSION
    assert binding.cpu_level() in (0, 2, 3)


def test_a_missing_library_is_named(monkeypatch, tmp_path):
    monkeypatch.setenv(libraries.OPAL_DIRECTORY_VARIABLE, str(tmp_path))
    monkeypatch.setattr(sys.modules["opal_kernels.binding.library"], "_library", None)
    with pytest.raises(OpalError, match=str(tmp_path)):
        binding.library()


def test_a_missing_embree_is_named_with_the_place_looked_at():
    with pytest.raises(OpalError, match="/nowhere/libembree4.so.4"):
        Scene(embree="/nowhere/libembree4.so.4")


@pytest.mark.parametrize(
    "values, dtype, shape, sentence",
    [
        (np.zeros((3, 2)), np.float32, (None, 3), "shape 3 x 2"),
        ([[1, 2, np.nan]], np.float32, (None, 3), "not finite"),
        ([[0.5, 1, 2]], np.int32, (None, 3), "float64"),
        (1.0, np.float32, (None,), "of one value"),
        (["a"], np.float32, (None,), "expected"),
    ],
)
def test_arrays_are_refused_by_name_with_what_was_expected(values, dtype, shape, sentence):
    with pytest.raises(OpalError, match=f"corners.*{sentence}"):
        binding.as_array("corners", values, dtype, shape)


def test_arrays_of_the_right_kind_are_not_copied():
    values = np.zeros((5, 3), np.float32)
    assert binding.as_array("values", values, np.float32, (None, 3)) is values
    turned = np.zeros((3, 5), np.float32).T
    assert binding.as_array("values", turned, np.float32, (5, 3)).flags["C_CONTIGUOUS"]


@needs_embree
def test_rays_hit_what_was_put_in(scene):
    floor(scene, size=1.0)
    scene.commit()
    origins = np.array([(0.5, -0.5, 3), (0, 0, -2), (5, 5, 5)], np.float32)
    directions = np.array([(0, 0, -1), (0, 0, 1), (0, 0, -1)], np.float32)
    hits = scene.intersect(origins, directions)
    np.testing.assert_allclose(hits["distance"], (3, 2, np.inf))
    np.testing.assert_array_equal(hits["instance"], (0, 0, -1))
    u, v = hits["barycentrics"][0]
    corners = SQUARE[HALVES[hits["triangle"][0]]]
    np.testing.assert_allclose((1 - u - v) * corners[0] + u * corners[1] + v * corners[2], (0.5, -0.5, 0), atol=1e-6)


@needs_embree
def test_triangles_with_corners_that_are_not_numbers_are_dropped_and_counted(scene):
    broken = SQUARE.copy()
    broken[3, 0] = np.nan
    _, dropped = binding.scene_add_mesh(scene.handle, broken, HALVES)
    assert dropped == 1


@needs_embree
def test_failures_of_the_kernels_are_sentences(scene):
    mesh = scene.add_mesh(SQUARE, HALVES)
    with pytest.raises(OpalError, match="material"):
        scene.add_instances(mesh, [np.eye(4)], [7])
    with pytest.raises(OpalError, match="mesh"):
        scene.add_instances(7, [np.eye(4)])
    with pytest.raises(OpalError, match="not committed"):
        Render(scene)
    scene.commit()
    with pytest.raises(OpalError, match="camera"):
        Render(scene)
    with pytest.raises(OpalError, match="vertex"):
        scene.add_mesh(SQUARE, HALVES + 2)


@needs_embree
def test_a_closed_scene_says_so(scene):
    scene.close()
    scene.close()
    with pytest.raises(OpalError, match="closed"):
        scene.commit()


@needs_embree
def test_a_uniform_world_over_a_grey_floor_gives_half_its_radiance(scene):
    floor(scene)
    scene.set_world(World(programs.emission()))
    scene.set_camera(transform=ABOVE)
    scene.commit()
    settings = {"width": 16, "height": 16, "samples_per_pass": 16, "photons_carry": Carry.NONE, "passes": (Pass.DEPTH,)}
    with Render(scene, **settings) as render:
        picture = render.run(16).film()
        assert picture.shape == (16, 16, 4) and render.passes_done == 16
        np.testing.assert_allclose(picture[..., :3].mean((0, 1)), 0.5, rtol=0.01)
        np.testing.assert_allclose(render.film("DEPTH").min(), 5, rtol=0.01)
        assert 0 < render.noise < 0.5
        assert render.statistics["camera_rays"] >= 16 * 16 * 256


@needs_embree
@pytest.mark.parametrize("materials", [(), (-1,)])
def test_faces_without_a_material_are_a_matte_grey(scene, materials):
    scene.add_material(programs.diffuse((0.0, 0.0, 0.0)))
    scene.add_instances(scene.add_mesh(SQUARE * 10, HALVES), [np.eye(4)], materials)
    scene.set_world(World(programs.emission()))
    scene.set_camera(transform=ABOVE)
    scene.commit()
    with Render(scene, width=8, height=8, samples_per_pass=64, photons_per_pass=0) as render:
        np.testing.assert_allclose(render.run(4).film()[..., :3].mean((0, 1)), 0.8, rtol=0.01)


@needs_embree
def test_a_black_world_and_no_lamp_is_black_and_a_lamp_lights(scene):
    floor(scene)
    scene.set_world(None)
    scene.set_camera(transform=ABOVE)
    scene.commit()
    settings = {"width": 8, "height": 8, "samples_per_pass": 4, "photons_carry": Carry.NONE}
    with Render(scene, **settings) as render:
        assert not render.run(1).film()[..., :3].any()
    scene.add_light(Light(type=LightType.SUN, power=np.pi))
    scene.commit()
    with Render(scene, **settings) as render:
        np.testing.assert_allclose(render.run(8).film()[..., :3].mean(), 0.5, rtol=0.02)


@needs_embree
def test_passes_add_up_in_any_order_to_the_same_bits(scene):
    floor(scene, program=programs.mirror((0.8, 0.6, 0.4), 0.3))
    scene.set_world(World(programs.emission((1.0, 0.5, 0.25))))
    scene.set_camera(transform=ABOVE)
    scene.commit()
    films = []
    for order in ((0, 1, 2), (2, 0, 1)):
        with Render(scene, width=8, height=8, photons_per_pass=0) as render:
            for number in order:
                render.run_pass(number)
            films.append(render.film())
    np.testing.assert_array_equal(films[0], films[1])


@needs_embree
def test_cancelling_from_another_thread_ends_a_pass_and_leaves_whole_passes(scene):
    floor(scene, program=programs.diffuse((0.9, 0.9, 0.9)))
    scene.set_world(World(programs.emission()))
    scene.set_camera(transform=ABOVE)
    scene.commit()
    with Render(scene, width=512, height=512, samples_per_pass=256, photons_per_pass=0) as render:
        timer = threading.Timer(0.3, render.cancel)
        timer.start()
        begun = time.perf_counter()
        with pytest.raises(binding.Cancelled):
            render.run_pass(0)
        assert time.perf_counter() - begun < 2
        assert render.passes_done == 0 and not render.film()[..., :3].any()


@needs_embree
def test_a_commit_that_was_cancelled_refuses_to_render_and_the_next_builds_the_rest(scene):
    floor(scene)
    scene.set_world(World(programs.emission()))
    scene.set_camera(transform=ABOVE)
    scene.cancel()
    with pytest.raises(binding.Cancelled):
        scene.commit()
    with pytest.raises(OpalError, match="not committed"):
        Render(scene)
    scene.commit()
    with Render(scene, width=8, height=8, samples_per_pass=64, photons_per_pass=0) as render:
        np.testing.assert_allclose(render.run(4).film()[..., :3].mean(), 0.5, rtol=0.01)


@needs_embree
def test_a_running_commit_ends_when_it_is_told_to():
    """In the midst of Embree's building: it takes a small part of the time that it would have taken."""
    edge = 700
    x, y = np.meshgrid(np.arange(edge, dtype=np.float32), np.arange(edge, dtype=np.float32))
    positions = np.stack((x, y, np.sin(x) * np.cos(y)), axis=2).reshape(-1, 3)
    corner = (np.arange(edge - 1)[:, None] * edge + np.arange(edge - 1)).reshape(-1, 1)
    triangles = np.concatenate((corner + (0, 1, edge), corner + (1, edge + 1, edge))).astype(np.int32)

    def seconds(cancel_after=None):
        """Of the clock and of the processor."""
        with Scene(threads=1) as scene:
            scene.add_instances(scene.add_mesh(positions, triangles), [np.eye(4)])
            begun = time.perf_counter(), time.process_time()
            if cancel_after is None:
                scene.commit()
            else:
                timer = threading.Timer(cancel_after, scene.cancel)
                timer.start()
                with pytest.raises(binding.Cancelled):
                    scene.commit()
                timer.cancel()
            return time.perf_counter() - begun[0], time.process_time() - begun[1]

    whole, work = seconds()
    _, work_done = seconds(0.15 * whole)
    assert work_done < 0.6 * work, f"{work_done:.2f} s of work were done, {work:.2f} s are to be done in all"


def test_denoising_ends_when_it_is_told_to():
    from opal_kernels import denoise

    if reason := denoise.unavailable():
        pytest.skip(reason)
    noisy = np.random.default_rng(1).random((64, 96, 3), np.float32)
    guides = np.full_like(noisy, 0.5), np.zeros_like(noisy)
    asked = []
    with pytest.raises(binding.Cancelled):
        denoise.denoise(noisy, *guides, wants_stop=lambda: asked.append(True) or len(asked) > 2)
    assert 2 < len(asked) < 50
    clean = denoise.denoise(noisy, *guides, wants_stop=lambda: False)
    np.testing.assert_array_equal(clean, denoise.denoise(noisy, *guides))
    assert clean.std() < 0.5 * noisy.std()


def test_a_wall_seen_through_smoke_is_denoised_although_its_guides_have_the_same_noise():
    """The same paths meet wall or smoke in the picture and in its guides, whose noise must not pass for a pattern of the wall."""
    from opal_kernels import denoise

    if reason := denoise.unavailable():
        pytest.skip(reason)
    met = np.random.default_rng(7).binomial(32, 0.5, (128, 128, 1)).astype(np.float32) / 32
    noisy = met * np.float32(0.4) + (1 - met) * np.float32([0.5, 0.1, 0.02])
    clean = denoise.denoise(noisy, met * np.full(3, 0.4, np.float32), met * np.float32([0.0, 0.0, 1.0]))
    assert clean.mean() == pytest.approx(noisy.mean(), rel=0.02)
    left = np.sqrt(clean.var(axis=(0, 1)).sum() / noisy.var(axis=(0, 1)).sum())
    assert left < 0.2, f"{left:.2f} of the noise is left"


@needs_embree
def test_emissive_faces_light_the_floor(scene):
    floor(scene)
    lamp = scene.add_mesh(SQUARE * 0.5, HALVES)
    glow = scene.add_material(programs.emission(strength=8.0), flags=MaterialFlag.EMISSIVE)
    scene.add_instances(lamp, [np.array([[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 2], [0, 0, 0, 1]])], [glow])
    scene.set_camera(transform=ABOVE)
    scene.commit()
    assert scene.statistics["emissive_triangles"] == 2
    with Render(scene, width=8, height=8, samples_per_pass=16, photons_per_pass=0) as render:
        assert render.run(2).film()[..., :3].mean() > 0.01
