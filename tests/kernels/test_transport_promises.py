# SPDX-License-Identifier: GPL-3.0-or-later
"""What a render promises whatever it draws: the same bits on any number of threads and in any order of passes, and a quick end when asked."""

import threading
import time

import numpy as np
import pytest
from opal_kernels.binding import Cancelled
from opal_kernels.descriptions import Carry
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from test_transport_modes import glass_ball_room

SETTINGS = {"width": 40, "height": 30, "samples_per_pass": 3, "photons_per_pass": 20_000, "seed": 7}


@pytest.fixture(scope="module")
def scene():
    with Scene(threads=3) as scene:
        glass_ball_room(scene)
        yield scene


@pytest.mark.parametrize("carry", list(Carry))
def test_same_bits_on_any_number_of_threads(scene, carry):
    films = []
    for threads in (1, 2, 3):
        with Render(scene, threads=threads, photons_carry=carry, **SETTINGS) as render:
            films.append(render.run(3).film("COMBINED"))
    assert np.isfinite(films[0]).all() and films[0].max() > 0
    for threads, film in zip((2, 3), films[1:], strict=True):
        assert np.array_equal(films[0], film), f"{threads} threads: {np.count_nonzero(films[0] != film)} numbers differ"


def test_order_of_passes_does_not_matter(scene):
    films = []
    for order in ((0, 1, 2, 3), (3, 1, 0, 2)):
        with Render(scene, **SETTINGS) as render:
            for number in order:
                render.run_pass(number)
            films.append(render.film("COMBINED"))
    assert films[0] == pytest.approx(films[1], rel=1e-5, abs=1e-6)


def test_another_seed_is_another_render(scene):
    settings = {k: v for k, v in SETTINGS.items() if k != "seed"}
    films = []
    for seed in (1, 2):
        with Render(scene, seed=seed, **settings) as render:
            films.append(render.run(1).film("COMBINED"))
    assert np.mean(films[0] != films[1]) > 0.5


@pytest.mark.parametrize("after", [0.05, 0.5])
def test_cancelled_render_ends_within_a_third_of_a_second(scene, after):
    """In the photons' part (early) and in the camera's; nothing unfinished is in the film."""
    settings = {"width": 512, "height": 512, "samples_per_pass": 64, "photons_per_pass": 3_000_000}
    with Render(scene, **settings) as render:
        asked = []

        def ask():
            time.sleep(after)
            asked.append(time.perf_counter())
            render.cancel()

        waiter = threading.Thread(target=ask)
        waiter.start()
        with pytest.raises(Cancelled):
            render.run_pass(0)
        ended = time.perf_counter()
        waiter.join()
        assert ended - asked[0] < 0.3, f"it took {ended - asked[0]:.2f} s"
        assert render.passes_done == 0
        assert not render.film("COMBINED").any(), "an unfinished pass is in the film"
