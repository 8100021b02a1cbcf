# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered view's scene follows edits: what it shows equals a fresh build, and no more is built than an edit needs.

Blender's own tags come from a handler after each evaluation, as the view gets them; pictures are compared bit by bit.
"""

import gc
import threading
import time
from dataclasses import replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")

SIZE = (48, 36)


class View:
    """A rendered view without a window: keeps a scene in step with the file and says what it built."""

    def __init__(self):
        self.sync = stage.addon("viewport_sync").SceneSync(threads=2)
        self.before_change = lambda: None
        self.workers = []
        bpy.app.handlers.depsgraph_update_post.append(self._updated)
        self.changed = self.sync.update(bpy.context.evaluated_depsgraph_get())

    def close(self):
        for worker in self.workers:  # also after a test that failed: a thread that goes on in a scene that is freed ends Blender
            worker.stop()
        if self._updated in bpy.app.handlers.depsgraph_update_post:  # files take handlers with them
            bpy.app.handlers.depsgraph_update_post.remove(self._updated)
        self.sync.close()

    def _updated(self, _scene, depsgraph):
        self.changed |= self.sync.update(depsgraph, self.before_change)

    def edit(self, change):
        """Makes an edit; how much was (read anew, meshes, top levels, light tables built) for it."""
        before, self.changed = self._counts(), False
        change()
        bpy.context.view_layer.update()
        after = self._counts()
        if after[0] != before[0]:
            return "everything"
        return tuple(b - a for a, b in zip(before[1:], after[1:], strict=True))

    def _counts(self):
        found = self.sync.scene.statistics
        return self.sync.rebuilds, found["mesh_builds"], found["top_builds"], found["light_builds"]

    def picture(self):
        return picture(self.sync.scene)

    def fresh(self):
        """The picture of a scene that was built from nothing."""
        other = stage.addon("viewport_sync").SceneSync(threads=2)
        try:
            other.update(bpy.context.evaluated_depsgraph_get())
            return picture(other.scene)
        finally:
            other.close()


def wanted(scene, size=SIZE):
    settings = stage.addon("settings")
    frame = settings.Frame(*size, (0, 0, *size))
    return replace(settings.render_settings(scene, frame, preview=True), threads=2)


def camera_of(scene, size=SIZE):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return stage.addon("translate.camera").camera_from_object(scene.camera.evaluated_get(depsgraph), scene, *size)


def picture(kernel_scene, passes=2):
    from opal_kernels.render import Render

    kernel_scene.set_camera(camera_of(bpy.context.scene))
    with Render(kernel_scene, wanted(bpy.context.scene)) as render:
        return render.run(passes).film("COMBINED").copy()


@pytest.fixture
def view():
    """A table, a gem over it, a glowing plate, a lamp and a sky; with photons."""
    scene = stage.scene(*SIZE)
    scene.opal.photons_per_pass = 2000
    stage.camera((0, -4, 3), (0.9, 0, 0))
    stage.world((0.2, 0.3, 0.4))
    stage.plane(size=6, material=stage.matte("Table"))
    bpy.ops.mesh.primitive_ico_sphere_add(radius=0.5, location=(0, 0, 0.6))
    bpy.context.object.name = "Gem"
    gem = bpy.data.materials.new("Gem")
    gem.opal.kind, gem.opal.gem.species = "GEM", "DIAMOND"
    bpy.context.object.data.materials.append(gem)
    bpy.ops.mesh.primitive_cube_add(size=0.5, location=(1, 0.5, 0.4))
    bpy.context.object.name = "Plate"
    bpy.context.object.data.materials.append(stage.glowing("Glow", strength=2.0))
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.energy = 100
    stage.link("Lamp", lamp, (1, -1, 3))
    bpy.context.view_layer.update()
    kept = View()
    yield kept
    kept.close()


def color(name, value):
    tree = bpy.data.materials[name].node_tree
    node = next(n for n in tree.nodes if "Color" in n.inputs)
    node.inputs["Color"].default_value = value


def move(name, x):
    bpy.data.objects[name].location.x = x


def sky(value):
    tree = bpy.context.scene.world.node_tree
    next(n for n in tree.nodes if n.type == "BACKGROUND").inputs["Color"].default_value = value


def custom_gem():
    gem = bpy.data.materials["Gem"].opal.gem
    gem.species, gem.absorption_color = "CUSTOM", (0.9, 0.1, 0.1)


LIGHTS_ALONE, TOP_LEVEL = (0, 0, 1), (0, 1, 1)
EDITS = {
    "a colour": (lambda: color("Table", (0.8, 0.1, 0.1, 1)), LIGHTS_ALONE),
    "what glows": (lambda: color("Glow", (0.1, 1, 0.1, 1)), LIGHTS_ALONE),
    "a gem's roughness": (lambda: setattr(bpy.data.materials["Gem"].opal.gem, "roughness", 0.3), LIGHTS_ALONE),
    "a gem's species": (lambda: setattr(bpy.data.materials["Gem"].opal.gem, "species", "RUBY"), LIGHTS_ALONE),
    "a gem's own numbers": (custom_gem, LIGHTS_ALONE),
    "the sky": (lambda: sky((1, 0.5, 0.2, 1)), LIGHTS_ALONE),
    "a lamp's power": (lambda: setattr(bpy.data.lights["Lamp"], "energy", 300), LIGHTS_ALONE),
    "a lamp's spectrum": (lambda: setattr(bpy.data.lights["Lamp"].opal, "spectrum", "SODIUM"), LIGHTS_ALONE),
    "where a lamp stands": (lambda: move("Lamp", -1), LIGHTS_ALONE),
    "where an object stands": (lambda: move("Gem", 0.4), TOP_LEVEL),
    "where what glows stands": (lambda: move("Plate", 0.6), TOP_LEVEL),
    "where the camera stands": (lambda: move("Camera", 0.3), (0, 0, 0)),
    "the camera's lens": (lambda: setattr(bpy.data.cameras["Camera"], "lens", 35), (0, 0, 0)),
    "the selection": (lambda: bpy.data.objects["Gem"].select_set(False), (0, 0, 0)),
    "a shape": (lambda: _reshape("Gem"), "everything"),
    "who wears a material": (lambda: bpy.data.objects["Plate"].data.materials.__setitem__(0, bpy.data.materials["Table"]), "everything"),
    "what casts shadows": (lambda: setattr(bpy.data.objects["Gem"], "visible_shadow", False), "everything"),
    "a material's kind": (lambda: setattr(bpy.data.materials["Gem"].opal, "kind", "SURFACE"), "everything"),
    "hiding": (lambda: bpy.data.objects["Gem"].hide_set(True), "everything"),
    "deleting": (lambda: bpy.data.objects.remove(bpy.data.objects["Gem"]), "everything"),
    "deleting a material": (lambda: bpy.data.materials.remove(bpy.data.materials["Gem"]), "everything"),
    "fog": (lambda: setattr(bpy.data.materials["Gem"].opal, "kind", "MEDIUM"), "everything"),
    "haze": (lambda: setattr(bpy.context.scene.world.opal, "kind", "MEDIUM"), "everything"),
}


def _reshape(name):
    mesh = bpy.data.objects[name].data
    mesh.vertices[0].co.z *= 1.5
    mesh.update()


@pytest.mark.parametrize("name", EDITS)
def test_an_edit_builds_only_what_it_must_and_shows_what_a_fresh_build_shows(view, name):
    change, expected = EDITS[name]
    before = view.picture()
    assert view.edit(change) == expected
    after = view.picture()
    np.testing.assert_array_equal(after, view.fresh())
    if name != "the selection":
        assert not np.array_equal(before, after), "the edit is not seen"


def test_a_group_within_a_material_and_a_texture_that_follows_an_object(view):
    """Blender tags the group alone for a value in it, and for the object alone its move."""
    tree = bpy.data.materials["Table"].node_tree
    group = bpy.data.node_groups.new("Inner", "ShaderNodeTree")
    value, out = group.nodes.new("ShaderNodeRGB"), group.nodes.new("NodeGroupOutput")
    group.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
    group.links.new(value.outputs[0], out.inputs[0])
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    shader = next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE")
    tree.links.new(node.outputs[0], shader.inputs["Color"])
    bpy.context.view_layer.update()
    assert view.edit(lambda: setattr(value.outputs[0], "default_value", (0.9, 0.2, 0.1, 1))) == LIGHTS_ALONE
    np.testing.assert_array_equal(view.picture(), view.fresh())

    pointer = stage.link("Pointer", None)
    coordinates, checker = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeTexChecker")
    coordinates.object = pointer
    tree.links.new(coordinates.outputs["Object"], checker.inputs["Vector"])
    tree.links.new(checker.outputs[0], shader.inputs["Color"])
    bpy.context.view_layer.update()
    before = view.picture()
    assert view.edit(lambda: move("Pointer", 0.37)) == LIGHTS_ALONE
    assert not np.array_equal(before, view.picture())
    np.testing.assert_array_equal(view.picture(), view.fresh())


def test_a_change_that_is_none_lets_the_render_go_on(view):
    """Selecting and renaming tag objects and the scene; the picture does not start again for it."""
    touched = []
    view.before_change = lambda: touched.append(1)
    view.edit(lambda: bpy.data.objects["Plate"].select_set(True))
    view.edit(lambda: color("Table", tuple(color_of("Table"))))
    assert not touched and not view.changed


def color_of(name):
    return next(n for n in bpy.data.materials[name].node_tree.nodes if "Color" in n.inputs).inputs["Color"].default_value


UNDONE = (
    "a colour",
    "a gem's species",
    "a lamp's power",
    "where an object stands",
    "a shape",
    "who wears a material",
    "a material's kind",
    "deleting",
    "deleting a material",
    "haze",
)


@pytest.mark.parametrize("name", UNDONE)
def test_an_edit_that_is_undone_and_redone_shows_what_was_before_and_after(view, name):
    """Undo puts other data-blocks in the place of those that were read: names for the session stay, addresses do not."""
    bpy.ops.ed.undo_push(message="before")
    first = view.picture()
    view.edit(EDITS[name][0])
    bpy.ops.ed.undo_push(message="edited")
    edited = view.picture()
    for step, expected in ((bpy.ops.ed.undo, first), (bpy.ops.ed.redo, edited), (bpy.ops.ed.undo, first)):
        step()
        view.sync.update(bpy.context.evaluated_depsgraph_get())
        np.testing.assert_array_equal(view.picture(), view.fresh())
        np.testing.assert_array_equal(view.picture(), expected)


def test_a_view_that_was_not_told_of_an_undo_reads_everything_when_it_is_drawn(monkeypatch):
    viewport = stage.addon("viewport")
    asked = []

    class Engine:
        def update_stats(self, *_words):
            pass

    class Sync:
        scene = None

        def update(self, _depsgraph, _stop, everything):
            asked.append(everything)
            return True

    engine, context = Engine(), type("Context", (), {"region": None})
    shown = viewport.Viewport(engine)
    shown._sync = Sync()
    shown.draw(context, None)
    assert asked == []
    bpy.ops.ed.undo_push(message="one")
    bpy.ops.ed.undo_push(message="two")
    bpy.ops.ed.undo()
    shown.update(None)
    shown.draw(context, None)
    assert asked == [False], "it was told"
    bpy.ops.ed.redo()
    shown.draw(context, None)
    shown.draw(context, None)
    assert asked == [False, True]


def test_a_view_whose_reading_fails_says_so_and_reads_anew_with_the_next_edit(view):
    viewport = stage.addon("viewport")

    class Engine:
        said = ""

        def update_stats(self, _title, words):
            self.said = words

    class Sync:
        scene = None

        def update(self, *_arguments):
            raise AttributeError("something unforeseen")

    engine = Engine()
    shown = viewport.Viewport(engine)
    shown._sync = Sync()
    shown.update(None)
    shown.draw(type("Context", (), {"region": None}), None)
    assert "something unforeseen" in engine.said


def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * 4096


@pytest.mark.skipif(not __import__("os").path.exists("/proc/self/statm"), reason="needs /proc")
def test_five_hundred_edits_take_no_memory(view):
    """Every kind of edit in turn. A mesh left behind would be 0.5 MB an edit, a gem's tables 4 kB: 2 MB of the 2 MB allowed."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=80, y_subdivisions=80, size=2)
    bpy.context.object.name = "Grid"
    bpy.context.view_layer.update()
    gem = bpy.data.materials["Gem"].opal.gem
    gem.species = "CUSTOM"

    def round_of(number):
        share = (number % 17 + 1) / 20
        view.edit(lambda: color("Table", (share, 0.5, 0.5, 1)))
        view.edit(lambda: setattr(gem, "cauchy_b", 1.5 + number * 1e-3))
        view.edit(lambda: move("Gem", share))
        view.edit(lambda: setattr(bpy.data.lights["Lamp"], "energy", 100 * share))
        view.edit(lambda: sky((share, share, 1, 1)))
        assert view.edit(lambda: _reshape_by("Grid", share)) == "everything"

    for number in range(8):
        round_of(number)
    gc.collect()
    before = resident()
    for number in range(8, 92):
        round_of(number)
    gc.collect()
    grown = resident() - before
    assert grown < 2e6, f"{grown / 1e6:.2f} MB over 504 edits"


