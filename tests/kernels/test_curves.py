# SPDX-License-Identifier: GPL-3.0-or-later
"""Absorption curves from text: what is read, and what is refused with its line."""

import numpy as np
import pytest
from opal_kernels import curves, gem


def settings(curve=None, **fields):
    return gem.Settings("CAUCHY", (1.5, 0.0), (0, 0, 0), (0, 0, 0), absorption_curve=curve, **fields)


@pytest.mark.parametrize(
    "text",
    [
        "400,0.5\n500,0.25\n600,0\n",
        "wavelength nm, absorption 1/mm\n600,0\n400,0.5\n500,0.25",
        "# measured on a plate\n\n400; 0.5\n500 ; 0.25 # peak\n600;0\n",
        "\ufeffnm\tper mm\r\n400\t5e-1\r\n500\t.25\r\n600\t0\r\n",
        "400 0.5\n500, 0.25\n600 ,0\n",
        "Wellenlänge;Absorption\nnm;1/mm\n400;0,5\n500,0;0,25\n600;0\n",
        "wavelength\tabsorption\n400\t0,5\n500\t0,25\n6,00e2\t0\n",
    ],
)
def test_a_curve_is_read_whatever_parts_its_columns(text):
    nm, value, ignored = curves.parse(text)
    assert nm.tolist() == [400, 500, 600] and value.tolist() == [0.5, 0.25, 0] and ignored == 0


def test_further_columns_are_counted():
    assert curves.parse("400,0.5\n500,0.25,1,2\n").ignored_columns == 2
    assert curves.parse("400;0,5;0,01\n").ignored_columns == 1


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "holds no samples"),
        ("nm,per mm\n", "holds no samples"),
        ("nm,per mm\n400,0.5\n500\n", "Line 3: two numbers"),
        ("400,0.5\n500,dark\n", "Line 2: “dark” is not a number"),
        ("400,0.5\n500,-0.1\n", "Line 2: an absorption cannot be negative"),
        ("400,0.5\n500,nan\n", "Line 2: an absorption has to be finite"),
        ("400,0.5\n-500,0.1\n", "Line 2: a wavelength has to be above 0"),
        ("400,0.5\n\n400,0.6\n", "Line 3: the wavelength 400 nm stands there a second time"),
        ("0.4,0.5\n0.7,0.2\n", "have to be in nm"),
        ("400 0.5\n400,5 0,3\n", "Line 2: a comma may part columns or stand for a decimal point here"),
        ("nm 1/mm\n400 0,3\n", "Line 2: a comma may part columns"),
        ("400,0.3;0.5\n500;0\n", "Line 1: “400.0.3” is not a number"),
        ("400;0,5\n500,1;0.3,5\n", "Line 2: “0.3.5” is not a number"),
        ("one\ntwo\nthree\n400,0.5\n", "Line 3"),
    ],
)
def test_a_bad_curve_is_refused_with_its_line(text, sentence):
    with pytest.raises(curves.CurveError, match=sentence):
        curves.parse(text)


def test_a_curve_absorbs_as_measured_and_its_ends_hold_outside():
    sigma = gem.absorption(settings([(400.0, 0.5), (600.0, 0.1)]))
    nm = np.arange(360, 831)
    assert sigma[nm == 500] == pytest.approx(1e3 * 0.3)
    assert sigma[nm < 400] == pytest.approx(500.0) and sigma[nm > 600] == pytest.approx(100.0)


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"curve": []}, "is empty"),
        ({"curve": [(500.0, -1.0)]}, "cannot be negative"),
        ({"absorption_color": (1.2, 0.5, 0.5)}, "negative absorption"),
        ({"absorption_color": (float("nan"), 0.5, 0.5)}, "finite"),
        ({"absorption_depth": -0.001}, "above 0"),
    ],
)
def test_absorption_that_cannot_be_is_refused_with_a_sentence(values, sentence):
    assert sentence in gem.absorption_refusal(settings(**values))


def test_a_species_fills_a_curve_that_is_its_own_absorption():
    from opal_kernels.optics import species

    filled = gem.settings_of_species("RUBY")
    assert gem.absorption(filled) == pytest.approx(species.absorption("RUBY", np.arange(360.0, 831.0)))
    assert gem.settings_of_species("DIAMOND").absorption_curve is None
