# SPDX-License-Identifier: GPL-3.0-or-later
"""What is deleted while a render starts is noticed before its originals are looked at; what stands is never taken for deleted."""

import threading

import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


@pytest.fixture
def main_thread():
    return stage.addon("main_thread")


def test_nothing_that_stands_is_missed(main_thread):
    stage.scene()
    flat = stage.plane(material=stage.matte("Plain"))
    instancer = bpy.data.objects.new("Instancer", None)
    bpy.context.scene.collection.objects.link(instancer)
    inner = bpy.data.collections.new("Inner")
    inner.objects.link(stage.plane())
    instancer.instance_type, instancer.instance_collection = "COLLECTION", inner
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Twin", flat.data))
    flat.modifiers.new("Bevel", "BEVEL")
    stage.camera((0, 0, 9))
    depsgraph = bpy.context.evaluated_depsgraph_get()
    depsgraph.update()
    assert len(depsgraph.ids) > 8
    assert main_thread.deleted(depsgraph) == []


def test_what_was_deleted_beneath_a_depsgraph_is_named(main_thread):
    stage.scene()
    stage.plane()
    gone = stage.plane()
    gone.name = "Gone"
    depsgraph = bpy.context.evaluated_depsgraph_get()
    depsgraph.update()
    bpy.data.objects.remove(gone)
    assert main_thread.deleted(depsgraph) == ["Gone"]


class _Interface:
    """Stands in for `bpy` with an interface, whose timers run when told."""

    def __init__(self):
        self.app = self.timers = self
        self.background = False
        self.waiting = []

    def register(self, function, first_interval):
        self.waiting.append(function)


@pytest.fixture
def interface(main_thread, monkeypatch):
    found = _Interface()
    monkeypatch.setattr(main_thread, "bpy", found)
    return found


def _in_a_thread(function):
    found = []

    def run():
        try:
            found.append(function())
        except Exception as error:
            found.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    return thread, found


def test_a_render_job_reads_on_the_main_thread(main_thread, interface):
    thread, found = _in_a_thread(lambda: main_thread.call(threading.current_thread, lambda: None))
    while not interface.waiting:
        pass
    interface.waiting.pop()()
    thread.join()
    assert found == [threading.main_thread()]
    assert main_thread.call(lambda: 1, lambda: None) == 1, "on the main thread itself it is called at once"


def test_what_fails_there_fails_here(main_thread, interface):
    def fail():
        raise ValueError("no")

    thread, found = _in_a_thread(lambda: main_thread.call(fail, lambda: None))
    while not interface.waiting:
        pass
    interface.waiting.pop()()
    thread.join()
    assert str(found[0]) == "no"


def test_a_main_thread_that_does_not_come_is_not_waited_for_and_does_nothing_later(main_thread, interface, monkeypatch):
    monkeypatch.setattr(main_thread, "_PATIENCE", 0.05)
    calls = []
    thread, _ = _in_a_thread(lambda: main_thread.call(lambda: calls.append(threading.current_thread()), lambda: None))
    thread.join()
    assert calls == [thread]
    interface.waiting.pop()()
    assert calls == [thread]


def test_a_person_who_stops_meanwhile_is_heard(main_thread, interface):
    def stop():
        raise KeyError("stopped")

    calls = []
    thread, found = _in_a_thread(lambda: main_thread.call(lambda: calls.append(1), stop))
    thread.join()
    assert isinstance(found[0], KeyError)
    interface.waiting.pop()()
    assert calls == []
