# SPDX-License-Identifier: GPL-3.0-or-later
"""Layers for compositing: they add up to the picture, and each holds the light that its name says."""

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.descriptions import Light, LightType, MaterialFlag, MediumLayer, Pass, World
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box, looking_down, perspective, placed, sphere, square

LAYERS = (Pass.LAYER_BASE, Pass.LAYER_CAUSTICS, Pass.LAYER_GEMS, Pass.LAYER_MEDIA, Pass.LAYER_RAINBOW)
KEPT = (*LAYERS, Pass.LAYER_BEHIND, Pass.LAYER_DIMMED)
SIZE = 24


def films(build, passes=4, **settings):
    """Every layer and Combined, float64, of a scene over a floor at 0 with a lamp, seen from 6 m above."""
    with Scene(threads=2) as scene:
        floor = scene.add_material(programs.diffuse((0.8, 0.5, 0.3)))
        scene.add_instances(scene.add_mesh(*square(6.0)), IDENTITY, [floor])
        scene.add_light(Light(type=LightType.POINT, transform=placed(3, 0, 4)[:3], power=400.0, radius=0.1))
        scene.set_world(World(programs.emission(strength=0.2)))
        build(scene)
        scene.set_camera(**perspective(0.6, looking_down(6.0)))
        scene.commit()
        with Render(scene, width=SIZE, height=SIZE, samples_per_pass=8, photons_per_pass=20_000, passes=KEPT, **settings) as render:
            render.run(passes)
            return {p: render.film(p).astype(np.float64) for p in (Pass.COMBINED, *KEPT)}


def add_gem(scene):
    corners, faces, normals = sphere(0.5)
    stone = scene.add_gem(np.full(471, 1.5))
    scene.add_instances(scene.add_mesh(corners, faces, corner_normals=normals), [placed(z=0.8)], [stone])


def add_fog(scene, rainbow=False, extinction=0.4, albedo=0.8):
    fog = scene.add_medium(extinction, albedo)
    scene.set_medium_layer(fog, MediumLayer.RAINBOW if rainbow else MediumLayer.MEDIA)
    body = scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=fog)
    scene.add_instances(scene.add_mesh(*box((-3, -3, 1.0), (3, 3, 2.0))), IDENTITY, [body])


def add_everything(scene):
    add_gem(scene)
    add_fog(scene)
    add_fog(scene, rainbow=True, extinction=0.1)


@pytest.mark.parametrize("transparent", [False, True], ids=["opaque", "transparent"])
def test_layers_add_up_to_the_picture_with_its_alpha(transparent):
    got = films(add_everything, transparent_film=transparent)
    total = sum(got[p] for p in LAYERS)
    np.testing.assert_allclose(total, got[Pass.COMBINED], rtol=2e-5, atol=2e-5)
    for layer in (Pass.LAYER_GEMS, Pass.LAYER_MEDIA, Pass.LAYER_RAINBOW):
        assert got[layer][..., :3].sum() > 0, layer.name


def test_without_gems_and_media_there_is_only_the_base():
    got = films(lambda scene: None)
    np.testing.assert_array_equal(got[Pass.LAYER_BASE], got[Pass.COMBINED])
    np.testing.assert_array_equal(got[Pass.LAYER_BEHIND], got[Pass.COMBINED])
    np.testing.assert_array_equal(got[Pass.LAYER_DIMMED], got[Pass.COMBINED])


def test_the_base_under_a_gem_is_black_and_its_caustic_is_added_light():
    got = films(add_gem, passes=8)
    center = SIZE // 2
    assert got[Pass.LAYER_GEMS][center, center, 3] == 1
    assert not got[Pass.LAYER_BASE][center, center].any()
    caustics = got[Pass.LAYER_CAUSTICS][..., 1]
    assert caustics.max() > 0.2 * got[Pass.LAYER_BASE][..., 1].max(), "a glass ball's focus beside its shadow"


@pytest.mark.parametrize("rainbow", [False, True], ids=["medium", "rainbow"])
def test_a_medium_dims_what_lies_behind_by_beer_and_lambert(rainbow):
    """The quotient of the two bases is exp(-0.4 x 1 m / cos) without noise, because both come from the same paths."""
    got = films(lambda scene: add_fog(scene, rainbow))
    y, x = SIZE // 2, SIZE // 2
    ratio = got[Pass.LAYER_DIMMED][y, x] / got[Pass.LAYER_BEHIND][y, x]
    np.testing.assert_allclose(ratio, np.exp(-0.4), rtol=2e-3)
    thick = films(lambda scene: add_fog(scene, rainbow, extinction=9.0))
    ratio = thick[Pass.LAYER_DIMMED][y, x] / thick[Pass.LAYER_BEHIND][y, x]
    np.testing.assert_allclose(ratio, np.exp(-9.0), rtol=5e-3, err_msg="where hardly a path comes through by itself")
    own, other = (Pass.LAYER_RAINBOW, Pass.LAYER_MEDIA) if rainbow else (Pass.LAYER_MEDIA, Pass.LAYER_RAINBOW)
    assert got[own][..., :3].min() > 0 and not got[other].any()


def test_the_base_and_its_clear_paths_are_the_same_light():
    """Dimmed, of paths that fog does not stop, is what Base counts of those that it happens to let pass."""
    got = films(add_everything, passes=16)
    base, dimmed = got[Pass.LAYER_BASE].mean((0, 1)), got[Pass.LAYER_DIMMED].mean((0, 1))
    np.testing.assert_allclose(dimmed, base, rtol=0.03)
    assert (got[Pass.LAYER_BEHIND].mean((0, 1)) > 1.2 * base).all()


def test_after_a_diffuse_bounce_glossy_light_is_added_light():
    """The floor sees a mirror that the camera does not: what the mirror sends there is a caustic, and the base is as if the mirror were black."""

    def beside_a_mirror(color):
        def build(scene):
            mirror = scene.add_material(programs.mirror(color, roughness=0.4))
            corners = [(-2.2, -1.5, 0), (-2.2, 1.5, 0), (-2.2, 1.5, 2), (-2.2, -1.5, 2)]
            scene.add_instances(scene.add_mesh(corners, [(0, 1, 2), (0, 2, 3)]), IDENTITY, [mirror])

        return build

    bright, black = films(beside_a_mirror((1, 1, 1)), passes=16), films(beside_a_mirror((0, 0, 0)), passes=16)
    assert bright[Pass.LAYER_CAUSTICS][..., :3].mean() > 10 * black[Pass.LAYER_CAUSTICS][..., :3].mean()
    base, reference = bright[Pass.LAYER_BASE][..., :3].mean(), black[Pass.LAYER_BASE][..., :3].mean()
    assert base == pytest.approx(reference, rel=0.01)
