# SPDX-License-Identifier: GPL-3.0-or-later
"""Bows in rendered pixels: a pinhole looks at the antisolar point through a slab of drops, f = 1000 pixels (PHYSICS §5.13).

Pixels of one row, 1000 tan(radius) from the centre. Single scattering dominates: the slab's depth is a hundredth of a mean free path.
"""

from pathlib import Path

import numpy as np
import pytest
from opal_kernels import droplets
from opal_kernels.descriptions import Light, LightType, MaterialFlag, Phase, PhaseKind
from opal_kernels.droplets import Drops
from opal_kernels.optics import colour, rainbow
from opal_kernels.optics.rainbow import drop_shapes, droplet, geometric, sun, water
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import box

REFERENCE = Path(__file__).resolve().parents[1] / "reference_data"
F = 1000.0  # pixels
STRENGTH = 1000.0
SIGMA = 1e-4
DEPTH = 100.0


def row_of_bow(phase, nm, first, last, angle=0.0, passes=4, samples=64, rows=1, camera=None, turn=None):
    """Radiance per pixel (rows, n, 3) of columns `first` to `last` right of the antisolar point; the sun stands behind along +Z."""
    half_width = int(last) + 8
    with Scene(threads=2) as scene:
        medium = scene.add_medium(SIGMA, 1.0, phase)
        wide = 40 * DEPTH
        corners, faces = box((-wide, -wide, -DEPTH - 1.0), (wide, wide, -1.0))
        material = scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=medium)
        turn = np.eye(4) if turn is None else turn
        scene.add_instances(scene.add_mesh(corners, faces), [turn], [material])
        light = {"type": LightType.SUN, "power": STRENGTH, "radius": angle, "transform": turn[:3]}
        scene.add_light(Light(**light))
        scene.set_camera(
            transform=turn[:3],
            window=(-half_width / F, half_width / F, -rows / 2 / F, rows / 2 / F),
            **(camera or {}),
        )
        scene.commit()
        settings = {
            "width": 2 * half_width,
            "height": rows,
            "region": (half_width + int(first), 0, half_width + int(last), rows),
            "samples_per_pass": samples,
            "photons_per_pass": 0,
            "max_depth": 2,
            "filter": 0,
            "filter_width": 1.0,
        }
        if nm is not None:
            settings |= {"wavelength_first": nm - 0.5, "wavelength_last": nm + 0.5}
        with Render(scene, **settings) as render:
            return render.run(passes).film("COMBINED")[..., :3].astype(np.float64)


def centres(first, last):
    return np.arange(int(first), int(last)) + 0.5


def table_phase(drops):
    return droplets.phase(drops)


@pytest.mark.parametrize(("nm", "k", "expected"), [(450, 1, 874.83), (550, 1, 896.86), (650, 1, 910.76), (450, 2, None), (650, 2, None)])
def test_the_caustic_is_rendered_at_its_pixel(nm, k, expected):
    """A narrow peak of the phase function at Descartes' angle comes out at F tan(radius), within 0.3 pixels."""
    radius = float(geometric.bow_radius(water.index(float(nm)), k))
    where = F * np.tan(radius)
    if expected is not None:
        assert where == pytest.approx(expected, abs=0.02)
    angles = np.radians(np.linspace(0, 180, 18001))
    values = 1e-3 + np.exp(-0.5 * ((angles - (np.pi - radius)) / np.radians(0.05)) ** 2)
    phase = Phase(kind=PhaseKind.TABLE, wavelengths=[380.0, 780.0], angles=angles, values=np.array([values, values]))
    first, last = int(where) - 12, int(where) + 13
    seen = row_of_bow(phase, nm, first, last, passes=2)[0].sum(axis=1)
    light = seen - seen.min()
    assert (light * centres(first, last)).sum() / light.sum() == pytest.approx(where, abs=0.3)


@pytest.mark.parametrize("theory", ["AIRY", "MIE"])
def test_the_bow_under_the_sun_peaks_at_41_4_degrees(theory):
    """a = 250 um, 550 nm, the sun's disc: 41.43 degrees (Mie), 41.41 (Airy), within 0.03; the disc is sampled, not in the table."""
    drops = Drops(theory, 250.0, spread=0.05)
    angles = drops.angles()
    near = (angles > np.radians(130)) & (angles < np.radians(146))
    angles = np.concatenate([[0.0, 1.0], angles[near], [np.pi]])
    p = rainbow.phase_function(theory, 250.0, [550.0], angles, 0.05, sizes=24, diffraction=False).mean(axis=0)
    phase = Phase(kind=PhaseKind.TABLE, wavelengths=[550.0], angles=angles, values=p)
    first, last = 820, 930
    seen = row_of_bow(phase, 550, first, last, angle=sun.MEAN_RADIUS_RAD, passes=8, samples=128)[0].sum(axis=1)
    radius = np.degrees(np.arctan(centres(first, last) / F))
    near = np.abs(radius - radius[seen.argmax()]) < 0.3
    a, b, c = np.polynomial.polynomial.polyfit(radius[near] - 41.4, seen[near], 2)
    assert 41.4 - b / (2 * c) == pytest.approx({"MIE": 41.43, "AIRY": 41.41}[theory], abs=0.03)


