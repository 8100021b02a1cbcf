# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of a file's images are Opal's, and whose: these, and no others, may be written over.

An image is known by a custom property, not by its name, which a stranger may have. It belongs to a scene, or, where a scene has
several view layers, to one of them, and keeps its plain name unless another scene's has it: then the owner stands behind it.
Panels ask here as well, so nothing is loaded that takes time.
"""

from __future__ import annotations

from typing import Any

import bpy

# Custom properties of data-blocks that Opal made.
KEY, NAME_KEY, OWNER_KEY = "opal_picture", "opal_name", "opal_owner"


def owner_of(scene: Any, layer: Any) -> str:
    """Whose pictures those of a view layer are."""
    return scene.name if len(scene.view_layers) == 1 else f"{scene.name}, {layer.name}"


def belongs(made: Any, owner: str) -> bool:
    """Whether a data-block that Opal made may be written over for this owner: it is his, or nobody's any more."""
    other = made.get(OWNER_KEY, owner)
    return other == owner or all(other != owner_of(scene, layer) for scene in bpy.data.scenes for layer in scene.view_layers)


def own(name: str, owner: str) -> Any:
    """Opal's image of that name for an owner, whatever Blender made of the name; None where there is none."""
    found = [image for image in bpy.data.images if image.library is None and image.get(KEY) is not None and _is_called(image, name)]
    return next((image for image in found if image.get(OWNER_KEY) == owner), next((i for i in found if belongs(i, owner)), None))


def name_for(name: str, owner: str, others: Any) -> str:
    """The name of something new: with its owner, where something of Opal's with this name is another's."""
    taken = any(other.get(OWNER_KEY) is not None and _is_called(other, name) for other in others)
    return f"{name} ({owner})" if taken else name


def _is_called(made: Any, name: str) -> bool:
    called = made.get(NAME_KEY)
    return called == name if called is not None else name in (made.name, made.name.rsplit(".", 1)[0])
