# SPDX-License-Identifier: GPL-3.0-or-later
"""Light through gems beside closed forms (PHYSICS §5.1 and 5.2): furnaces, Beer and Lambert, plates, and white that stays white."""

import functools
import math

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.cuts import round_brilliant
from opal_kernels.descriptions import Light, LightType, MaterialFlag, World, wavelengths
from opal_kernels.optics import colour, species
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box, looking_down, orthographic, picture, sphere, square

DEEP = {"max_depth": 1024, "photons_per_pass": 0}


def brilliant(scene, index):
    solid = round_brilliant().scaled(1.0).solid
    faces = [(f[0], f[i], f[i + 1]) for f in solid.faces for i in range(1, len(f) - 1)]
    scene.add_instances(scene.add_mesh(solid.vertices, faces), IDENTITY, [scene.add_gem(index)])
    scene.set_world(World(programs.emission()))
    scene.set_camera(**orthographic(0.55, looking_down(2.0)))
    scene.commit()


@pytest.mark.parametrize("index", [1.333, 1.5, 2.417])
def test_lossless_gem_vanishes_in_a_white_furnace(index):
    """Every pixel is 1: reflected, refracted and totally reflected light adds up, whatever the chain of facets."""
    with Scene(threads=2) as scene:
        brilliant(scene, index)
        image = picture(scene, 16, samples_per_pass=16, **DEEP)
    assert image == pytest.approx(1.0, abs=0.005), f"pixels from {image.min():.4f} to {image.max():.4f}"


def cube_of_a_balls_normals():
    corners, faces = box((-1, -1, -1), (1, 1, 1))
    return np.array(corners), faces, (np.array(corners) / math.sqrt(3))[np.array(faces)]


COARSE = {"ball of 60 faces": sphere(1.0, 6, 12), "cube": cube_of_a_balls_normals()}


@pytest.mark.parametrize("index", [1.5, 2.417])
@pytest.mark.parametrize("name", COARSE)
def test_coarse_smooth_gems_trap_no_light(name, index):
    """Interpolated normals that stand up to 55° off their faces lead some light round and round inside; it has to come out again."""
    corners, faces, normals = COARSE[name]
    tilted = np.array(
        [[1, 0, 0, 0], [0, math.cos(0.4), -math.sin(0.4), -3 * math.sin(0.4)], [0, math.sin(0.4), math.cos(0.4), 3 * math.cos(0.4)]]
    )
    with Scene(threads=2) as scene:
        scene.add_instances(scene.add_mesh(corners, faces, corner_normals=normals), IDENTITY, [scene.add_gem(index)])
        scene.set_world(World(programs.emission()))
        scene.set_camera(**orthographic(1.2, tilted))
        scene.commit()
        image = picture(scene, 8, size=24, samples_per_pass=16, **DEEP)
    assert image.mean() == pytest.approx(1.0, abs=0.001)
    assert image == pytest.approx(1.0, abs=0.02), f"pixels from {image.min():.4f} to {image.max():.4f}"


def test_diamond_vanishes_in_a_white_furnace():
    """With its dispersion: paths part by colour, so pixels are noisy, and the mean is white within 4 standard errors and 0.5 %."""
    with Scene(threads=2) as scene:
        brilliant(scene, species.index("DIAMOND", wavelengths()))
        image = picture(scene, 16, size=24, samples_per_pass=32, **DEEP)
    mean, error = image.mean(axis=(0, 1)), image.std(axis=(0, 1)) / 24
    assert error.max() < 0.002, f"too noisy to tell: {error}"
    assert mean == pytest.approx(1.0, abs=0.005), f"{mean} ± {error}"


# σd and the transmittance of a plate at normal incidence, with all interreflections (PHYSICS §5.2).
PLATES = [
    (1.0, 0.5, 0.606531),
    (1.0, 1.0, 0.367879),
    (1.0, 2.0, 0.135335),
    (1.5, 0.0, 0.923077),
    (1.5, 0.5, 0.559308),
    (1.5, 1.0, 0.339111),
    (1.5, 2.0, 0.124729),
    (2.4173, 0.0, 0.706468),
    (2.4173, 0.5, 0.420392),
    (2.4173, 1.0, 0.253219),
    (2.4173, 2.0, 0.092831),
]


