# SPDX-License-Identifier: GPL-3.0-or-later
"""Image metrics against their closed forms."""

import numpy as np
import pytest
from opal_kernels import metrics


def noise(shape=(32, 32, 3), seed=0):
    return np.random.default_rng(seed).uniform(0.2, 0.8, shape)


def test_a_picture_is_equal_to_itself():
    picture = noise()
    assert metrics.relative_mse(picture, picture) == 0
    assert metrics.psnr(picture, picture) == float("inf")
    assert metrics.ssim(picture, picture) == pytest.approx(1.0)
    assert metrics.mean_ratio(picture, picture) == pytest.approx([1, 1, 1])


def test_relative_mse_and_ratio_of_a_uniform_change():
    a, b = np.full((4, 5, 3), 1.1), np.full((4, 5, 3), 1.0)
    assert metrics.relative_mse(a, b) == pytest.approx(0.01 / 1.01)
    assert metrics.mean_ratio(a, b) == pytest.approx([1.1] * 3)
    assert metrics.mean_ratio(a, np.zeros_like(b)) == [None] * 3


def test_psnr_of_white_against_black_is_zero_decibel():
    assert metrics.psnr(np.ones((4, 4, 3)), np.zeros((4, 4, 3))) == pytest.approx(0, abs=1e-12)


def test_ssim_falls_with_structure_and_not_with_a_little_brightness():
    picture = noise((48, 48, 3))
    assert metrics.ssim(picture * 1.02, picture) > 0.99
    assert metrics.ssim(noise((48, 48, 3), seed=1), picture) < 0.2


def test_flip_takes_the_pictures_as_linear_and_falls_with_likeness():
    """The package's own conversion of encoded pictures says the same of the encodings of ours."""
    flip_evaluator = pytest.importorskip("flip_evaluator")
    picture = noise((48, 48, 3))
    worse = np.clip(picture + np.random.default_rng(3).normal(0, 0.1, picture.shape), 0, 1)
    encoded = [metrics.srgb(p).astype(np.float32) for p in (picture, worse)]
    assert metrics.flip(picture, picture) == 0
    assert metrics.flip(worse, picture) == pytest.approx(flip_evaluator.evaluate(*encoded, "LDR", inputsRGB=True)[1], rel=1e-4)
    assert 0 < metrics.flip((picture + worse) / 2, picture) < metrics.flip(worse, picture) < 1


def test_regions_find_the_one_that_differs_and_how_sure_that_is():
    """A uniform change of 10 % in one of four regions among noise of 20 % a pixel: found at 8 standard errors."""
    reference = np.full((64, 64, 3), 0.5)
    picture = reference + np.random.default_rng(2).normal(0, 0.1, (64, 64, 3))
    picture[32:, 32:] *= 1.1
    found = metrics.regions(picture, reference, 2, 2)
    assert [r["box"] for r in found] == [[0, 0, 32, 32], [32, 0, 64, 32], [0, 32, 32, 64], [32, 32, 64, 64]]
    for region in found[:3]:
        assert abs(region["ratio"] - 1) < 4 * region["error"]
    assert found[3]["ratio"] - 1 > 8 * found[3]["error"]


def test_pictures_of_different_sizes_are_refused():
    with pytest.raises(ValueError, match="5 x 4 and 6 x 4"):
        metrics.psnr(np.zeros((4, 5, 3)), np.zeros((4, 6, 3)))
