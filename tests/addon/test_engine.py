# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine as a good citizen: it is registered, renders, ends when told, writes what it promises."""

import threading
import time
from types import SimpleNamespace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


def busy_scene(passes=2000):
    """A scene whose whole render takes minutes."""
    scene = stage.scene(width=64, height=48, passes=passes)
    stage.camera((0, 0, 5))
    stage.world()
    stage.plane(size=20, material=stage.matte())
    return scene


def test_the_engine_is_listed_by_its_public_name():
    assert "OPAL" in {item.identifier for item in bpy.types.RenderSettings.bl_rna.properties["engine"].enum_items} or (
        bpy.types.RenderEngine.bl_rna_get_subclass_py("OPAL") is not None
    )


def test_the_same_seed_gives_the_same_bits_on_any_number_of_threads(tmp_path):
    scene = busy_scene(passes=2)
    scene.opal.photons_per_pass = 2000
    pictures = []
    scene.render.threads_mode = "FIXED"
    for threads in (1, 2, 3):
        scene.render.threads = threads
        pictures.append(stage.render(tmp_path))
    assert pictures[0][..., :3].mean() > 0.3
    np.testing.assert_array_equal(pictures[0], pictures[1])
    np.testing.assert_array_equal(pictures[0], pictures[2])


def test_another_seed_gives_other_noise_and_the_same_mean(tmp_path):
    scene = busy_scene(passes=8)
    first = stage.render(tmp_path)[..., :3]
    scene.opal.seed = 1
    second = stage.render(tmp_path)[..., :3]
    assert not np.array_equal(first, second)
    spread = (first - second).std() / np.sqrt(first.shape[0] * first.shape[1])
    assert abs(first.mean() - second.mean()) < 5 * spread


def test_the_time_limit_ends_the_render(tmp_path):
    scene = busy_scene()
    scene.opal.time_limit = 1.0
    begun = time.perf_counter()
    picture = stage.render(tmp_path)
    assert time.perf_counter() - begun < 6
    assert picture[..., :3].mean() == pytest.approx(0.5, rel=0.05)


def test_the_noise_threshold_ends_the_render_once_it_is_reached(tmp_path):
    scene = busy_scene()
    scene.opal.noise_threshold = 0.05
    begun = time.perf_counter()
    picture = stage.render(tmp_path)[..., 1]
    assert time.perf_counter() - begun < 60
    assert picture.std() / picture.mean() < 0.1


def test_progress_statistics_and_time_left_are_told(monkeypatch, tmp_path):
    """Each pass here ends only once it was told of: one that is done before anybody asks need not be."""
    busy_scene(passes=3)
    final_render = stage.addon("final_render")
    told, heard = [], threading.Event()
    original, run_pass = final_render._FinalRender._tell, final_render.Render.run_pass

    def tell(self, *arguments):
        told.append(arguments)
        original(self, *arguments)
        heard.set()

    def run_and_wait(self, number):
        heard.clear()
        run_pass(self, number)
        assert heard.wait(60), f"nobody told of pass {number + 1}"

    monkeypatch.setattr(final_render._FinalRender, "_tell", tell)
    monkeypatch.setattr(final_render.Render, "run_pass", run_and_wait)
    stage.render(tmp_path)
    assert {arguments[0] for arguments in told} == {0, 1, 2}
    assert all(0 <= done <= total == 3 for _, total, done, _ in told)
    assert [done for _, _, done, _ in told] == sorted(done for _, _, done, _ in told)


def _card_that_moves(scene):
    """Across the picture, at frame 1 in its middle."""
    card = stage.plane(size=1, material=stage.glowing())
    for frame, x in ((0, -2), (2, 2)):
        card.location.x = x
        card.keyframe_insert("location", frame=frame)
    scene.frame_set(1)


def test_motion_blur_smears_a_moving_object_along_its_path(tmp_path):
    scene = stage.scene(width=32, height=8, passes=8, samples=16)
    stage.camera((0, 0, 5), type="ORTHO", ortho_scale=8)
    _card_that_moves(scene)
    sharp = stage.render(tmp_path)[4, :, 1]
    scene.render.use_motion_blur = True
    scene.render.motion_blur_shutter = 1.0
    blurred = stage.render(tmp_path)[4, :, 1]
    assert blurred.sum() == pytest.approx(sharp.sum(), rel=0.1), "motion moves light, it makes none"
    assert (blurred > 0.05).sum() > 1.8 * (sharp > 0.05).sum()
    assert scene.frame_current == 1


