# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of a render that came to none: transparent black.

Blender allocates a layer's pictures when an engine hands back a result. Without any it still writes a file, or saves one from the image
editor, and as OpenEXR that ends Blender (seen in 5.2.3). Nothing here needs the kernels, which may be what did not load.
"""

from __future__ import annotations

from typing import Any


def hand_back(engine: Any, depsgraph: Any) -> None:
    """Gives Blender an empty picture of the view layer that is being rendered; it cuts the frame to the border itself."""
    result = engine.begin_result(0, 0, engine.resolution_x, engine.resolution_y, layer=depsgraph.view_layer.name)
    engine.end_result(result, cancel=False, do_merge_results=False)
