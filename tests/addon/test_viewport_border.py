# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl B in the rendered view: only the border's pixels are rendered, and they are drawn where they lie.

`tests/ui/view.py` has the same in a window, beside Blender's own projection.
"""

from types import SimpleNamespace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402
from mathutils import Matrix  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")

WIDTH, HEIGHT = 60, 40


class Engine:
    """Blender's half of an engine."""

    said = ""

    def update_stats(self, _title, words):
        self.said = words

    def tag_redraw(self):
        pass

    bind_display_space_shader = unbind_display_space_shader = lambda *_: None


class View:
    """A rendered view of 60 x 40 pixels without a window: settings of its editor, and what it would draw (place, picture)."""

    def __init__(self, monkeypatch):
        module = stage.addon("viewport")
        self.region = SimpleNamespace(width=WIDTH, height=HEIGHT)
        self.space_data = SimpleNamespace(
            lens=50.0, clip_start=0.1, clip_end=100.0, camera=None, use_local_camera=False, use_render_border=False
        )
        self.region_data = SimpleNamespace(
            view_matrix=Matrix.Translation((0, 0, -5)), view_perspective="PERSP", view_camera_zoom=0.0, view_camera_offset=(0.0, 0.0)
        )
        self.drawn = []
        state = SimpleNamespace(blend_set=lambda _mode: None)
        types = SimpleNamespace(Buffer=lambda _kind, _size, pixels: pixels, GPUTexture=lambda size, format, data: (size, data))
        monkeypatch.setattr(module, "gpu", SimpleNamespace(types=types, state=state))
        monkeypatch.setattr(module, "draw_texture_2d", self._draw)
        self.engine = Engine()
        self.shown = module.Viewport(self.engine)

    def _draw(self, texture, position, width, height):
        size, data = texture
        box = (*position, position[0] + width, position[1] + height)
        self.drawn.append((tuple(round(edge, 6) for edge in box), np.reshape(data, (size[1], size[0], 4))))

    def picture(self):
        """Where the finished picture is drawn (x0, y0, x1, y1), and its pixels."""
        depsgraph = bpy.context.evaluated_depsgraph_get()
        if self.shown._sync is None:
            self.shown.update(depsgraph)
        self.shown.draw(self, depsgraph)
        assert not self.engine.said.startswith("Error"), self.engine.said
        self.shown._worker.wait(60)
        self.shown.draw(self, depsgraph)
        return self.drawn[-1]

    def mark(self, left, right, bottom, top):
        """Ctrl B, in the view as it stands."""
        if self.region_data.view_perspective == "CAMERA":
            owner, prefix = bpy.context.scene.render, "border"
            owner.use_border = True
        else:
            owner, prefix = self.space_data, "render_border"
            owner.use_render_border = True
        for name, value in (("min_x", left), ("max_x", right), ("min_y", bottom), ("max_y", top)):
            setattr(owner, f"{prefix}_{name}", value)
        bpy.context.view_layer.update()


@pytest.fixture
def view(monkeypatch):
    """A glowing chequered plane fills a view from (0, 0, 5); its cells are 4 pixels wide."""
    scene = stage.scene(passes=100)
    scene.render.resolution_x, scene.render.resolution_y = 300, 100
    stage.camera((0, 0, 5))
    glow = stage.glowing()
    nodes, links = glow.node_tree.nodes, glow.node_tree.links
    checker, coordinates = nodes.new("ShaderNodeTexChecker"), nodes.new("ShaderNodeTexCoord")
    checker.inputs["Scale"].default_value = 4.0
    checker.inputs["Color1"].default_value, checker.inputs["Color2"].default_value = (0.9, 0.5, 0.1, 1), (0.1, 0.2, 0.8, 1)
    links.new(coordinates.outputs["Object"], checker.inputs["Vector"])
    links.new(checker.outputs["Color"], next(n for n in nodes if n.type == "EMISSION").inputs["Color"])
    stage.plane(size=20.0, material=glow)
    result = View(monkeypatch)
    yield result
    result.shown.close()


