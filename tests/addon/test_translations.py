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


def test_german_is_complete_for_everything_that_the_interface_says(messages, german):
    """Names, tooltips and choices of settings and operators, labels of panels, texts of layouts, tables of stones, media and bows."""
    assert len(messages.every_message()) > 450, "messages are found where they are said"
    assert sorted(messages.every_message() - german.keys()) == []


def test_a_choice_without_german_is_found(messages, german):
    """The test above fails where one is missing: of each kind of message one is looked for."""
    wanted = messages.every_message()
    for english in ("Gaussian", "All drops alike", "Ruby", "Round Brilliant", "Whole Milk", "Fogbow", "Pavilion Angle", "Photons Carry"):
        assert (messages.NONE, english) in wanted, english


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
        assert translate("All drops alike") == "Alle Tropfen gleich"
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