@pytest.mark.parametrize("index, depth, transmittance", PLATES)
def test_plate_transmits_as_beer_and_lambert_say(index, depth, transmittance):
    with Scene(threads=2) as scene:
        plate = scene.add_gem(index, depth / 0.25)
        glow = scene.add_material(programs.emission(), flags=MaterialFlag.EMISSIVE)
        scene.add_instances(scene.add_mesh(*box((-3, -3, 0), (3, 3, 0.25))), IDENTITY, [plate])
        scene.add_instances(scene.add_mesh(*square(3, -0.5)), IDENTITY, [glow])
        scene.set_camera(**orthographic(0.5, looking_down(2.0)))
        scene.commit()
        image = picture(scene, 16, samples_per_pass=32, **DEEP)
    error = image.std() / math.sqrt(image.size / 3)
    assert error < 0.004 * transmittance
    # Nothing is reflected by index 1: no chance is in it, and no noise.
    within = 3e-5 * transmittance if index == 1 else 4 * error
    assert image.mean(axis=(0, 1)) == pytest.approx(transmittance, rel=0, abs=within), f"{image.mean()} ± {error}"


# And what it sends back, of light from above.
MIRRORS = [
    (1.5, 0.0, 0.076923),
    (1.5, 0.5, 0.053569),
    (1.5, 1.0, 0.044990),
    (1.5, 2.0, 0.040675),
    (2.4173, 0.0, 0.293532),
    (2.4173, 0.5, 0.215871),
    (2.4173, 1.0, 0.188035),
    (2.4173, 2.0, 0.174172),
]


@pytest.mark.parametrize("index, depth, reflectance", MIRRORS)
def test_plate_reflects_as_its_interreflections_say(index, depth, reflectance):
    """A plate on nothing, over a black floor, under a white sky."""
    with Scene(threads=2) as scene:
        black = scene.add_material(programs.diffuse((0, 0, 0)))
        scene.add_instances(scene.add_mesh(*box((-3, -3, 0), (3, 3, 0.25))), IDENTITY, [scene.add_gem(index, depth / 0.25)])
        scene.add_instances(scene.add_mesh(*square(3, -0.5)), IDENTITY, [black])
        scene.set_world(World(programs.emission()))
        scene.set_camera(**orthographic(0.5, looking_down(2.0)))
        scene.commit()
        image = picture(scene, 16, samples_per_pass=32, **DEEP)
    error = image.std() / math.sqrt(image.size / 3)
    assert error < 0.012 * reflectance
    assert image.mean(axis=(0, 1)) == pytest.approx(reflectance, rel=0, abs=4 * error), f"{image.mean()} ± {error}"


@functools.cache
def wall_behind_glass(glass):
    """A sun through a plate on a dark wall, by photons: the pictures of 16 single passes, (16, 12, 12, 3), and what they should be:
    R = ((n-1)/(n+1))², T = (1-R)/(1+R), a percent less for blue than for red (SF11), each channel's mean over daylight as the film sees
    it. The wall is so dark that nothing comes back from it by the plate."""
    reflectance = 1e-3
    index = species.index(glass, wavelengths())
    with Scene(threads=2) as scene:
        scene.add_instances(scene.add_mesh(*box((-0.35, -0.35, 0.5), (0.35, 0.35, 0.6))), IDENTITY, [scene.add_gem(index)])
        wall = scene.add_material(programs.diffuse((reflectance,) * 3))
        scene.add_instances(scene.add_mesh(*square(1)), IDENTITY, [wall])
        scene.add_light(Light(type=LightType.SUN, power=math.pi / reflectance, radius=0.002, transform=looking_down(5.0)))
        scene.set_camera(**orthographic(0.3, looking_down(0.4)))
        scene.commit()
        with Render(scene, width=12, height=12, samples_per_pass=1, photons_per_pass=100_000, max_depth=64, seed=1) as render:
            sums = np.zeros((17, 12, 12, 3))
            for number in range(16):
                render.run_pass(number)
                sums[number + 1] = (number + 1) * render.film()[..., :3].astype(np.float64)
    r = ((index - 1) / (index + 1)) ** 2
    weight = colour.rec709_response() * colour.d65()
    return np.diff(sums, axis=0), (weight * (1 - r) / (1 + r)).sum(axis=1) / weight.sum(axis=1)


