# SPDX-License-Identifier: GPL-3.0-or-later
"""Media that vary beside closed forms and quadrature (PHYSICS §5.4, 5.5, 5.11, 5.12 and 5.17).

Most scenes are an absorbing or scattering box under a uniform sky of radiance 1, seen straight from above. The mean of the
picture is compared within 4 of its own standard errors, which each test requires to be small, or, where a table says what is right,
within a tolerance, of which the standard error may be four tenths.
"""

import ctypes

import numpy as np
import pytest
from opal_kernels import binding, programs
from opal_kernels.descriptions import Density, EmissionDensity, LightType, MaterialFlag, Phase, PhaseKind, World
from opal_kernels.optics import media, phase_functions, uplift
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box, looking_down, looking_up, orthographic, perspective, picture, placed, square

WIDE = 400.0  # of slabs, in units of their depth


def even_grid(scene, low, high, value=1.0, cells=10):
    """A grid of one value that reaches a voxel beyond the box."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    step = (high - low) / (cells - 3)
    transform = np.eye(4)
    transform[range(3), range(3)], transform[:3, 3] = step, low - step
    return scene.add_grid(np.full((cells, cells, cells), value), transform)


# The same homogeneous medium, said in ways that take different paths through the tracer.
WAYS = {
    "closed form": lambda scene, low, high: (1.0, {}),
    "grid": lambda scene, low, high: (0.5, {"density": Density.GRID, "density_grid": 1 + even_grid(scene, low, high, 2.0)}),
    "noise without contrast": lambda scene, low, high: (2.0, {"density": Density.NOISE, "noise_contrast": 0.0, "noise_detail": 2.0}),
    "below the base height": lambda scene, low, high: (1.0, {"density": Density.HEIGHT, "base_height": 100.0}),
}


def filled_box(scene, low, high, extinction, albedo=0.0, way="closed form", phase=None, **fields):
    factor, more = WAYS[way](scene, low, high)
    medium = scene.add_medium(np.asarray(extinction) * factor, albedo, phase, **{**more, **fields})
    material = scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=medium)
    scene.add_instances(scene.add_mesh(*box(low, high)), IDENTITY, [material])


def black_floor(scene, z):
    corners, faces = square(4 * WIDE, z)
    scene.add_instances(scene.add_mesh(corners, faces), IDENTITY, [scene.add_material(programs.diffuse((0, 0, 0)))])


def mean_and_error(scene, camera=None, passes=4, size=16, seeds=(0, 1, 2, 3), **settings):
    scene.set_camera(**(camera or orthographic(0.4, looking_down(10.0))))
    scene.commit()
    settings = {"samples_per_pass": 64, "max_depth": 1024, "photons_per_pass": 0, **settings}
    images = np.array([picture(scene, passes, size, seed=seed, **settings).mean(axis=(0, 1)) for seed in seeds])
    return images.mean(axis=0), images.std(axis=0, ddof=1) / len(seeds) ** 0.5


def holds(mean, error, expected, largest_error):
    assert np.max(error) < largest_error, f"too noisy to tell: {error}"
    # Four seeds know their spread badly: what the test requires of it bounds it from below.
    allowed = 4 * np.maximum(error, largest_error / 3)
    assert np.all(np.abs(mean - expected) < allowed), f"{mean} ± {error}, expected {expected}"


def is_within(mean, error, expected, tolerance):
    assert np.max(error) < 0.4 * tolerance, f"too noisy to tell: {error}, for a tolerance of {tolerance:.2g}"
    assert np.all(np.abs(mean - expected) < tolerance), f"{mean} ± {error}, expected {expected} ± {tolerance:.2g}"


@pytest.mark.parametrize("way", WAYS)
def test_a_constant_density_lets_through_what_beer_and_lambert_say(way):
    with Scene(threads=2) as scene:
        filled_box(scene, (-1, -1, -1), (1, 1, 1), 0.6, way=way)
        scene.set_world(World(programs.emission()))
        holds(*mean_and_error(scene, passes=2), np.exp(-1.2), 0.004)


@pytest.mark.parametrize("way", WAYS)
def test_a_finite_slab_reflects_what_the_radiative_transfer_tables_say(way):
    """R of a slab of depth 4, albedo 1, isotropic, normal incidence: 0.6911 ± 0.00025 (PHYSICS §5.12), by reciprocity."""
    with Scene(threads=2) as scene:
        filled_box(scene, (-WIDE, -WIDE, 0), (WIDE, WIDE, 1), 4.0, 1.0, way)
        black_floor(scene, -0.01)
        scene.set_world(World(programs.emission()))
        holds(*mean_and_error(scene, passes=2), 0.6911, 0.004)


@pytest.mark.parametrize("depth, reflected, transmitted", [(1.0, 0.3411, 0.6589), (4.0, 0.6911, 0.3089)])
def test_slabs_reflect_and_transmit(depth, reflected, transmitted):
    """The same for other depths; what comes through is seen from between the slab and a black lid, by the light below it."""
    with Scene(threads=2) as scene:
        filled_box(scene, (-WIDE, -WIDE, 0), (WIDE, WIDE, 1), depth, 1.0)
        black_floor(scene, -0.01)
        scene.set_world(World(programs.emission()))
        is_within(*mean_and_error(scene, passes=2), reflected, 0.004)
    with Scene(threads=2) as scene:
        filled_box(scene, (-WIDE, -WIDE, 0), (WIDE, WIDE, 1), depth, 1.0)
        black_floor(scene, 2.0)
        scene.set_world(World(programs.emission()))
        is_within(*mean_and_error(scene, orthographic(0.4, looking_down(1.5)), passes=2), transmitted, 0.004)


@pytest.mark.parametrize(
    "way, albedo, expected, passes, tolerance",
    [
        ("closed form", 0.5, 0.115226, 4, 0.003),
        ("closed form", 0.9, 0.414947, 6, 0.005),
        ("closed form", 0.999, 0.912845, 1, 0.005),
        ("grid", 0.5, 0.115226, 2, 0.008),
        ("grid", 0.9, 0.414947, 2, 0.008),
    ],
)
def test_a_half_space_reflects_chandrasekhars_plane_albedo(way, albedo, expected, passes, tolerance):
    """1 - H(1) sqrt(1 - albedo) (PHYSICS §5.11), within a share of itself: as many scatterings as it takes."""
    with Scene(threads=2) as scene:
        filled_box(scene, (-WIDE, -WIDE, -1), (WIDE, WIDE, 1), 300.0, albedo, way)
        scene.set_world(World(programs.emission()))
        is_within(*mean_and_error(scene, passes=passes), expected, tolerance * expected)
    assert media.half_space_albedo(1.0, albedo) == pytest.approx(expected, abs=2e-5)


@pytest.mark.parametrize("way", WAYS)
def test_single_scattering_of_the_sun_in_a_slab(way):
    """Without bounces, reflected and transmitted (PHYSICS §5.4): 0.03440392 and 0.02927492 of the irradiance, within 0.5 %."""
    reflected, transmitted = media.single_scattering_slab(1.0, 1.0, 1.0)
    exact = way in ("closed form", "below the base height")
    for camera, expected in ((looking_down(10.0), reflected), (looking_up(-5.0), transmitted)):
        with Scene(threads=2) as scene:
            filled_box(scene, (-WIDE, -WIDE, 0), (WIDE, WIDE, 1), 1.0, 0.8, way)
            scene.add_light(type=2, power=1.0, transform=looking_down(5.0))
            mean, error = mean_and_error(scene, orthographic(0.4, camera), passes=1 if exact else 8, max_depth=0)
            is_within(mean / (0.8 * expected), error / (0.8 * expected), 1.0, 0.001 if exact else 0.005)


@pytest.mark.parametrize(
    "distance, extinction, expected", [(1.0, 0.1, 0.12718907), (1.0, 0.5, 0.03714498), (0.1, 0.1, 1.93599726), (0.1, 0.5, 0.80336020)]
)
def test_a_ray_gathers_airlight_of_a_point_lamp(distance, extinction, expected):
    """A lamp of intensity 1 W/sr beside a ray of 4 m, in its middle: radiance per scattering coefficient (PHYSICS §5.5)."""
    with Scene(threads=2) as scene:
        filled_box(scene, (-50, -50, -2), (50, 50, 2), extinction, 1.0)
        scene.add_light(type=0, power=4 * np.pi, radius=0.0, transform=placed(distance)[:3])
        mean, error = mean_and_error(scene, orthographic(1e-4, looking_down(2 - 1e-6)), passes=2, size=8, max_depth=0)
        is_within(mean / extinction / expected, error / extinction / expected, 1.0, 0.002)


def test_paths_in_dense_white_media_leave_no_specks():
    """Albedo 1, 200 free paths across, lit by a sun and by the sky: of 1600 pixels with 4 samples the brightest has not 5 times the
    median. Were the longest chains cut earlier, those that go on would weigh too much: 6 to 10 times."""
    for suns in (True, False):
        with Scene(threads=2) as scene:
            filled_box(scene, (-1, -1, -1), (1, 1, 1), 100.0, 1.0)
            if suns:
                scene.add_light(type=2, power=np.pi, transform=looking_down(5.0))
            else:
                scene.set_world(World(programs.emission()))
            scene.set_camera(**orthographic(0.9, looking_down(10.0)))
            scene.commit()
            light = picture(scene, 1, 40, samples_per_pass=4, photons_per_pass=0, max_depth=64)[..., 1]
            assert light.max() < 5 * np.median(light), f"{light.max():.2f}, median {np.median(light):.2f}"


@pytest.mark.parametrize("way", WAYS)
def test_a_veil_under_the_sun_has_light_in_every_sample(way):
    """Of rays through a depth of 0.05 one in 20 collides: N of those alone would have an error of sqrt(20 / N), here 0.02."""
    with Scene(threads=2) as scene:
        filled_box(scene, (-WIDE, -WIDE, 0), (WIDE, WIDE, 1), 0.05, 0.8, way)
        scene.add_light(type=2, power=1.0, transform=looking_down(5.0))
        mean, error = mean_and_error(scene, passes=2, size=10, max_depth=0)
        right = 0.8 * media.single_scattering_slab(0.05, 1.0, 1.0)[0]
        holds(mean / right, error / right, 1.0, 0.004)


def test_a_density_that_grows_linearly():
    """sigma(t) = c t: T = exp(-c d^2 / 2) (PHYSICS §5.17), for three depths of a ramp."""
    n, c = 40, 1.5
    ramp = np.broadcast_to(c * (np.arange(n) / (n - 1) * 2.0), (n, n, n))  # grows with z, 0 to 2 m
    transform = np.diag([2 / (n - 1)] * 3 + [1.0])
    transform[:2, 3] = -1
    for depth in (0.5, 1.0, 1.8):
        with Scene(threads=2) as scene:
            grid = scene.add_grid(ramp, transform)
            filled_box(scene, (-0.9, -0.9, 0), (0.9, 0.9, depth), 1.0, density=Density.GRID, density_grid=1 + grid)
            scene.set_world(World(programs.emission()))
            holds(*mean_and_error(scene, passes=2), np.exp(-c * depth**2 / 2), 0.004)


def trilinear(values, p):
    """Reference interpolation, 0 from one voxel beyond the grid on."""
    padded = np.pad(values, 1)
    s = np.clip(np.asarray(p) + 1, 0, np.array(padded.shape) - 1.000001)
    i = s.astype(int)
    f = s - i
    out = np.zeros(len(s))
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(corner, f, 1 - f), axis=1)
        out += weight * padded[tuple((i + np.array(corner)).T)]
    return out


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_random_sparse_grids_let_through_what_quadrature_says(seed):
    """Bricks in which a few voxels are filled at random, turned and sheared; each pixel is one ray, summed over the picture."""
    random = np.random.default_rng(seed)
    shape = random.integers(9, 30, 3)
    values = random.exponential(2.0, shape) * (random.random(shape) < 0.15)
    to_object = np.eye(4)
    to_object[:3, :3] = np.diag(2 / shape) @ (np.eye(3) + 0.15 * random.standard_normal((3, 3)))
    to_object[:3, 3] = -to_object[:3, :3] @ (shape / 2)
    pixels, half = 24, 0.7
    x = (np.arange(pixels) + 0.5) / pixels * 2 * half - half
    to_index = np.linalg.inv(to_object)
    z = (np.arange(2000) + 0.5) / 2000 * 4 - 2
    expected = np.empty((pixels, pixels))
    for j, v in enumerate(x):
        for i, u in enumerate(x):
            p = np.stack([np.full_like(z, u), np.full_like(z, v), z, np.ones_like(z)]).T @ to_index.T
            expected[j, i] = np.exp(-trilinear(values, p[:, :3]).sum() * 4 / 2000)
    with Scene(threads=2) as scene:
        grid = scene.add_grid(values, to_object)
        filled_box(scene, (-2, -2, -2), (2, 2, 2), 1.0, density=Density.GRID, density_grid=1 + grid)
        scene.set_world(World(programs.emission()))
        scene.set_camera(**orthographic(half, looking_down(10.0)))
        scene.commit()
        image = picture(scene, 8, pixels, samples_per_pass=64, photons_per_pass=0, filter=0, filter_width=0.02)[..., 1]
    # A pixel is the mean of n draws of 0 or 1.
    error = np.sqrt(np.maximum(expected * (1 - expected), 1e-4) / 512)
    deviation = (image - expected) / error
    assert abs(deviation.mean()) < 4 / pixels, f"mean deviation {deviation.mean():.3f} standard errors"
    assert np.abs(deviation).max() < 5.5 and deviation.std() < 1.15


def test_chromatic_extinction_is_right_in_each_channel():
    """Through a grid with extinction that triples over the spectrum each channel is as the closed form says."""
    extinction = np.linspace(0.5, 1.5, 471)
    means = {}
    for way in ("closed form", "grid"):
        with Scene(threads=2) as scene:
            filled_box(scene, (-1, -1, -1), (1, 1, 1), extinction, way=way)
            scene.set_world(World(programs.emission()))
            means[way] = mean_and_error(scene, passes=2)
    error = np.hypot(means["grid"][1], means["closed form"][1])
    holds(means["grid"][0], error, means["closed form"][0], 0.004)
    assert means["closed form"][0][2] > 1.3 * means["closed form"][0][0], "blue is let through, red is not"


@pytest.mark.parametrize("way", ["closed form", "grid"])
def test_chromatic_extinction_brings_no_colour_noise(way):
    """Wavelengths share each path, so no channel is much noisier than in a grey medium of the mean extinction.

    Were they weighted by the hero alone, paths through this depth would weigh up to exp(2) = 7 in others."""

    def noise(extinction):
        with Scene(threads=2) as scene:
            filled_box(scene, (-1, -1, -1), (1, 1, 1), extinction, 0.9, way=way)
            scene.set_world(World(programs.emission()))
            scene.set_camera(**orthographic(0.4, looking_down(10.0)))
            scene.commit()
            image = picture(scene, 1, 32, samples_per_pass=16, photons_per_pass=0, max_depth=64)
        return (image / image.mean(axis=(0, 1))).std(axis=(0, 1))

    grey, coloured = noise(1.0), noise(np.linspace(0.5, 1.5, 471))
    assert np.all(coloured < 1.4 * grey), f"noise of the channels {coloured}, in a grey medium {grey}"


def steps_through(scene, medium, rays, length):
    """(intervals, tentative collisions) of rays (n, 2, 3), as `opal_test_medium_steps` counts them."""
    rays = np.ascontiguousarray(np.swapaxes(rays, 0, 1), np.float32)
    pointers = [a.ctypes.data_as(ctypes.POINTER(ctypes.c_float)) for a in rays]
    found = ctypes.c_int64(), ctypes.c_int64()
    call = binding.library().opal_test_medium_steps
    call.restype = ctypes.c_int32
    counts = [ctypes.byref(f) for f in found]
    handle, number, n = ctypes.c_void_p(scene.handle), ctypes.c_int32(medium), ctypes.c_int64(rays.shape[1])
    assert call(handle, number, n, *pointers, ctypes.c_float(length), *counts) == 0
    return found[0].value, found[1].value


def test_a_cloud_that_is_99_percent_empty_costs_what_is_filled():
    """256 voxels along each axis, a cube of 55 of them filled: density is read as often as in a grid of that cube alone.

    Rays in all directions through the cloud; counted, not timed."""
    random = np.random.default_rng(5)
    ends = random.uniform(0, 256, (2000, 2, 3))
    direction = ends[:, 1] - ends[:, 0]
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    rays = np.stack([ends[:, 0] - 500 * direction, direction], axis=1)
    filled, first = np.full((55, 55, 55), 0.3), 96  # at the bounds of bricks
    counts = {}
    for name, size, offset in (("sparse", 256, first), ("alone", 55, 0), ("dense", 256, None)):
        with Scene(threads=1) as scene:
            transform = np.eye(4)
            if name == "alone":
                transform[:3, 3] = first
            grid = binding.scene_add_grid(scene.handle, (size,) * 3, transform)
            if offset is not None:
                binding.scene_set_grid_block(scene.handle, grid, filled, (offset,) * 3)
            else:
                everywhere = np.full((256, 256, 256), 1e-3, np.float32)
                everywhere[first : first + 55, first : first + 55, first : first + 55] = filled
                binding.scene_set_grid_block(scene.handle, grid, everywhere)
            medium = scene.add_medium(1.0, density=Density.GRID, density_grid=1 + grid)
            scene.commit()
            counts[name] = steps_through(scene, medium, rays, 1000.0)
    assert counts["alone"][1] > 1000, counts
    assert counts["sparse"][1] < 1.1 * counts["alone"][1], counts
    assert counts["sparse"][0] < 1.1 * counts["alone"][0], counts
    assert counts["dense"][0] > 3 * counts["sparse"][0], counts


def test_emission_without_extinction_adds_up_along_the_ray():
    """A glowing grid that takes nothing: the radiance is the integral of the emission, 1/m times 2 m times one half."""
    with Scene(threads=2) as scene:
        grid = even_grid(scene, (-1, -1, -1), (1, 1, 1), 0.5)
        filled_box(
            scene,
            (-1, -1, -1),
            (1, 1, 1),
            0.0,
            emission=np.ones(471),
            emission_density=EmissionDensity.GRID,
            emission_density_grid=1 + grid,
        )
        scene.set_world(None)
        varying = mean_and_error(scene, passes=2)
    with Scene(threads=2) as scene:
        filled_box(scene, (-1, -1, -1), (1, 1, 1), 0.0, emission=np.full(471, 0.5))
        scene.set_world(None)
        exact = mean_and_error(scene, passes=2)
    holds(varying[0] / exact[0], varying[1] / exact[0], 1.0, 0.01)


def test_glow_and_extinction_together():
    """e (1 - exp(-sigma d)) / sigma, in a grid."""
    with Scene(threads=2) as scene:
        filled_box(scene, (-1, -1, -1), (1, 1, 1), 1.2, way="grid", emission=np.full(471, 0.5))
        scene.set_world(None)
        varying = mean_and_error(scene, passes=4)
    with Scene(threads=2) as scene:
        filled_box(scene, (-1, -1, -1), (1, 1, 1), 1.2, emission=np.full(471, 1.0))
        scene.set_world(None)
        exact = mean_and_error(scene, passes=4)
    holds(varying[0] / exact[0], varying[1] / exact[0], 1.0, 0.01)


def test_a_lamp_inside_a_varying_medium_is_as_bright_as_in_a_homogeneous_one():
    """Equiangular distances, collisions and hits of the lamp are weighted to one; forward scattering, a small lamp on view."""
    found = {}
    for way in ("closed form", "grid"):
        with Scene(threads=2) as scene:
            filled_box(scene, (-1, -1, -1), (1, 1, 1), 1.5, 0.8, way, Phase(PhaseKind.HENYEY_GREENSTEIN, 0.6))
            scene.add_light(type=0, power=50.0, radius=0.2, transform=looking_down(0.3), soft_falloff=0)
            scene.set_world(None)
            found[way] = mean_and_error(scene, perspective(1.0, looking_down(4.0)), passes=8, max_depth=8)
    ratio = found["grid"][0] / found["closed form"][0]
    error = np.hypot(found["grid"][1] / found["grid"][0], found["closed form"][1] / found["closed form"][0])
    assert error.max() < 0.03
    assert np.all(np.abs(ratio - 1) < 4 * np.maximum(error, 0.01)), f"{ratio} ± {error}"


def test_what_a_floor_scatters_after_a_medium_is_weighted_as_the_floors():
    """Camera, medium, floor, sky: with a lamp near by the shares of equiangular distances end at the floor.

    The same box of even density, in closed form and as a grid, on a white floor under lamp and sky; left at the floor, the shares
    take 5 % of this picture.
    """
    found = {}
    for way in ("closed form", "grid"):
        with Scene(threads=2) as scene:
            filled_box(scene, (-1, -1, -1), (1, 1, 1), 0.8, 1.0, way)
            corners, faces = square(4.0, -1.01)
            white = scene.add_material(programs.diffuse((0.8, 0.8, 0.8)))
            scene.add_instances(scene.add_mesh(corners, faces), IDENTITY, [white])
            scene.add_light(type=0, power=60.0, radius=0.3, transform=looking_down(2.5), soft_falloff=0)
            scene.set_world(World(programs.emission()))
            found[way] = mean_and_error(scene, orthographic(0.9, looking_down(2.0)), passes=2)
    ratio = found["grid"][0] / found["closed form"][0]
    error = np.hypot(found["grid"][1] / found["grid"][0], found["closed form"][1] / found["closed form"][0])
    holds(ratio, error, 1.0, 0.004)


def test_overlapping_media_add():
    with Scene(threads=2) as scene:
        filled_box(scene, (-1, -1, -1), (1, 1, 1), 0.3)
        filled_box(scene, (-1.1, -1.1, -0.5), (1.1, 1.1, 2), 0.4, way="grid")
        scene.set_world(World(programs.emission()))
        holds(*mean_and_error(scene, passes=2), np.exp(-0.6 - 0.4 * 2.5), 0.004)


def test_a_medium_with_another_in_the_same_body_is_as_two_that_overlap():
    """Red scatters alike into every direction, the rest back, 1 per metre together: the slab's single scattering by colour; and what
    a cube lets through."""
    red, g = np.array([0.9, 0.2, 0.3]), -0.4
    with Scene(threads=2) as scene:
        part = uplift.reflectance(red)
        other = scene.add_medium(1 - part, 1.0, Phase(PhaseKind.HENYEY_GREENSTEIN, g))
        filled_box(scene, (-WIDE, -WIDE, 0), (WIDE, WIDE, 1), part, 1.0, also=1 + other)
        scene.add_light(type=2, power=1.0, transform=looking_down(5.0))
        mean, error = mean_and_error(scene, passes=2, max_depth=0)
        back = 4 * np.pi * phase_functions.henyey_greenstein(np.array(-1.0), g)
        holds(mean, error, (red + (1 - red) * back) * media.single_scattering_slab(1.0, 1.0, 1.0)[0], 0.002)
    with Scene(threads=2) as scene:
        grid = 1 + even_grid(scene, (-1, -1, -1), (1, 1, 1), 2.0)
        filled_box(scene, (-1, -1, -1), (1, 1, 1), 0.4, also=1 + scene.add_medium(0.1, 0.0, density=Density.GRID, density_grid=grid))
        scene.set_world(World(programs.emission()))
        holds(*mean_and_error(scene, passes=1), np.exp(-1.2), 0.004)
        with pytest.raises(binding.OpalError, match="does not exist"):
            scene.add_medium(1.0, also=9)


def test_a_camera_inside_sees_through_the_rest():
    with Scene(threads=2) as scene:
        filled_box(scene, (-1, -1, -1), (1, 1, 1), 0.8, way="grid")
        scene.set_world(World(programs.emission()))
        holds(*mean_and_error(scene, orthographic(0.4, looking_down(0.25)), passes=2), np.exp(-1.0), 0.004)


def test_what_has_no_end_holds_up_no_light_that_it_does_not_absorb():
    """Noise without an end that absorbs below 560 nm alone: the rest of a sun's light gets through as through an even medium."""

    def ground(**density):
        with Scene(threads=2) as scene:
            scene.set_world_medium(scene.add_medium(np.where(np.arange(360, 831) < 560, 5.0, 0.0), 0.0, **density))
            scene.add_instances(scene.add_mesh(*square(1.0)), IDENTITY, [scene.add_material(programs.diffuse((0.5, 0.5, 0.5)))])
            scene.add_light(type=LightType.SUN, power=1.0, transform=looking_down(0.0))
            scene.set_camera(**orthographic(0.5, looking_down(1e-3)))
            scene.commit()
            return picture(scene, 1, 8, samples_per_pass=64, photons_per_pass=0).mean(axis=(0, 1))

    even = ground()
    assert even[0] > 0.2
    assert ground(density=Density.NOISE, noise_scale=1.0) == pytest.approx(even, rel=5e-3)


