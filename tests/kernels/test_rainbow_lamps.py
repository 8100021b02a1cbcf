# SPDX-License-Identifier: GPL-3.0-or-later
"""Bows near lamps: not circles of 42 degrees, but where the angle between lamp, drop and eye is the bow's.

The drops hang in a thin curtain 2 m away, as from a garden hose. For each of its places P the scattering angle is that between P - lamp
and eye - P; the bow is rendered where that is the caustic's. A narrow peak of the phase function stands for the bow, so that places are
known to fractions of a pixel.
"""

import numpy as np
import pytest
from opal_kernels.descriptions import Light, LightType, MaterialFlag, Phase, PhaseKind
from opal_kernels.optics.rainbow import geometric, water
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box

F, HALF = 200.0, 260  # pixels
AWAY, THICK = 2.0, 0.001
NM = 550
LAMPS = {
    "overhead": (0.0, 2.0, -0.6),
    "aside and behind": (3.0, 1.0, 1.5),
    "between eye and drops": (0.3, 0.4, -1.5),
}
RADIUS = float(geometric.bow_radius(water.index(float(NM)), 1))


def light(kind, lamp):
    """A lamp of this kind at a place, looking at the curtain's middle."""
    lamp = np.asarray(lamp)
    back = lamp - [0.0, 0.0, -AWAY]
    back /= np.linalg.norm(back)
    right = np.cross([0.0, 1.0, 0.0], back)
    right /= np.linalg.norm(right)
    fields = {"type": kind, "power": 1000.0, "transform": np.column_stack([right, np.cross(back, right), back, lamp])}
    if kind == LightType.SPOT:
        fields |= {"spot_angle": 3.0, "spot_blend": 0.2}
    if kind == LightType.RECTANGLE:
        fields |= {"size_u": 0.02, "size_v": 0.02}
    return Light(**fields)


def scattering_angle(x, y, lamp):
    """At the curtain's place seen in pixel coordinates (x, y) from the middle."""
    place = np.stack(np.broadcast_arrays(x * AWAY / F, y * AWAY / F, -AWAY), axis=-1)
    from_lamp = place - lamp
    cosine = -(from_lamp * place).sum(-1) / np.linalg.norm(from_lamp, axis=-1) / np.linalg.norm(place, axis=-1)
    return np.arccos(np.clip(cosine, -1, 1))


def row(kind, lamp, y, passes=2):
    """Luminance along the row of pixels whose middle lies y above the picture's."""
    angles = np.radians(np.linspace(0, 180, 18001))
    values = 1e-3 + np.exp(-0.5 * ((angles - (np.pi - RADIUS)) / np.radians(0.1)) ** 2)
    phase = Phase(kind=PhaseKind.TABLE, wavelengths=[380.0, 780.0], angles=angles, values=np.array([values, values]))
    with Scene(threads=2) as scene:
        curtain = box((-20, -20, -AWAY - THICK / 2), (20, 20, -AWAY + THICK / 2))
        material = scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=scene.add_medium(1.0, 1.0, phase))
        scene.add_instances(scene.add_mesh(*curtain), IDENTITY, [material])
        scene.add_light(light(kind, lamp))
        scene.set_camera(transform=np.eye(4)[:3], window=(-HALF / F, HALF / F, (y - 0.5) / F, (y + 0.5) / F))
        scene.commit()
        settings = {"width": 2 * HALF, "height": 1, "samples_per_pass": 64, "photons_per_pass": 0, "max_depth": 1}
        settings |= {"filter": 0, "filter_width": 1.0, "wavelength_first": NM - 0.5, "wavelength_last": NM + 0.5}
        with Render(scene, **settings) as render:
            return render.run(passes).film("COMBINED")[0, :, 1].astype(float)


@pytest.mark.parametrize("place", LAMPS)
@pytest.mark.parametrize("kind", [LightType.POINT, LightType.SPOT, LightType.RECTANGLE])
def test_a_bow_near_a_lamp_stands_where_geometry_has_it(kind, place):
    lamp = np.array(LAMPS[place])
    x = np.arange(-HALF, HALF) + 0.5
    fine = np.arange(-HALF, HALF, 0.01)
    found = 0
    for y in (-60.0, 40.0):
        angle = scattering_angle(fine, y, lamp) - (np.pi - RADIUS)
        crossings = fine[1:][angle[1:] * angle[:-1] < 0]
        if not crossings.size:
            continue
        seen = row(kind, lamp, y)
        for where in crossings:
            near = np.abs(x - where) < 8
            if near.sum() < 15:
                continue
            # The curtain's brightness changes across the peak as the lamp's distance does: little within its width of a pixel.
            power = seen[near] - np.median(seen[near])
            power[power < 0.1 * power.max()] = 0
            assert power.max() > 5 * np.median(seen), "a bow"
            assert (power * x[near]).sum() / power.sum() == pytest.approx(where, abs=0.5)
            found += 1
    assert found >= 2


def test_near_a_lamp_the_bow_is_no_circle_of_42_degrees():
    """About the point that the lamp's shadow of the eye falls on, it is wider by many degrees, and not by the same everywhere."""
    lamp = np.array(LAMPS["aside and behind"])
    shadow = -lamp / lamp[2] * AWAY  # from the lamp through the eye on to the curtain
    radii = []
    for turn in np.linspace(0, 2 * np.pi, 36, endpoint=False):
        reach = np.linspace(0.1, 40, 40_000)
        place = shadow[:2, None] + reach * np.array([[np.cos(turn)], [np.sin(turn)]])
        angle = scattering_angle(place[0] * F / AWAY, place[1] * F / AWAY, lamp) - (np.pi - RADIUS)
        crossing = np.flatnonzero(angle[1:] * angle[:-1] < 0)
        if crossing.size:
            seen = np.array([*place[:, crossing[0]], -AWAY])
            radii.append(np.degrees(np.arccos(seen @ shadow / np.linalg.norm(seen) / np.linalg.norm(shadow))))
    assert len(radii) > 5
    assert max(radii) - min(radii) > 5 and min(radii) > np.degrees(RADIUS) + 10