@pytest.mark.parametrize("glass", ["BK7", "SF11"])
def test_wall_lit_through_glass_is_as_bright_as_fresnel_says_and_white(glass):
    passes, expected = wall_behind_glass(glass)
    image = passes.mean(axis=0)
    mean, error = image.mean(axis=(0, 1)), image.std(axis=(0, 1)) / 12
    assert error.max() < 0.0008, f"too noisy to tell: {error}"
    assert mean == pytest.approx(expected, rel=0.003), f"{mean} ± {error}, expected {expected}"


def test_a_wall_behind_glass_shows_no_cast_of_single_passes_at_eight_passes():
    """Its colour, each channel beside the three channels' mean, is the closed form's: within 0.1 % over the wall after eight passes, within
    0.3 % in each quarter of it, and a lone pass is not tinted as a whole, which would add up to a cast while passes are few."""

    def cast(part):
        mean = part.mean(axis=(0, 1))
        return np.abs(mean / mean.mean() / neutral - 1).max()

    passes, expected = wall_behind_glass("SF11")
    image = passes[:8].mean(axis=0)
    neutral = expected / expected.mean()
    assert cast(image) < 0.001, f"{100 * cast(image):.3f} %"
    quarters = [image[y : y + 6, x : x + 6] for y in (0, 6) for x in (0, 6)]
    assert max(map(cast, quarters)) < 0.003, f"{100 * max(map(cast, quarters)):.3f} %"
    assert max(map(cast, passes)) < 0.003, f"{100 * max(map(cast, passes)):.3f} %"


def test_index_matched_gem_is_not_there_to_a_millionth():
    """Lit by a world and by a wall that glows in colours, without photons: pixel by pixel the same paths, whatever stands before them."""

    def image(with_gem):
        with Scene(threads=2) as scene:
            glow = scene.add_material(programs.emission((0.8, 0.5, 0.2)), flags=MaterialFlag.EMISSIVE)
            scene.add_instances(scene.add_mesh(*square(0.35)), IDENTITY, [glow])
            if with_gem:
                solid = round_brilliant().scaled(1.0).solid
                faces = [(f[0], f[i], f[i + 1]) for f in solid.faces for i in range(1, len(f) - 1)]
                scene.add_instances(scene.add_mesh(solid.vertices + (0, 0, 0.7), faces), IDENTITY, [scene.add_gem(1.0)])
            scene.set_world(World(programs.emission((0.3, 0.4, 0.5))))
            scene.set_camera(**orthographic(0.6, looking_down(3.0)))
            scene.commit()
            return picture(scene, 4, samples_per_pass=8, **DEEP)

    seen, bare = image(True), image(False)
    assert np.abs(seen - bare).max() < 1e-6, f"{np.abs(seen - bare).max():.1e}"


def test_index_matched_gem_is_not_there():
    """With a small first radius: the rim of a caustic seen through its gem is blurred over the rim by the photons' kernel."""

    def image(with_gem):
        with Scene(threads=2) as scene:
            wall = scene.add_material(programs.diffuse((0.8, 0.5, 0.2)))
            scene.add_instances(scene.add_mesh(*square(2)), IDENTITY, [wall])
            if with_gem:
                scene.add_instances(scene.add_mesh(*box((-0.3, -0.3, 0.2), (0.3, 0.3, 0.5))), IDENTITY, [scene.add_gem(1.0)])
            scene.add_light(Light(type=LightType.SUN, power=2.0, radius=0.05, transform=looking_down(5.0)))
            scene.set_world(World(programs.emission((0.3, 0.4, 0.5))))
            scene.set_camera(**orthographic(0.6, looking_down(2.0)))
            scene.commit()
            return picture(scene, 16, samples_per_pass=8, photons_per_pass=100_000, radius=0.003)

    seen, bare = image(True), image(False)
    assert seen.mean(axis=(0, 1)) == pytest.approx(bare.mean(axis=(0, 1)), rel=0.005)