@pytest.mark.skipif("use_motion_blur" not in bpy.types.ViewLayer.bl_rna.properties, reason="layers have no such switch before Blender 5")
def test_a_view_layer_without_motion_blur_stays_sharp(tmp_path):
    scene = stage.scene(width=32, height=8, passes=1, samples=16)
    stage.camera((0, 0, 5), type="ORTHO", ortho_scale=8)
    _card_that_moves(scene)
    sharp = stage.render(tmp_path)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
    scene.view_layers[0].use_motion_blur = False
    np.testing.assert_array_equal(stage.render(tmp_path), sharp)


def test_an_object_whose_motion_blur_is_off_stays_sharp(tmp_path):
    scene = stage.scene(width=32, height=8, passes=4, samples=16)
    stage.camera((0, 0, 5), type="ORTHO", ortho_scale=8)
    card = stage.plane(size=1, material=stage.glowing())
    if not hasattr(card, "cycles"):
        pytest.skip("Cycles, whose setting it is, is not enabled")
    for frame, x in ((0, -2), (2, 2)):
        card.location.x = x
        card.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    sharp = stage.render(tmp_path)[4, :, 1]
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
    card.cycles.use_motion_blur = False
    assert stage.render(tmp_path)[4, :, 1] == pytest.approx(sharp, abs=0.05)


def test_a_spectral_file_holds_the_light_of_a_white_world(tmp_path):
    scene = stage.scene(width=8, height=8, passes=16, samples=16)
    stage.camera()
    stage.world()
    scene.opal.use_spectral_output = True
    scene.opal.spectral_bins = 47
    scene.opal.spectral_path = str(tmp_path / "spectra_##")
    picture = stage.render(tmp_path)
    import OpenImageIO as oiio

    image = oiio.ImageBuf(str(tmp_path / "spectra_01.exr"))
    names = image.spec().channelnames
    spectral = [name for name in names if name.startswith("S0.")]
    assert len(spectral) == 47 and "S0.365,0nm" in spectral
    assert image.spec().getattribute("spectralLayoutVersion") == "1.0"
    pixels = image.get_pixels(oiio.FLOAT)
    measured = pixels[..., [names.index(name) for name in spectral]].mean((0, 1))
    wavelengths = np.array([float(name[3:-2].replace(",", ".")) for name in spectral])
    from opal_kernels.optics import colour

    white = np.interp(wavelengths, colour.WAVELENGTHS_NM, colour.white())
    order = np.argsort(wavelengths)
    visible = (wavelengths[order] > 420) & (wavelengths[order] < 680)
    np.testing.assert_allclose(measured[order][visible], white[order][visible], rtol=0.1)
    assert picture[..., :3].mean() == pytest.approx(1.0, rel=0.03)
    # What the file says of its unit: weighed by the eye's sensitivity its mean is the luminance of the picture.
    eye = np.interp(wavelengths, colour.WAVELENGTHS_NM, colour.observer()[1])
    luminance = (picture[..., :3] @ (0.2126729, 0.7151522, 0.0721750)).mean()
    assert (measured * eye).sum() / eye.sum() == pytest.approx(luminance, rel=0.01)
    assert image.spec().getattribute("emissiveUnits").startswith("relative")


def test_denoising_lowers_noise_and_keeps_the_mean(tmp_path):
    from opal_kernels import denoise

    if reason := denoise.unavailable():
        pytest.skip(reason)
    scene = busy_scene(passes=2)

    def of_two_seeds():
        renders = []
        for scene.opal.seed in (0, 1):
            renders.append(stage.render(tmp_path)[..., :3])
        return renders

    noisy = of_two_seeds()
    scene.opal.denoise = True
    clean = of_two_seeds()
    # What differs between seeds is noise; what they share is the picture.
    assert np.std(clean[0] - clean[1]) < 0.5 * np.std(noisy[0] - noisy[1])
    assert np.mean(clean) == pytest.approx(np.mean(noisy), rel=0.02)


class DrawnLayout:
    """Takes what a panel draws: the properties and the texts."""

    active = enabled = True

    def __init__(self):
        self.properties, self.texts = [], []

    def prop(self, _owner, name, **_):
        self.properties.append(name)

    def label(self, text="", **_):
        self.texts.append(text)


