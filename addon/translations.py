# SPDX-License-Identifier: GPL-3.0-or-later
"""Other languages, the way extensions give them to Blender: a dictionary by language of (context, English) to text.

A language's modules in this folder hold `LABELS`, `TOOLTIPS`, `OPERATORS`, `CHOICES` and `NAMES`; `DICTIONARY` joins them.
"""

from __future__ import annotations

import bpy

from . import translations_german as german
from . import translations_german_choices as german_choices

_NONE, _OPERATOR = "*", "Operator"
DICTIONARY: dict[str, dict[tuple[str, str], str]] = {
    "de_DE": {
        (_NONE, english): text
        for english, text in (german_choices.NAMES | german_choices.CHOICES | german.LABELS | german.TOOLTIPS).items()
    }
    | {(_OPERATOR, english): text for english, text in german.OPERATORS.items()},
}


def register() -> None:
    bpy.app.translations.register(__package__, DICTIONARY)


def unregister() -> None:
    bpy.app.translations.unregister(__package__)