def test_haze_that_thins_with_height():
    """From height 0 straight down from above everything: depth sigma H; the sky shines through."""
    with Scene(threads=2) as scene:
        scene.set_world_medium(scene.add_medium(0.01, 0.0, density=Density.HEIGHT, scale_height=70.0))
        scene.set_world(World(programs.emission()))
        up = np.diag([1.0, -1.0, -1.0, 1.0])[:3]
        holds(*mean_and_error(scene, orthographic(0.4, up), passes=2), np.exp(-0.7), 0.004)


def test_albedo_one_without_absorption_is_a_white_furnace():
    """Whatever the noise, what scatters only cannot be seen in front of an even sky."""
    with Scene(threads=2) as scene:
        filled_box(scene, (-1, -1, -1), (1, 1, 1), 6.0, 1.0, density=Density.NOISE, noise_scale=0.4, noise_detail=3.0, noise_contrast=4.0)
        scene.set_world(World(programs.emission()))
        holds(*mean_and_error(scene, passes=2), 1.0, 0.004)


def test_noise_depends_on_its_seed_and_nothing_else():
    def image(seed, threads):
        with Scene(threads=threads) as scene:
            fields = {"density": Density.NOISE, "noise_scale": 0.5, "noise_contrast": 5.0, "noise_seed": seed}
            filled_box(scene, (-1, -1, -1), (1, 1, 1), 3.0, **fields)
            scene.set_world(World(programs.emission()))
            scene.set_camera(**orthographic(0.9, looking_down(10.0)))
            scene.commit()
            return picture(scene, 1, 32, samples_per_pass=16, photons_per_pass=0)

    assert np.array_equal(image(1, 1), image(1, 2))
    assert np.abs(image(1, 2) - image(2, 2)).mean() > 0.05