def test_without_a_denoiser_its_setting_is_greyed_out_and_says_why(monkeypatch, tmp_path):
    from opal_kernels import denoise

    panel = stage.addon("panels").OPAL_RENDER_PT_denoise

    def drawn():
        header, body = DrawnLayout(), DrawnLayout()
        panel.draw_header(SimpleNamespace(layout=header), bpy.context)
        panel.draw_settings(SimpleNamespace(layout=body), body, bpy.context.scene.opal, bpy.context)
        assert header.properties == ["denoise"]
        return header.enabled, body.texts

    reason = "This build of Blender carries no Open Image Denoise."
    monkeypatch.setattr(denoise, "unavailable", lambda: reason)
    assert drawn() == (False, [reason])
    # A file whose setting was made where there is a denoiser renders, and the report says what is missing.
    stage.scene().opal.denoise = True
    stage.camera()
    stage.world()
    assert stage.render(tmp_path)[..., :3].mean() > 0.5
    assert any(reason in entry for entry in stage.problems()), stage.problems()
    monkeypatch.setattr(denoise, "unavailable", lambda: "")
    enabled, texts = drawn()
    assert enabled and reason not in texts


def test_material_previews_are_rendered_fast(tmp_path):
    material = stage.matte()
    material.opal.kind = "GEM"
    settings = stage.addon("settings")
    scene = stage.scene(passes=500)
    scene.opal.photons_per_pass = 1_000_000
    preview = settings.render_settings(scene, settings.frame_of(scene.render), preview=True)
    assert preview.photons_per_pass <= 20_000 and preview.samples_per_pass == 1 and preview.spectral_bins == 0


def test_what_cannot_be_read_is_named_in_the_report(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    stage.plane("Card", size=20, material=stage.node_material("Toon one", "BsdfToon"))
    stage.render(tmp_path)
    assert any("Toon one" in entry for entry in stage.problems()), stage.problems()


def test_shadow_catchers_and_hair_of_particles_are_named_in_the_report(tmp_path):
    scene = stage.scene()
    stage.camera((0, 0, 5))
    stage.plane("Floor", size=20).is_shadow_catcher = True
    head = stage.plane("Head")
    head.modifiers.new("Hair", "PARTICLE_SYSTEM")
    head.particle_systems[0].settings.type = "HAIR"
    stage.render(tmp_path)
    for words in ("Floor: Opal has no shadow catchers", "Head: hair of particles"):
        assert any(words in entry for entry in stage.problems()), stage.problems()
    lost = {entry.owner: entry.lost for entry in stage.addon("report").of(scene).entries}
    assert lost == {"Floor": False, "Head": True}


def test_light_links_of_lamps_that_are_only_there_as_instances_are_kept(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    stage.world(strength=0)
    stage.plane(size=20, material=stage.matte())
    lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    lamp.data.energy, lamp.location = 100, (0, 0, 2)
    lit, lamps = bpy.data.collections.new("Lit"), bpy.data.collections.new("Lamps")
    lit.objects.link(stage.plane("Elsewhere", location=(50, 0, 0)))
    lamps.objects.link(lamp)
    copies = stage.link("Copies", None)
    copies.instance_type, copies.instance_collection = "COLLECTION", lamps
    assert stage.render(tmp_path)[..., :3].mean() > 0.1
    lamp.light_linking.receiver_collection = lit
    assert stage.render(tmp_path)[..., :3].max() == 0


@pytest.mark.parametrize("kind", ["BsdfPrincipled", "BsdfGlass", "BsdfMetallic"])
def test_a_thin_film_that_is_not_shaded_is_named(kind, tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    material = stage.node_material("Soap", kind)
    stage.plane(size=20, material=material)
    stage.render(tmp_path)
    assert not stage.problems()
    shader = next(node for node in material.node_tree.nodes if node.outputs[0].type == "SHADER")
    if "Thin Film Thickness" not in shader.inputs:
        pytest.skip(f"this Blender's {shader.bl_label} has no thin film")
    shader.inputs["Thin Film Thickness"].default_value = 400.0
    stage.render(tmp_path)
    assert any("Soap" in entry and "Thin films" in entry for entry in stage.problems()), stage.problems()
