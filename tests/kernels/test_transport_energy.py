# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the photons' energy goes (PHYSICS §5.9): the tracer's own account beside closed forms, and what the kernel makes of photons.

The lamp is a sheet of parallel light that falls wholly on what is under it, so that closed forms hold photon by photon.
"""

import math

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.cuts import round_brilliant
from opal_kernels.descriptions import Carry, Light, LightType, wavelengths
from opal_kernels.optics import species
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box, looking_down, orthographic, picture, square

SIGMA, THICK = 4.0, 0.25
"""Absorption of the plates, 1/m, and their thickness, m: an optical depth of 1."""


def beam(power=1.0, width=0.2):
    """Parallel light straight down on a square of this width about the axis."""
    transform = looking_down(2.0)
    return Light(type=LightType.RECTANGLE, power=power, size_u=width, size_v=width, spread=0.0, transform=transform)


def account(mesh, gem, photons, floor=None, seed=0, **settings):
    """Shares of the emitted energy that were stored, absorbed, and escaped from a gem under the beam, over a floor of this reflectance."""
    with Scene(threads=2) as scene:
        scene.add_instances(scene.add_mesh(*mesh), IDENTITY, [scene.add_gem(*gem)])
        if floor is not None:
            scene.add_instances(scene.add_mesh(*square(3, -0.5)), IDENTITY, [scene.add_material(programs.diffuse((floor,) * 3))])
        scene.add_light(beam())
        scene.set_camera(**orthographic(1.0, looking_down(3.0)))
        scene.commit()
        with Render(scene, width=2, height=2, samples_per_pass=1, photons_per_pass=photons, seed=seed, **settings) as render:
            found = render.run(1).statistics
    assert found["energy_emitted"] > 0
    return tuple(found[f"energy_{name}"] / found["energy_emitted"] for name in ("stored", "absorbed", "escaped"))


PLATE = box((-1, -1, 0), (1, 1, THICK))


def faceted(cut):
    solid = cut.scaled(1.0).solid
    return solid.vertices, [(f[0], f[i], f[i + 1]) for f in solid.faces for i in range(1, len(f) - 1)]


def test_a_plate_of_index_1_absorbs_what_beer_and_lambert_say_of_every_photon():
    _, absorbed, escaped = account(PLATE, (1.0, SIGMA), 5000)
    assert escaped == pytest.approx(math.exp(-SIGMA * THICK), abs=1e-6)
    assert absorbed == pytest.approx(1 - math.exp(-SIGMA * THICK), abs=1e-6)


def test_light_that_reaches_a_floor_is_stored_there():
    stored, absorbed, escaped = account(PLATE, (1.0, SIGMA), 5000, floor=0.5)
    assert stored == pytest.approx(math.exp(-SIGMA * THICK), abs=1e-6)
    assert absorbed + escaped == pytest.approx(1 - math.exp(-SIGMA * THICK), abs=1e-6)


@pytest.mark.parametrize("name", sorted(species.table()))
def test_a_lossless_plate_of_every_species_lets_all_energy_go_to_a_millionth(name):
    """Of so few photons none is left for roulette, which sets in at the sixth event: R⁵ of them, 4 in 10,000 in moissanite."""
    _, absorbed, escaped = account(PLATE, (species.index(name, wavelengths()),), 200, seed=1)
    assert escaped == pytest.approx(1.0, abs=1e-6)
    assert absorbed == pytest.approx(0.0, abs=1e-6)


def test_an_absorbing_plate_divides_the_energy_as_its_interreflections_do():
    """n = 1.5, σd = 1: 0.339111 through, 0.044990 back, the rest absorbed."""
    shares = [account(PLATE, (1.5, SIGMA), 20_000, seed=seed) for seed in range(4)]
    escaped = np.array([share[2] for share in shares])
    error = max(escaped.std(ddof=1) / 2, 2e-4)
    assert escaped.mean() == pytest.approx(0.339111 + 0.044990, abs=4 * error), f"{escaped.mean():.5f} ± {error:.5f}"


@pytest.mark.parametrize("name", ["DIAMOND", "QUARTZ", "MOISSANITE"])
def test_a_lossless_brilliant_alone_lets_all_energy_go(name):
    """Every chain of facets ends outside; roulette takes of the long ones as much as it adds, within 4 standard errors."""
    stone, gem = faceted(round_brilliant()), (species.index(name, wavelengths()),)
    escaped = np.array([account(stone, gem, 8000, seed=seed)[2] for seed in range(8)])
    error = escaped.std(ddof=1) / math.sqrt(8)
    assert error < 0.002
    assert escaped.mean() == pytest.approx(1.0, abs=4 * error + 1e-6), f"{escaped.mean():.5f} ± {error:.5f}"


def lit_floor(photons, passes=1, seed=0):
    """Pixels of a floor of reflectance 0.6 under a sun of irradiance 2, all by photons seen directly."""
    with Scene(threads=2) as scene:
        scene.add_instances(scene.add_mesh(*square(1)), IDENTITY, [scene.add_material(programs.diffuse((0.6, 0.6, 0.6)))])
        scene.add_light(Light(type=LightType.SUN, power=2.0, transform=looking_down(5.0)))
        scene.set_camera(**orthographic(0.5, looking_down(2.0)))
        scene.commit()
        settings = {"samples_per_pass": 1, "photons_carry": Carry.ALL, "filter": 0, "filter_width": 1.0}
        return picture(scene, passes, size=32, photons_per_pass=photons, seed=seed, **settings)[..., 1]


def test_photons_light_a_floor_as_irradiance_times_reflectance_over_pi():
    image = lit_floor(40_000)
    error = image.std() / 32
    assert error < 0.01 * image.mean()
    assert image.mean() == pytest.approx(2.0 * 0.6 / math.pi, abs=4 * error), f"{image.mean():.5f} ± {error:.5f}"


def test_variance_halves_with_twice_the_passes_and_falls_no_slower_with_twice_the_photons():
    """Of 1024 pixels, so known to 4.4 %; passes are independent, the photons of one pass spread more evenly than at random."""
    once, twice_the_passes, twice_the_photons = (lit_floor(*how).var() for how in ((10_000, 2), (10_000, 4), (20_000, 2)))
    assert once / twice_the_passes == pytest.approx(2.0, abs=0.3)
    assert once / twice_the_photons > 1.7


def test_the_kernel_integrates_to_one():
    """A lit square, seen through a plate of index 1 and so by looking photons up, holds as much light as fell on it, however wide the
    kernel: radiance summed over the picture is ρΦ/π."""
    half, reflectance = 0.4, 0.6
    with Scene(threads=2) as scene:
        scene.add_instances(scene.add_mesh(*square(1)), IDENTITY, [scene.add_material(programs.diffuse((reflectance,) * 3))])
        scene.add_instances(scene.add_mesh(*box((-0.9, -0.9, 2.2), (0.9, 0.9, 2.4))), IDENTITY, [scene.add_gem(1.0)])
        scene.add_light(beam())
        scene.set_camera(**orthographic(half, looking_down(3.0)))
        scene.commit()
        for radius in (0.02, 0.1):
            settings = {"photons_carry": Carry.ALL, "gather": 1 << 20, "radius": radius, "samples_per_pass": 64}
            image = picture(scene, 1, size=32, photons_per_pass=2000, **settings)[..., 1]
            held = image.mean() * (2 * half) ** 2
            assert held == pytest.approx(reflectance / math.pi, rel=0.005), f"radius {radius}: {held * math.pi / reflectance:.4f}"
