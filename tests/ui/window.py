# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scripts that drive a window share: steps with pauses, real keys, screenshots, and what a picture shows.

A script's steps are a generator; each yields the seconds that Blender gets for itself before the next. Keys and the mouse come
from the display (xdotool), as an artist's do.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
import numpy as np

PACKAGE = "bl_ext.user_default.opal"
ZIP, FOLDER = sys.argv[-2], Path(sys.argv[-1])
RESULT: dict[str, object] = {"blender": bpy.app.version_string, "python": sys.version.split()[0]}


def install() -> None:
    """The preferences' operator Install from Disk."""
    bpy.ops.extensions.package_install_files(filepath=ZIP, repo="user_default", enable_on_install=True)
    RESULT["enabled"] = PACKAGE in bpy.context.preferences.addons


def write() -> None:
    """Keeps what was found."""
    (FOLDER / "result.json").write_text(json.dumps(RESULT, indent=1))


def run(steps: Iterator[float]) -> None:
    """Takes the steps one by one, then quits Blender; an exception ends them and is written down."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    preferences = bpy.context.preferences
    preferences.view.show_splash = False
    preferences.view.render_display_type = "AREA"  # no window manager here to raise a second window
    preferences.view.use_save_prompt = False

    def step():
        try:
            return next(steps)
        except StopIteration:
            pass
        except Exception:
            RESULT["error"] = traceback.format_exc()
            screenshot("error")
        write()
        bpy.ops.wm.quit_blender()
        return None

    bpy.app.timers.register(step, first_interval=1.0)


def until(condition: Callable[[], bool], seconds: float, what: str) -> Iterator[float]:
    """Waits for a condition; RuntimeError with `what` when it does not come."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise RuntimeError(f"{what}: not within {seconds} s")
        yield 0.05


def seen(name: str, box: tuple, is_there: Callable[[dict], bool], seconds: float = 40.0) -> Iterator[float]:
    """Takes screenshots until what a part of one shows (`tones`) is as expected; the last one is kept, and in the result.

    A busy machine takes its time; what must be fast is measured apart.
    """
    end = time.monotonic() + seconds
    while True:
        found = RESULT[name] = tones(screenshot(name), box)
        if is_there(found) or time.monotonic() > end:
            return
        yield 1.0


# ---- Where things are ----


def window():
    """The first window."""
    return bpy.context.window_manager.windows[0]


def area(kind: str):
    """The largest editor of a kind."""
    return max((a for a in window().screen.areas if a.type == kind), key=lambda a: a.width * a.height)


def show_tab(context: str) -> None:
    """Turns the properties editor to a tab."""
    editor = area("PROPERTIES")
    editor.spaces.active.context = context
    editor.tag_redraw()


def box_of(editor) -> tuple[float, float, float, float]:
    """Left, bottom, right, top of an editor's main region as fractions of the screen."""
    region = next(r for r in editor.regions if r.type == "WINDOW")
    width, height = window().width, window().height
    return region.x / width, region.y / height, (region.x + region.width) / width, (region.y + region.height) / height


# ---- Keys and mouse ----


def point_at(editor, x: float = 0.5, y: float = 0.5) -> None:
    """Moves the mouse into an editor, fractions from its left and bottom, and gives the window the keys."""
    region = next(r for r in editor.regions if r.type == "WINDOW")
    left, top = region.x + x * region.width, window().height - region.y - y * region.height
    found = subprocess.run(["xdotool", "search", "--onlyvisible", "--class", "Blender"], capture_output=True, text=True).stdout.split()
    for name in found[:1]:
        subprocess.run(["xdotool", "windowfocus", name], check=True)
    for shift in (3, 0):  # a move that is none is no event
        subprocess.run(["xdotool", "mousemove", str(int(left) + shift), str(int(top))], check=True)


# xdotool reaches these by their names through a level of the key that holds Alt: by its number a key is itself alone.
_NUMBERS = {"F3": "69", "F12": "96"}


def press(key: str) -> None:
    """Presses a key by X's name (`F12`, `Escape`, `shift+a`)."""
    subprocess.run(["xdotool", "key", _NUMBERS.get(key, key)], check=True)


def click() -> None:
    """Presses and lets go of the left button where the mouse is."""
    subprocess.run(["xdotool", "mousedown", "1"], check=True)
    time.sleep(0.02)
    subprocess.run(["xdotool", "mouseup", "1"], check=True)


def write_text(text: str) -> None:
    """Types letters."""
    subprocess.run(["xdotool", "type", "--delay", "60", text], check=True)


# ---- Pictures ----


def screenshot(name: str, box: tuple[int, int, int, int] | None = None) -> Path:
    """The screen, or its pixels left, bottom, right, top, as the display holds it: under software OpenGL Blender's own screenshot reads
    an empty front buffer."""
    path = FOLDER / f"{name}.png"
    part = []
    if box is not None:
        left, bottom, right, top = box
        part = ["-crop", f"{right - left}x{top - bottom}+{left}+{window().height - top}", "+repage"]
    subprocess.run(["import", "-window", "root", *part, str(path)], check=True)
    return path


def pixels(path: Path, box: tuple[float, float, float, float] = (0, 0, 1, 1)) -> np.ndarray:
    """Display values (height, width, 3) of a picture's part (left, bottom, right, top as fractions), rows from the bottom up."""
    image = bpy.data.images.load(str(path), check_existing=False)
    width, height = image.size
    values = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    left, bottom, right, top = box
    return values.reshape(height, width, 4)[int(bottom * height) : int(top * height), int(left * width) : int(right * width), :3]


def tones(path: Path, box: tuple[float, float, float, float] = (0, 0, 1, 1)) -> dict[str, float]:
    """Size of a picture; mean, spread, grain (difference of neighbours) and colourfulness of its part's display values."""
    whole, part = pixels(path), pixels(path, box)
    return {
        "width": whole.shape[1],
        "height": whole.shape[0],
        "mean": float(part.mean()),
        "spread": float(part.std()),
        "red": float(part[..., 0].mean()),
        "green": float(part[..., 1].mean()),
        "grain": float(np.abs(np.diff(part, axis=1)).mean()),
        "colourful": float(np.ptp(part, axis=-1).max()),
    }


def blocks(path: Path, box: tuple[float, float, float, float], rows: int = 6, columns: int = 8) -> list[list[float]]:
    """Means of a picture's part over a grid of blocks, rows from the bottom up: what stands where, whatever the font or the grain."""
    grey = pixels(path, box).mean(axis=-1)
    return [[round(float(b.mean()), 4) for b in np.array_split(row, columns, axis=1)] for row in np.array_split(grey, rows, axis=0)]
