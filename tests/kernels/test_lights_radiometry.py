# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps give the light that Blender's watts mean: PHYSICS section 6b, measured in Cycles, and its closed forms."""

import numpy as np
import pytest
from light_probe import (
    emission_program,
    irradiance,
    lamp,
    lights_along,
    numbers,
    receiver,
    sample_light,
    scene_with,
)
from opal_kernels import programs
from opal_kernels.descriptions import LightType, Ray, World
from opal_kernels.optics import colour, illuminants, uplift
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, looking_down, orthographic, picture, square

DOWN, UP = (0, 0, -1), (0, 0, 1)
WEIGHTS = np.array([0.2126729, 0.7151522, 0.0721750])  # of Rec.709 in luminance
TOLERANCE = 2e-3  # of the 64 wavelengths that the probe integrates over, mostly


def test_point_without_a_size_has_the_intensity_of_its_power_over_the_sphere():
    with scene_with(lamp(LightType.POINT, (0, 0, 2), power=100.0)) as scene:
        e, _ = irradiance(scene, (0, 0, 0), UP, n=16)
    assert e == pytest.approx(np.full(3, 100 / (4 * np.pi) / 4), rel=TOLERANCE)


@pytest.mark.parametrize(("soft", "expected"), [(1, 1 / (1 + 0.5**2 / 2**2)), (0, 1.0)])
def test_point_with_a_radius_is_a_facing_disc_or_a_sphere(soft, expected):
    with scene_with(lamp(LightType.POINT, (0, 0, 2), power=100.0, radius=0.5, soft_falloff=soft)) as scene:
        e, error = irradiance(scene, (0, 0, 0), UP)
    assert e == pytest.approx(np.full(3, expected * 100 / (16 * np.pi)), rel=TOLERANCE), error


@pytest.mark.parametrize(("angle", "blend"), [(0.5, 0.0), (0.5, 1.0), (2.0, 0.15), (3.1, 0.5)])
def test_spot_is_as_bright_on_its_axis_as_the_point(angle, blend):
    with scene_with(
        lamp(
            LightType.SPOT,
            (0, 0, 2),
            DOWN,
            power=100.0,
            spot_angle=angle,
            spot_blend=blend,
        )
    ) as scene:
        e, _ = irradiance(scene, (0, 0, 0), UP, n=16)
    assert e == pytest.approx(np.full(3, 100 / (16 * np.pi)), rel=TOLERANCE)


def test_spot_falls_off_as_a_smooth_step_of_the_cosine():
    angle, blend, height = 1.2, 0.6, 2.0
    with scene_with(
        lamp(
            LightType.SPOT,
            (0, 0, height),
            DOWN,
            power=1.0,
            spot_angle=angle,
            spot_blend=blend,
        )
    ) as scene:
        for theta in np.linspace(0, 0.7, 8):
            s = sample_light(scene, receiver((height * np.tan(theta), 0, 0), UP), [[0.5, 0.5, 0.5]])
            half = np.cos(angle / 2)
            x = np.clip((np.cos(theta) - half) / ((1 - half) * blend), 0, 1)
            expected = x * x * (3 - 2 * x) / (4 * np.pi) * (np.cos(theta) / height) ** 2
            found = s["radiance"][0] / max(s["pdf"][0], 1e-30)
            assert found == pytest.approx(np.full(3, expected), rel=TOLERANCE, abs=1e-9), theta


@pytest.mark.parametrize("angle", [0.0, np.radians(0.526), 0.5, 2.0])
def test_sun_gives_its_strength_to_a_plane_that_faces_it(angle):
    direction = np.array([0.3, -0.2, -1.0])
    facing = -direction / np.linalg.norm(direction)
    with scene_with(lamp(LightType.SUN, direction=direction, power=3.0, radius=angle / 2)) as scene:
        e, error = irradiance(scene, (5, 6, 7), facing)
    assert e == pytest.approx(np.full(3, 3.0), rel=TOLERANCE), error