def _reshape_by(name, share):
    mesh = bpy.data.objects[name].data
    mesh.vertices[0].co.z = share
    mesh.update()


# ---- The thread ----


def worker_of(view, passes, size=SIZE, seen=None, **options):
    viewport_worker = stage.addon("viewport_worker")
    scene = bpy.context.scene
    pictures = [] if seen is None else seen
    holder = []

    def redraw():
        while not holder:
            pass
        pictures.append((holder[0].done, None if holder[0].picture is None else holder[0].picture.copy()))

    pace = options.pop("pace", viewport_worker.Pace(1e-3))
    holder.append(viewport_worker.Worker(view.sync.scene, camera_of(scene, size), wanted(scene, size), passes, pace, redraw, **options))
    view.workers.append(holder[0])
    return holder[0], pictures


def until(condition, what, seconds=60):
    """Waits for what a thread does; a busy machine takes its time."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"{what}: not within {seconds} s"
        time.sleep(0.005)


def test_the_view_refines_from_coarse_pixels_to_its_own(view):
    """A slow machine (1 ms a pixel): first few pixels, then more, then the view's own, whose last picture is the film's."""
    worker, pictures = worker_of(view, 3)
    worker.wait(60)
    sizes = [p.shape[1] for _, p in pictures]
    assert sizes == [SIZE[0] // 8, SIZE[0] // 2, SIZE[0], SIZE[0], SIZE[0]]
    assert [done for done, _ in pictures] == [0, 0, 1, 2, 3]
    np.testing.assert_array_equal(pictures[-1][1], picture(view.sync.scene, 3))


def test_the_first_picture_is_as_coarse_as_the_time_demands():
    pace = stage.addon("viewport_worker").Pace(1e-6)
    assert pace.coarseness(200, 100) == 1
    for _ in range(20):
        pace.note(1000, 1e-2)  # 10 us a sample
    assert pace.coarseness(960, 540) == 8  # 81,000 us at an eighth, 324,000 at a quarter
    for _ in range(20):
        pace.note(1000, 10.0)
    assert pace.coarseness(960, 540) == 16


def test_the_view_is_denoised_where_the_build_can(view):
    from opal_kernels import denoise

    if reason := denoise.unavailable():
        pytest.skip(reason)
    worker, pictures = worker_of(view, 4, denoised=True)
    worker.wait(60)
    assert not worker.failure
    noise = [np.abs(np.diff(p[..., 1], axis=1)).mean() for p in (pictures[-1][1], picture(view.sync.scene, 4))]
    assert noise[0] < noise[1]
    shown = [p for done, p in pictures if done in {2, 3}]
    assert np.array_equal(*shown), "pass 3 shows what pass 2 had"


def test_a_stop_ends_the_thread_at_once(view):
    worker, _ = worker_of(view, 10_000, size=(640, 480))
    time.sleep(0.3)
    begun = time.perf_counter()
    worker.stop()
    assert time.perf_counter() - begun < 0.3
    assert not any(t.name == "Opal viewport" for t in threading.enumerate())


# ---- What breaks ----


@pytest.mark.parametrize("how", ["the object", "the material", "the file", "another file", "the engine"])
def test_what_is_rendered_goes_away_while_the_thread_runs(view, how, tmp_path):
    """The thread holds nothing of Blender's: whatever is taken from the file, it renders on until it is stopped."""
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "another.blend"), copy=True)
    worker, pictures = worker_of(view, 10_000)
    view.before_change = worker.stop
    until(lambda: pictures, "a first picture")
    if how == "the object":
        bpy.data.objects.remove(bpy.data.objects["Gem"])
    elif how == "the material":
        bpy.data.materials.remove(bpy.data.materials["Gem"])
    elif how == "the file":
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    elif how == "another file":
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "another.blend"))
    else:
        bpy.context.scene.render.engine = "CYCLES"
    gc.collect()
    seen = len(pictures)
    until(lambda: len(pictures) > seen or not worker._thread.is_alive(), "a picture after it went away")
    bpy.context.view_layer.update()
    worker.stop()
    assert not worker.failure


def test_two_view_layers_and_two_scenes_each_get_their_own(view):
    """The same view turned to another layer or scene reads all of it; back again it shows the first."""
    first = view.picture()
    scene = bpy.context.scene
    layer = scene.view_layers.new("Second")
    layer.material_override = bpy.data.materials["Glow"]
    window = bpy.context.window
    window.view_layer = layer
    bpy.context.view_layer.update()
    view.sync.update(bpy.context.evaluated_depsgraph_get())
    assert not np.array_equal(view.picture(), first)
    window.view_layer = scene.view_layers[0]
    view.sync.update(bpy.context.evaluated_depsgraph_get())
    np.testing.assert_array_equal(view.picture(), first)

    other = bpy.data.scenes.new("Other")
    other.render.engine = "OPAL"
    other.camera = scene.camera
    other.collection.objects.link(scene.camera)
    window.scene = other
    view.sync.update(bpy.context.evaluated_depsgraph_get())
    assert not view.picture()[..., :3].any(), "the other scene has no light"
    window.scene = scene
    view.sync.update(bpy.context.evaluated_depsgraph_get())
    np.testing.assert_array_equal(view.picture(), first)
