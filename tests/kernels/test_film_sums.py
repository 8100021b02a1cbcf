# SPDX-License-Identifier: GPL-3.0-or-later
"""Films saved and merged: parts of a render add up to the bits of the whole."""

import numpy as np
import pytest
from opal_kernels import film_sums, programs
from opal_kernels.binding import OpalError
from opal_kernels.descriptions import Pass, World
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, looking_down, perspective, placed, sphere, square

KEPT = (Pass.DEPTH, Pass.CAUSTICS, Pass.LAYER_GEMS, Pass.SPECTRAL)


@pytest.fixture(scope="module")
def scene():
    with Scene(threads=2) as scene:
        floor = scene.add_material(programs.diffuse((0.8, 0.5, 0.3)))
        scene.add_instances(scene.add_mesh(*square(6.0)), IDENTITY, [floor])
        corners, faces, normals = sphere(0.5)
        stone = scene.add_gem(np.full(471, 1.5))
        scene.add_instances(scene.add_mesh(corners, faces, corner_normals=normals), [placed(z=0.8)], [stone])
        scene.set_world(World(programs.emission(strength=1.0)))
        scene.set_camera(**perspective(0.6, looking_down(6.0)))
        scene.commit()
        yield scene


def sums(scene, numbers, **settings):
    kept = {"passes": KEPT, "spectral_bins": 5, "photons_per_pass": 2000, **settings}
    with Render(scene, width=16, height=12, **kept) as render:
        for number in numbers:
            render.run_pass(number)
        return render.sums(), {p: render.film(p) for p in (Pass.COMBINED, *kept["passes"])}


def test_merged_passes_are_the_whole_render_bit_for_bit(scene, tmp_path):
    whole, pictures = sums(scene, range(16))
    for name, numbers in (("b", range(15, 7, -1)), ("a", range(8))):
        sums(scene, numbers)[0].save(tmp_path / name)
    merged = film_sums.merge([film_sums.load(tmp_path / name) for name in ("b", "a")])
    assert sorted(merged.passes) == list(range(16))
    for number, picture in pictures.items():
        np.testing.assert_array_equal(merged.picture(number), picture, err_msg=number.name)
        np.testing.assert_array_equal(merged.sums[number], whole.sums[number], err_msg=number.name)
    np.testing.assert_array_equal(merged.squares, whole.squares)


def test_a_pass_counts_once(scene):
    part = sums(scene, range(2))[0]
    with pytest.raises(OpalError, match="Pass 1 is in more than one"):
        film_sums.merge([part, part])


def test_films_of_other_renders_are_refused_by_what_differs(scene):
    a, b = sums(scene, [0])[0], sums(scene, [1])[0]
    a.info, b.info = {"seed": 0}, {"seed": 1}
    with pytest.raises(OpalError, match="seed is 0 in one and 1"):
        film_sums.merge([a, b])
    c = sums(scene, [1], passes=(Pass.DEPTH,), spectral_bins=0)[0]
    with pytest.raises(OpalError, match="differ in size or in the passes"):
        film_sums.merge([a, c])


def test_what_is_no_film_is_refused_by_name(tmp_path):
    with pytest.raises(OpalError, match="There is no film .*nowhere"):
        film_sums.load(tmp_path / "nowhere")
    damaged = tmp_path / "damaged"
    damaged.write_bytes(b"PK\x03\x04 but not a film")
    with pytest.raises(OpalError, match="damaged is not a film"):
        film_sums.load(damaged)
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    with pytest.raises(OpalError, match="cannot be written"):
        film_sums.FilmSums((0,), -1, {}, np.zeros(1)).save(blocked / "film")