@pytest.mark.parametrize("kind", [LightType.RECTANGLE, LightType.ELLIPSE])
def test_area_lamp_has_the_axial_intensity_of_its_power_over_pi_whatever_its_shape(
    kind,
):
    far = 60.0
    with scene_with(lamp(kind, (0, 0, far), DOWN, power=100.0, size_u=0.5, size_v=0.25)) as scene:
        e, _ = irradiance(scene, (0, 0, 0), UP, n=4000)
    assert e == pytest.approx(np.full(3, 100 / np.pi / far**2), rel=TOLERANCE)


def test_area_lamp_close_by_gives_the_irradiance_of_a_lambertian_disc():
    height, radius = 0.4, 0.5
    with scene_with(
        lamp(
            LightType.ELLIPSE,
            (0, 0, height),
            DOWN,
            power=10.0,
            size_u=2 * radius,
            size_v=2 * radius,
        )
    ) as scene:
        e, error = irradiance(scene, (0, 0, 0), UP, n=100_000)
    radiance = 10 / (np.pi * np.pi * radius**2)
    assert e == pytest.approx(
        np.full(3, np.pi * radiance * radius**2 / (radius**2 + height**2)),
        rel=TOLERANCE,
    ), error


@pytest.mark.parametrize("degrees", [1.0, 20.0, 60.0, 120.0])
def test_spread_concentrates_the_same_power(degrees):
    """On the axis tan s / (tan s - s) times as much, s half of the spread; the flux through a sphere stays the power."""
    s = np.radians(degrees) / 2
    expected = np.tan(s) / (np.tan(s) - s)
    size = 1e-4
    with scene_with(
        lamp(
            LightType.RECTANGLE,
            (0, 0, 1),
            DOWN,
            power=1.0,
            size_u=size,
            size_v=size,
            spread=2 * s,
        )
    ) as scene:
        on_axis, _ = irradiance(scene, (0, 0, 0), UP, n=256)
        theta = (np.arange(400) + 0.5) / 400 * s
        flux = 0.0
        for t in theta:
            at = np.array([np.sin(t), 0, 1 - np.cos(t)])
            sample = sample_light(scene, receiver(at), [[0.5, 0.5, 0.5]])
            if sample["pdf"][0] > 0:
                flux += sample["radiance"][0, 1] / sample["pdf"][0] * 2 * np.pi * np.sin(t) * s / 400
    assert on_axis[1] == pytest.approx(expected / np.pi, rel=5e-3)
    assert flux == pytest.approx(1.0, rel=1e-2)


def test_lamps_scale_with_their_objects_but_keep_their_power():
    light = lamp(
        LightType.RECTANGLE,
        (0, 0, 2),
        DOWN,
        scale=(3, 0.5, 1),
        power=10.0,
        size_u=1,
        size_v=1,
    )
    along_x, along_y = (light.transform[:, i] / np.linalg.norm(light.transform[:, i]) for i in (0, 1))
    with scene_with(light) as scene:
        distance, radiance, _ = lights_along(
            scene,
            [1.4 * along_x, 1.6 * along_x, 0.2 * along_y, 0.3 * along_y],
            [UP] * 4,
        )
    assert np.isfinite(distance).tolist() == [True, False, True, False]
    assert radiance[0] == pytest.approx(np.full(3, 10 / (np.pi * 1.5)), rel=TOLERANCE)


@pytest.mark.parametrize("kind", [LightType.POINT, LightType.RECTANGLE])
def test_without_normalize_the_radiance_does_not_depend_on_the_size(kind):
    seen = []
    for size in (0.5, 1.0):
        light = lamp(
            kind,
            (0, 0, 2),
            DOWN,
            power=10.0,
            radius=size,
            size_u=size,
            size_v=size,
            normalize=0,
        )
        with scene_with(light) as scene:
            seen.append(lights_along(scene, (0, 0, 0), [UP])[1][0, 1])
    assert seen == pytest.approx([10 / np.pi] * 2, rel=TOLERANCE)


def test_lamp_colour_comes_out_as_given():
    color = (0.9, 0.4, 0.1)
    with scene_with(lamp(LightType.POINT, (0, 0, 1), power=4 * np.pi, color=color)) as scene:
        e, _ = irradiance(scene, (0, 0, 0), UP, n=16)
    assert e == pytest.approx(np.array(color), rel=5e-3)


