# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparison, composite and layers as the interface drives them, step by step: given up anywhere, they leave nothing behind.

Without a window a render that is only begun is done at once; the window's part is `tests/ui/long_jobs.py`.
"""

import importlib
import sys
import types

import layer_stage
import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

pytestmark = pytest.mark.usefixtures("opal")
JOBS = ("composite", "compare_cycles", "render_layers")


def module(name):
    """A module of the installed extension's ``operators`` package."""
    package = next(key for key in sys.modules if key.endswith("opal.operators"))
    return importlib.import_module(f"{package}.{name}")


class Asked:
    """An operator's settings and methods without Blender's half of it; keeps what is reported."""

    def __init__(self, name, **settings):
        self.kind = getattr(module(name), f"OPAL_OT_{name}")
        for prop in getattr(bpy.ops.opal, name).get_rna_type().properties:
            if prop.identifier != "rna_type":
                many = prop.type == "ENUM" and prop.is_enum_flag
                setattr(self, prop.identifier, set(prop.default_flag) if many else prop.default)
        vars(self).update(settings)
        self.reports = []

    def report(self, kind, sentence):
        self.reports.append((kind, sentence))

    def __getattr__(self, name):
        return types.MethodType(getattr(self.kind, name), self)

    def job(self):
        return module("job").Job(self.kind.steps(self, bpy.context), self.kind.parts, self.kind.bl_label, True)


def state():
    """What jobs change for a while."""
    scene = bpy.context.scene
    found = {}
    for owner in (scene.render, scene.render.image_settings, scene.cycles, scene.opal):
        for prop in owner.bl_rna.properties:
            if not prop.is_readonly and prop.type in {"BOOLEAN", "INT", "FLOAT", "ENUM", "STRING"} and not getattr(prop, "is_array", False):
                found[owner.bl_rna.identifier, prop.identifier] = getattr(owner, prop.identifier)
    for material in bpy.data.materials:
        found["nodes", material.name] = [(n.name, getattr(n, "is_active_output", None)) for n in material.node_tree.nodes]
    found |= {("hidden", o.name): o.hide_render for o in scene.objects} | {("layer", v.name): v.use for v in scene.view_layers}
    handlers = bpy.app.handlers
    found["handlers"] = len(handlers.render_stats), len(handlers.render_cancel)
    return found


def pictures():
    return sorted(image.name for image in bpy.data.images if image.type != "RENDER_RESULT")


def small(**settings):
    scene = layer_stage.build(passes=1, width=8, height=6)
    scene.cycles.samples = 1
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "PNG", "8"
    scene.view_layers.new("Other")
    return scene


SETTINGS = {"composite": {"samples": 1}, "compare_cycles": {"mode": "VOLUMES"}, "render_layers": {}}


@pytest.mark.parametrize("name", JOBS)
def test_a_job_given_up_at_any_step_puts_everything_back(name):
    small()
    before, images = state(), pictures()
    stages, calls = 0, 0
    while True:
        asked = Asked(name, **SETTINGS[name])
        job = asked.job()
        over = any(job.advance() for _ in range(calls))
        stages += state() != before
        job.abandon()
        assert job.over and state() == before, {key: (before[key], value) for key, value in state().items() if before[key] != value}
        if over:
            break
        assert pictures() == images, f"after {calls} calls"
        calls += 1
    assert job.result == {"FINISHED"}, asked.reports
    assert calls > 2 * asked.kind.parts and pictures() != images
    assert stages >= 2 * asked.kind.parts, "the scene was changed while it was at work"


@pytest.mark.parametrize("name", JOBS)
def test_step_by_step_a_job_makes_what_it_makes_at_once(name):
    small()
    assert getattr(bpy.ops.opal, name)(**SETTINGS[name]) == {"FINISHED"}
    at_once = {key: np.array(bpy.data.images[key].pixels) for key in pictures()}
    for key in at_once:
        bpy.data.images.remove(bpy.data.images[key])
    job = Asked(name, **SETTINGS[name]).job()
    while not job.advance():
        assert 0 <= job.done <= 1
    assert job.result == {"FINISHED"} and pictures() == sorted(at_once)
    for key, pixels in at_once.items():
        np.testing.assert_array_equal(np.array(bpy.data.images[key].pixels), pixels, err_msg=key)


def test_what_was_deleted_meanwhile_is_passed_over():
    """A material goes while Cycles renders without it: the others get back what they had."""
    small()
    before = state()
    job = Asked("composite", samples=1).job()
    while not any("Opal base" in node.name for node in bpy.data.materials["Fog"].node_tree.nodes):
        assert not job.advance()
    bpy.data.materials.remove(bpy.data.materials["Glass"])
    bpy.data.objects.remove(bpy.data.objects["Ball"])
    job.abandon()
    gone = {("nodes", "Glass"), ("hidden", "Ball")}
    assert state() == {key: value for key, value in before.items() if key not in gone}


def test_another_job_is_refused_in_one_sentence_while_one_is_at_work(monkeypatch):
    small()
    job = Asked("composite", samples=1).job()
    monkeypatch.setattr(module("long_job"), "_running", job)
    assert not job.advance()
    for name in (*JOBS, "rainbow_chart"):
        with pytest.raises(RuntimeError, match="Composite over Cycles is still at work: wait for its end, or stop it with Esc"):
            getattr(bpy.ops.opal, name)()
    job.abandon()
    assert bpy.ops.opal.render_layers() == {"FINISHED"}


def test_undo_gives_a_job_up_before_the_data_go(monkeypatch):
    small()
    before = state()
    job = Asked("composite", samples=1).job()
    monkeypatch.setattr(module("long_job"), "_running", job)
    job.advance()
    assert state() != before
    for handler in bpy.app.handlers.undo_pre:
        handler(bpy.context.scene)
    assert job.over and state() == before


def test_a_render_that_fails_ends_the_job_with_its_sentence():
    scene = small()
    before = state()
    scene.camera = None
    asked = Asked("composite", samples=1)
    job = asked.job()
    while not job.advance():
        pass
    assert job.result == {"CANCELLED"} and state() == before
    ((kind, sentence),) = asked.reports
    assert kind == {"ERROR"} and "camera" in sentence


def test_a_step_aside_is_told_to_stop():
    job_module = module("job")
    told = []

    def work(tell):
        while tell(0.5):
            pass
        told.append("stopped")

    def steps():
        try:
            yield job_module.Aside(work, "Working")
        finally:
            told.append("left")

    job = job_module.Job(steps())
    assert not job.advance() and not job.advance()
    job.stop()
    while not job.advance():
        pass
    assert told == ["stopped", "left"] and job.result == {"CANCELLED"}


def test_operators_whose_result_is_a_picture_offer_no_settings_afterwards():
    """Each change there would wait for a render with the window frozen."""
    for name in (*JOBS, "rainbow_chart", "gem_report"):
        assert getattr(bpy.ops.opal, name).bl_options == {"UNDO"}, name