@pytest.mark.parametrize("k", [1, 2])
@pytest.mark.parametrize("nm", [450, 550, 650])
def test_the_line_of_descartes_is_rendered_at_its_radius(nm, k):
    """The real table of rays, under a point sun: its line's middle within 0.03 degrees of the sheet's radius, half a pixel."""
    drops = Drops("DESCARTES", 500.0, spread=0.0)
    expected = float(np.degrees(geometric.bow_radius(water.index(float(nm)), k)))
    middle = F * np.tan(np.radians(expected))
    first, last = int(middle) - 14, int(middle) + 15
    seen = row_of_bow(table_phase(drops), nm, first, last, passes=4)[0].sum(axis=1)
    radius = np.degrees(np.arctan(centres(first, last) / F))
    line = np.clip(seen - np.median(seen), 0, None)
    assert (line * radius).sum() / line.sum() == pytest.approx(expected, abs=0.03)


@pytest.mark.parametrize("k", [1, 2])
@pytest.mark.parametrize("nm", [450, 550, 650])
def test_airys_main_maximum_is_rendered_at_its_radius(nm, k):
    """Drops of one size, 250 um, under a point sun: the theory's own maximum within 0.02 degrees, a third of a pixel, and the sheet's within 0.02 in the
    primary. The secondary's stands 0.04 nearer to its caustic than the cubic wavefront's: led to the strength of its rays (`airy.ray_ratio`), it falls off."""
    rows = np.genfromtxt(REFERENCE / "airy_supernumeraries.csv", delimiter=",", names=True)
    row = next(r for r in rows if r["radius_um"] == 250 and r["lambda_nm"] == nm and r["k"] == k)
    middle = F * np.tan(np.radians(row["max1_radius_deg"]))
    first, last = int(middle) - 24, int(middle) + 25
    seen = row_of_bow(table_phase(Drops("AIRY", 250.0, spread=0.0)), nm, first, last, passes=8, samples=128)[0].sum(axis=1)
    radius = np.degrees(np.arctan(centres(first, last) / F))
    near = seen > 0.7 * seen.max()
    curve = np.polynomial.Polynomial.fit(radius[near], seen[near], 4)  # the maximum is steeper on its dark side
    fine = np.linspace(radius[near][0], radius[near][-1], 2001)
    top = fine[curve(fine).argmax()]
    theory = rainbow.phase_function("AIRY", 250.0, [float(nm)], np.radians(180 - fine)).mean(axis=(0, 1))
    assert top == pytest.approx(fine[theory.argmax()], abs=0.02)
    assert top == pytest.approx(row["max1_radius_deg"] - {1: 0.0, 2: 0.04}[k], abs=0.02)


def test_colours_are_those_of_the_table_in_closed_form():
    """Every pixel is E sigma p(theta, lambda) over the slab's path, integrated against the observer: 2 per cent of the peak."""
    drops = Drops("AIRY", 250.0)
    phase = droplets.phase(drops)
    first, last = 780, 930
    seen = row_of_bow(phase, None, first, last, passes=24, samples=64)[0]
    radius = np.arctan(centres(first, last) / F)
    p = np.array([np.interp(radius[::-1], np.pi - drops.angles()[::-1], row[::-1])[::-1] for row in phase.values])
    fine = np.array([np.interp(colour.WAVELENGTHS_NM, drops.wavelengths(), column) for column in p.T])
    path = DEPTH / np.cos(radius)  # attenuation: there and back again is a few per cent
    depth = SIGMA * (1.0 + 1 / np.cos(radius))
    length = (1 - np.exp(-depth * DEPTH)) / depth / np.cos(radius)
    assert (length < path).all()
    expected = STRENGTH * SIGMA * length[:, None] * colour.rec709(colour.white() * fine)
    error = np.abs(seen - expected).max() / expected.max()
    assert error < 0.03, error
    assert np.abs(seen - expected).mean() / expected.max() < 0.008
    red, blue = seen[:, 0].argmax(), seen[:, 2].argmax()
    assert red > blue, "red is outside"


@pytest.mark.parametrize(("k", "span"), [(1, (836, 905)), (2, (1235, 1300))])
def test_a_polarising_filter_takes_the_bow_away(k, span):
    """Beside the antisolar point the field is vertical: a filter at 90 degrees passes it and one at 0 takes it."""
    drops = Drops("AIRY", 250.0)
    phase = droplets.phase(drops)
    open_, passed, taken = (
        row_of_bow(phase, 550, *span, camera=camera, passes=4)[0].sum()
        for camera in (None, {"polarizer": 1, "polarizer_angle": np.pi / 2}, {"polarizer": 1, "polarizer_angle": 0.0})
    )
    both = phase.values[17], phase.polarization[17]
    inside = slice(*np.searchsorted(drops.angles(), np.pi - np.arctan(np.array(span[::-1]) / F)))
    degree = (both[0] * both[1])[inside].sum() / both[0][inside].sum()
    assert (passed - taken) / (passed + taken) == pytest.approx(degree, abs=0.02)
    assert passed + taken == pytest.approx(open_, rel=0.02)
    assert degree > {1: 0.8, 2: 0.6}[k]