@pytest.mark.parametrize("name", sorted(illuminants.LAMPS))
def test_a_lamp_with_a_spectrum_is_as_bright_as_a_white_one_and_has_its_own_colour(name):
    """Also one of narrow lines, in 64 wavelengths: they are sampled where the light is."""
    spectrum = illuminants.lamp(name)
    with scene_with() as scene:
        number = scene.add_spectrum(spectrum * 7.0)
        scene.add_light(lamp(LightType.POINT, (0, 0, 1), power=4 * np.pi, spectrum=number))
        scene.commit()
        e, _ = irradiance(scene, (0, 0, 0), UP, n=16)
    assert WEIGHTS @ e == pytest.approx(1.0, rel=5e-3)
    assert e == pytest.approx(colour.rec709(spectrum), rel=5e-3, abs=0.015)


def test_a_flat_spectrum_is_pinkish():
    """PHYSICS section 5, 16: flat emission is (1.2049, 0.9482, 0.9092)."""
    with scene_with() as scene:
        flat = scene.add_spectrum(np.full(471, 7.0))
        scene.add_light(lamp(LightType.POINT, (0, 0, 1), power=4 * np.pi, spectrum=flat))
        scene.commit()
        e, _ = irradiance(scene, (0, 0, 0), UP, n=16)
    assert e == pytest.approx(np.array([1.2049, 0.9482, 0.9092]), rel=5e-3)


def test_the_colour_of_a_lamp_with_a_spectrum_is_a_filter_before_it():
    """Glass of any colour before a sodium lamp dims it by what the glass keeps at 589 nm."""
    with scene_with() as scene:
        sodium = scene.add_spectrum(illuminants.sodium())
        seen = {}
        for name, tint in {"white": (1, 1, 1), "red": (1, 0, 0), "blue": (0, 0, 1)}.items():
            scene.clear_lights()
            scene.add_light(lamp(LightType.POINT, (0, 0, 1), power=4 * np.pi, spectrum=sodium, color=tint))
            scene.commit()
            seen[name] = irradiance(scene, (0, 0, 0), UP, n=16)[0]
    red, _, blue = uplift.basis()
    assert seen["red"] == pytest.approx(colour.rec709(illuminants.sodium() * red), rel=0.01, abs=1e-3)
    assert seen["blue"] == pytest.approx(colour.rec709(illuminants.sodium() * blue), rel=0.01, abs=1e-3)
    assert WEIGHTS @ seen["red"] < 0.7 * WEIGHTS @ seen["white"]


def test_uniform_world_has_the_radiance_of_its_colour_and_gives_pi_times_it():
    with scene_with(world=emission_program((0.5, 0.25, 1.0), 2.0)) as scene:
        e, _ = irradiance(scene, (0, 0, 0), UP, n=16)
        _, seen, source = lights_along(scene, (0, 0, 0), [[0.6, 0, -0.8]])
    assert e == pytest.approx(np.pi * np.array([1.0, 0.5, 2.0]), rel=5e-3)
    assert seen[0] == pytest.approx(np.array([1.0, 0.5, 2.0]), rel=5e-3)
    assert tuple(source[0]) == (2, 0)


@pytest.mark.parametrize("kind", list(LightType))
def test_a_ray_sees_of_a_lamp_what_sampling_it_returns(kind):
    """Every sampled direction, followed as a ray, meets the lamp at the sampled distance with the sampled radiance."""
    light = lamp(
        kind,
        (0.3, -0.2, 2),
        (0.1, 0.2, -1),
        power=5.0,
        radius=0.3,
        size_u=0.7,
        size_v=0.4,
        spot_angle=1.5,
        spot_blend=0.5,
    )
    with scene_with(light) as scene:
        s = sample_light(scene, receiver((0, 0, 0), UP), numbers(400, 3))
        lit = s["pdf"] > 0
        distance, radiance, _ = lights_along(scene, (0, 0, 0), s["direction"][lit])
    assert lit.mean() > 0.5
    met = radiance[:, 1] > 0
    assert met.mean() > 0.98  # the rim is lost to rounding
    assert radiance[met] == pytest.approx(s["radiance"][lit][met], rel=1e-3, abs=1e-5)
    if kind != LightType.SUN:
        assert distance[met] == pytest.approx(s["distance"][lit][met], rel=1e-3)