def test_bad_voxels_are_counted_and_taken_as_nothing():
    values = np.ones((12, 5, 7))
    values[3, 2, 1], values[4, 4, 4], values[11, 0, 6] = np.nan, np.inf, -2.0
    with Scene(threads=1) as scene:
        grid = binding.scene_add_grid(scene.handle, values.shape, np.eye(4))
        assert binding.scene_set_grid_block(scene.handle, grid, values) == (2, 1)


def test_empty_space_takes_no_memory():
    """256 voxels along each axis, one in a hundred bricks filled: 1 % of the dense size, and the table."""
    with Scene(threads=1) as scene:
        before = scene.statistics["memory_bytes"]
        grid = binding.scene_add_grid(scene.handle, (256, 256, 256), np.eye(4))
        binding.scene_set_grid_block(scene.handle, grid, np.ones((52, 52, 52)), (100, 100, 100))
        scene.commit()
        assert scene.statistics["memory_bytes"] - before < 0.06 * 256**3 * 4


@pytest.mark.parametrize(
    "size, channels, transform, sentence",
    [
        ((0, 4, 4), 1, np.eye(4), "between 1 and 16384"),
        ((4, 4, 4), 2, np.eye(4), "1 or 3 channels"),
        ((4, 4, 4), 1, np.zeros((4, 4)), "scaled to nothing"),
    ],
)
def test_impossible_grids_are_refused_in_a_sentence(size, channels, transform, sentence):
    with Scene(threads=1) as scene, pytest.raises(binding.OpalError, match=sentence):
        binding.scene_add_grid(scene.handle, size, transform, channels)


def test_a_medium_needs_a_grid_that_exists():
    with Scene(threads=1) as scene, pytest.raises(binding.OpalError, match="grid that does not exist"):
        scene.add_medium(1.0, density=Density.GRID, density_grid=7)