def assert_like_the_whole(place, part, whole):
    """The part has the size of its place, and shows what the whole shows there: not what it shows a pixel beside it."""
    x0, y0, x1, y1 = (round(edge) for edge in place)
    assert part.shape == (y1 - y0, x1 - x0, 4)
    reach = [(dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if x0 + dx >= 0 and y0 + dy >= 0 and x1 + dx <= WIDTH and y1 + dy <= HEIGHT]
    off = {(dx, dy): np.abs(part - whole[y0 + dy : y1 + dy, x0 + dx : x1 + dx]).mean() for dx, dy in reach}
    here = off.pop((0, 0))
    assert here < 0.01, f"mean difference {here:.4f}"
    assert all(here < 0.4 * there for there in off.values()), (here, off)


@pytest.mark.parametrize(
    ("border", "expected"), [((0.25, 0.75, 0.5, 0.9), (15, 20, 45, 36)), ((0.0, 1.0, 0.0, 1.0), (0, 0, WIDTH, HEIGHT))]
)
def test_in_a_free_view_the_views_own_border_counts(view, border, expected):
    bpy.context.scene.render.use_border = True  # that of a camera, through which this view does not look
    place, whole = view.picture()
    assert place == (0, 0, WIDTH, HEIGHT)
    view.mark(*border)
    place, part = view.picture()
    assert place == expected
    assert_like_the_whole(place, part, whole)
    view.space_data.use_render_border = False
    place, again = view.picture()
    assert place == (0, 0, WIDTH, HEIGHT)
    np.testing.assert_array_equal(again, whole)


@pytest.mark.parametrize("offset", [(0.0, 0.0), (0.15, -0.1)])
@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
def test_through_the_camera_the_renders_border_counts(view, kind, offset):
    """It shows what a final render of that border shows, to the pixel of the view in which the border's edges lie."""
    from opal_kernels import camera as optics

    scene = bpy.context.scene
    scene.camera.data.type, scene.camera.data.ortho_scale = kind, 3.6
    view.space_data.use_render_border = True  # that of free views, whose numbers are not even there
    view.region_data.view_perspective, view.region_data.view_camera_offset = "CAMERA", offset
    place, whole = view.picture()
    assert place == (0, 0, WIDTH, HEIGHT)
    view.mark(0.5, 0.8, 0.25, 1.0)
    place, part = view.picture()
    assert_like_the_whole(place, part, whole)
    shown = np.array(view.shown._worker._camera.window)
    frame = optics.window(300, 100, **({"lens": 50.0} if kind == "PERSP" else {"ortho_scale": 3.6}))
    final = np.array(optics.window_of_region(frame, 300, 100, (150, 25, 240, 100)))
    pixel = (shown[1] - shown[0]) / (place[2] - place[0])
    assert np.all(final - shown > -1e-9) and np.all(final - shown < pixel), (final - shown) / pixel


def test_a_border_beyond_the_view_leaves_what_is_seen_of_it(view):
    view.region_data.view_perspective, view.region_data.view_camera_zoom = "CAMERA", 200.0
    _, whole = view.picture()
    view.mark(0.5, 1.0, 0.0, 1.0)
    place, part = view.picture()
    assert place == (WIDTH / 2, 0, WIDTH, HEIGHT)
    assert_like_the_whole(place, part, whole)


def test_the_least_border_is_a_pixel(view):
    view.mark(0.5, 0.5, 1.0, 1.0)
    place, part = view.picture()
    assert place == (30, 39, 31, 40) and part.shape == (1, 1, 4)


def test_a_picture_keeps_its_place_until_there_is_another(view, monkeypatch):
    """What was drawn over the whole view is not squeezed into the border while that has no picture."""
    _, whole = view.picture()

    class Waiting:
        picture, failure, done, total = None, "", 0, 1

        def __init__(self, *_arguments):
            pass

        def stop(self):
            pass

    monkeypatch.setattr(stage.addon("viewport"), "Worker", Waiting)
    view.mark(0.0, 0.5, 0.0, 0.5)
    view.shown.draw(view, bpy.context.evaluated_depsgraph_get())
    place, shown = view.drawn[-1]
    assert place == (0, 0, WIDTH, HEIGHT)
    np.testing.assert_array_equal(shown, whole)
    view.shown._worker.picture = whole[: HEIGHT // 2, : WIDTH // 2].copy()
    view.shown.draw(view, bpy.context.evaluated_depsgraph_get())
    assert view.drawn[-1][0] == (0, 0, WIDTH / 2, HEIGHT / 2)