def test_flattened_drops_lower_the_bows_top_and_leave_its_feet():
    """Large drops under a sun of 20 degrees: at the top the bow moves by the traced drop's own shift, at the feet it stays."""
    elevation = np.radians(20.0)
    clocks = np.linspace(0, np.pi, 9)
    angles = np.radians(np.linspace(0, 180, 3601))
    centre = [np.pi - droplet.fold(1.333, 1, drop_shapes.Spheroid(0.975), elevation, float(c)).angle for c in clocks]
    values = np.array([[[1e-4 + np.exp(-0.5 * ((np.pi - angles - r) / np.radians(0.3)) ** 2)] for r in centre]])
    phase = Phase(kind=PhaseKind.TABLE, wavelengths=[550.0], angles=angles, values=values, elevations=[elevation], clocks=clocks)
    # The camera's -Z is the antisolar direction of a sun 20 degrees high; its X turned so that the row runs towards the bow's clock.
    for clock, index in ((0.0, 0), (np.pi / 2, 4)):
        toward_sun = np.array([0, -np.cos(elevation), np.sin(elevation)])
        up = np.array([0, np.sin(elevation), np.cos(elevation)])
        side = np.cross(up, toward_sun)
        x = np.cos(clock) * up + np.sin(clock) * side
        turn = np.eye(4)
        turn[:3, :3] = np.column_stack([x, np.cross(toward_sun, x), toward_sun])
        where = F * np.tan(centre[index])
        first, last = int(where) - 40, int(where) + 41
        seen = row_of_bow(phase, 550, first, last, passes=4, turn=turn)[0].sum(axis=1)
        light = seen - seen.min()
        assert (light * centres(first, last)).sum() / light.sum() == pytest.approx(where, abs=1.5)
    assert np.degrees(float(geometric.bow_radius(1.333, 1)) - centre[0]) == pytest.approx(3.38, abs=0.02)


def test_rendered_colours_are_those_of_the_reference():
    """Both bows of drops of 50 µm under an equal-energy sun, radius 35 to 57 degrees: XYZ per pixel within 4 % of the brightest, 1 % rms.

    The reference keeps the diffraction lobe; without it all the rest is double.
    """
    reference = np.load(REFERENCE / "rainbow_xyz.npz")
    nm = np.arange(380.0, 781, 20)
    angles = np.radians(np.concatenate([np.arange(0.0, 120, 0.5), np.arange(120.0, 180.01, 0.05)]))
    angles[-1] = np.pi
    p = rainbow.phase_function("MIE", 50.0, nm, angles, spread=0.05, sizes=24, diffraction=False).mean(axis=0)
    phase = Phase(kind=PhaseKind.TABLE, wavelengths=nm, angles=angles, values=p)
    scale, first, last = 0.4, 281, 615
    flat = np.ones(471)
    with Scene(threads=2) as scene:
        medium = scene.add_medium(SIGMA, 1.0, phase)
        wide = 40 * DEPTH
        material = scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=medium)
        scene.add_instances(scene.add_mesh(*box((-wide, -wide, -DEPTH - 1.0), (wide, wide, -1.0))), [np.eye(4)], [material])
        spectrum = scene.add_spectrum(flat)
        scene.add_light(Light(type=LightType.SUN, power=STRENGTH, radius=sun.MEAN_RADIUS_RAD, spectrum=spectrum))
        half = last / (F * scale)
        scene.set_camera(transform=np.eye(4)[:3], window=(-half, half, -0.5 / (F * scale), 0.5 / (F * scale)))
        scene.commit()
        settings = {"width": 2 * last, "height": 1, "region": (last + first, 0, 2 * last, 1), "samples_per_pass": 64}
        settings |= {"photons_per_pass": 0, "max_depth": 2, "filter": 0, "filter_width": 1.0}
        with Render(scene, **settings) as render:
            rgb = render.run(24).film("COMBINED")[0, :, :3].astype(np.float64)
    xyz = rgb @ np.linalg.inv(colour.rec709_from_xyz()).T
    radius = np.arctan((np.arange(first, last) + 0.5) / (F * scale))
    depth = SIGMA * (1.0 + 1 / np.cos(radius))
    length = (1 - np.exp(-depth * DEPTH)) / depth / np.cos(radius)
    seen = xyz / (STRENGTH * SIGMA * length)[:, None]
    expected = 2 * np.array([np.interp(np.degrees(radius), reference["radius_deg"], column) for column in reference["mie_50"].T]).T
    error = np.abs(seen - expected) / expected.max(axis=0)
    assert error.max() < 0.04 and np.sqrt((error**2).mean()) < 0.01, (error.max(), np.sqrt((error**2).mean()))
