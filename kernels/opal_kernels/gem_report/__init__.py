# SPDX-License-Identifier: GPL-3.0-or-later
"""A stone judged as gemmologists do: face-up under a bright hemisphere, with the shadow of the observer's head.

`stone.py` holds the stone, `stone_rays.py` follows the eye's rays through it, `measures.py` makes numbers of them, `pictures.py` renders
it with the tracer and `sheet.py` draws the page.
"""

from .measures import HEAD_ANGLE, Cancelled, Report, measure
from .pictures import face_up, flashes
from .sheet import draw, table
from .stone import FacetedStone

__all__ = ["HEAD_ANGLE", "Cancelled", "FacetedStone", "Report", "draw", "face_up", "flashes", "measure", "table"]
