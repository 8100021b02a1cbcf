# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender finds Opal's German, which is complete for panels and settings, and says nothing that Opal no longer says."""

import sys
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")
sys.path.append(str(Path(__file__).resolve().parents[2] / "tools"))


@pytest.fixture
def messages():
    import list_untranslated

    return list_untranslated


@pytest.fixture
def german(messages):
    return messages.dictionary("de_DE")


def test_no_translation_is_of_something_that_is_no_longer_said(messages, german):
    assert sorted(german.keys() - messages.every_message()) == []


def test_german_is_complete_for_labels_of_panels_and_names_of_operators(messages, german):
    names = {m for m in messages.operators() if m[0] == messages.OPERATOR}
    assert sorted((messages.panels() | messages.texts() | names) - german.keys()) == []


def test_german_is_complete_for_names_and_tooltips_of_settings(messages, german):
    wanted = set()
    for rna in messages.groups():
        for prop in rna.properties:
            if prop.identifier not in {"rna_type", "name"} and not prop.is_hidden and prop.type != "POINTER":
                wanted |= {(messages.NONE, prop.name), (messages.NONE, prop.description)}
    assert sorted(wanted - german.keys()) == []


def test_every_tooltip_is_another_sentence_than_the_english_one(german):
    assert [english for (_, english), text in german.items() if len(english) > 30 and text == english] == []


def test_blender_shows_the_german_and_forgets_it_when_the_extension_goes(monkeypatch):
    translations = stage.addon("translations")
    view = bpy.context.preferences.view
    before = view.language
    try:
        view.language = "de_DE"
    except TypeError:
        pytest.skip("this Blender is built without languages")
    try:
        view.use_translate_interface = view.use_translate_tooltips = True
        translate = bpy.app.translations.pgettext_iface
        if bpy.app.translations.locale != "de_DE":
            pytest.skip("this Blender has no German")
        assert translate("Photons Carry") == "Photonen tragen"
        assert translate("Rainbow Chart", "Operator") == "Regenbogentafel"
        assert "Regenbogen" in bpy.app.translations.pgettext_tip(
            "Keeps light that a medium or a rainbow scattered or gave off towards the camera"
        )
        translations.unregister()
        try:
            assert translate("Photons Carry") == "Photons Carry"
        finally:
            translations.register()
    finally:
        view.language = before