@pytest.mark.parametrize("kind", [LightType.RECTANGLE, LightType.SPOT])
def test_lamps_shine_to_one_side(kind):
    with scene_with(lamp(kind, (0, 0, 2), UP, power=5.0, radius=0.3)) as scene:
        assert not np.isfinite(lights_along(scene, (0, 0, 0), [UP])[0][0]) or kind == LightType.SPOT
        assert lights_along(scene, (0, 0, 0), [UP])[1].max() == 0
        assert irradiance(scene, (0, 0, 0), UP, n=64)[0].max() == 0


def test_lamps_hidden_from_a_kind_of_ray_are_not_met_by_it():
    with scene_with(lamp(LightType.ELLIPSE, (0, 0, 2), DOWN, power=5.0, visibility=63 & ~1)) as scene:
        assert lights_along(scene, (0, 0, 0), [UP], ray_kind=1)[1].max() == 0
        assert lights_along(scene, (0, 0, 0), [UP], ray_kind=2)[1].min() > 0


@pytest.mark.parametrize(
    ("program", "by"), [(programs.diffuse((0.5, 0.5, 0.5)), Ray.DIFFUSE), (programs.mirror(roughness=0.5), Ray.GLOSSY)]
)
@pytest.mark.parametrize("kind", [LightType.POINT, LightType.RECTANGLE])
def test_lamps_hidden_from_a_kind_of_ray_do_not_light_what_scatters_by_it(kind, program, by):
    """However wide the lobe: rough gloss sends glossy rays."""

    def seen(visibility):
        with Scene(threads=2) as scene:
            scene.add_instances(scene.add_mesh(*square(1.0)), IDENTITY, [scene.add_material(program)])
            scene.add_light(type=kind, size_u=0.5, size_v=0.5, transform=looking_down(1.0), visibility=visibility)
            scene.set_camera(**orthographic(0.5, looking_down(5.0)))
            scene.commit()
            return picture(scene, 1, 8, samples_per_pass=4, photons_per_pass=0).mean()

    other = Ray.GLOSSY if by == Ray.DIFFUSE else Ray.DIFFUSE
    assert seen(Ray.ALL & ~by) == 0
    assert seen(Ray.ALL & ~other) == seen(Ray.ALL) > 0


def test_light_linking_keeps_a_lamp_from_sets_that_it_does_not_light():
    with scene_with(lamp(LightType.POINT, (0, 0, 2), receivers=0b10)) as scene:
        u = [[0.5, 0.5, 0.5]]
        assert sample_light(scene, receiver((0, 0, 0), UP, light_group=0), u)["pdf"][0] == 0
        assert sample_light(scene, receiver((0, 0, 0), UP, light_group=1), u)["pdf"][0] == 1
        assert sample_light(scene, receiver((0, 0, 0), UP, light_group=-1), u)["pdf"][0] == 1


@pytest.mark.parametrize("broken", [{"scale": (0, 0, 0)}, {"power": 0.0}, {"color": (0, 0, 0)}])
@pytest.mark.parametrize("kind", list(LightType))
def test_lamps_of_no_size_or_power_give_nothing_and_break_nothing(kind, broken):
    scale = broken.get("scale", (1, 1, 1))
    fields = {k: v for k, v in broken.items() if k != "scale"}
    with scene_with(lamp(kind, (0, 0, 2), DOWN, scale, **{"power": 1.0, **fields})) as scene:
        e, _ = irradiance(scene, (0, 0, 0), UP, n=64)
    assert np.isfinite(e).all()
    if not (scale == (0, 0, 0) and kind in (LightType.POINT, LightType.SUN)):
        assert e.max() == 0


def test_world_without_a_program_is_black():
    with scene_with(
        lamp(LightType.POINT, (0, 0, 2)),
        world=World(program=emission_program((0, 0, 0))),
    ) as scene:
        s = sample_light(scene, receiver((0, 0, 0), UP), numbers(32, 3))
    assert (s["source"][:, 0] == 0).all()
