# SPDX-License-Identifier: GPL-3.0-or-later
"""`light.opal.spectrum` from the property to the picture."""

import math

import bpy
import numpy as np
import pytest
import stage
from opal_kernels.optics import colour, illuminants

SPECTRA = {name: illuminants.lamp(name) for name in ("D65", "A", "F2", "F11", "LED", "SODIUM")} | {
    "BLACKBODY": illuminants.blackbody(2800.0),
    "LASER": illuminants.line(532.0),
}


def lit_floor(**settings):
    """A floor of albedo ½ seen from above under a sun that makes it white at strength 1."""
    scene = stage.scene(8, 8, passes=4, samples=16)
    scene.render.film_transparent = False
    stage.plane(size=4.0, material=stage.matte())
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy, sun.angle = 2 * math.pi, 0.0
    for key, value in settings.items():
        setattr(sun.opal, key, value)
    stage.link("Sun", sun, (0, 0, 3))
    stage.camera((0, 0, 2))
    return scene, sun


@pytest.mark.parametrize("name", SPECTRA)
def test_a_lamp_of_each_spectrum_has_the_colour_that_the_observer_sees_and_the_brightness_of_a_white_one(opal, tmp_path, name):
    lit_floor(spectrum=name)
    seen = stage.render(tmp_path)[..., :3].mean(axis=(0, 1))
    # Four passes of 64 stratified wavelengths each.
    assert seen == pytest.approx(colour.rec709(SPECTRA[name]), rel=0.015, abs=0.015)


def test_a_spectrum_takes_the_place_of_the_temperature_and_the_color_filters_it(opal, tmp_path):
    _, sun = lit_floor(spectrum="D65")
    sun.use_temperature, sun.temperature = True, 2000.0
    sun.color = (1.0, 0.5, 0.25)
    seen = stage.render(tmp_path)[..., :3].mean(axis=(0, 1))
    assert seen == pytest.approx([1.0, 0.5, 0.25], rel=0.01)


def test_the_settings_of_a_spectrum_can_be_animated(opal, tmp_path):
    scene, sun = lit_floor(spectrum="LASER")
    sun.opal.laser_wavelength = 460.0
    sun.opal.keyframe_insert("laser_wavelength", frame=1)
    sun.opal.laser_wavelength = 640.0
    sun.opal.keyframe_insert("laser_wavelength", frame=2)
    hues = []
    for frame in (1, 2):
        scene.frame_set(frame)
        hues.append(int(np.argmax(stage.render(tmp_path)[..., :3].mean(axis=(0, 1)))))
    assert hues == [2, 0], "blue on the first frame, red on the second"


def test_a_wavelength_that_no_eye_sees_is_not_taken(opal):
    _, sun = lit_floor(spectrum="LASER")
    sun.opal.laser_wavelength = 200.0
    assert sun.opal.laser_wavelength == 380.0


def test_a_laser_outside_of_the_rendered_wavelengths_is_named(opal, tmp_path):
    scene, _ = lit_floor(spectrum="LASER")
    scene.opal.wavelengths = (600.0, 700.0)
    assert stage.render(tmp_path)[..., :3].max() < 1e-3
    assert any("Sun" in line and "532" in line for line in stage.problems())
