# SPDX-License-Identifier: GPL-3.0-or-later
"""What every test with Blender stands on: the built zip, installed into an empty profile by Blender's own installer.

`make test` builds the zip. Without bpy or without a zip the tests that need them are skipped, and say so.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = "bl_ext.user_default.opal"

# Blender reads this when bpy is imported, so it has to stand before any test module is.
_profile = tempfile.TemporaryDirectory(prefix="opal-profile-")
os.environ["BLENDER_USER_RESOURCES"] = _profile.name


def _install():
    """Installs and enables the zip; returns the extension's package."""
    import bpy

    zips = sorted((ROOT / "dist").glob("opal-*.zip"))
    if not zips:
        return None
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.extensions.package_install_files(filepath=str(zips[-1]), repo="user_default", enable_on_install=True)
    package = sys.modules.get(PACKAGE)
    if package is not None:
        import opal_kernels  # noqa: F401  (the zip's wheel, before any test puts the sources on the path)

        sys.modules["opal_source"] = package  # what tests of single modules import them from
    return package


def pytest_configure(config):
    # Test modules of the add-on import from the extension at collection: it is installed before.
    if not any("kernels" not in str(a) for a in (config.args or ["tests"])):
        return
    try:
        import bpy  # noqa: F401
    except ImportError:
        return
    config.opal = _install()


@pytest.fixture(scope="session")
def opal(request):
    """The installed and enabled extension (its root package)."""
    package = getattr(request.config, "opal", None)
    if package is None:
        pytest.skip("the extension's zip is not built or bpy is not installed: run `make test`")
    return package


@pytest.fixture(autouse=True)
def _fresh_file(request):
    """An empty file before every test that uses Blender; preferences, and with them the extension, stay."""
    if "kernels" in Path(request.node.fspath).parts or getattr(request.config, "opal", None) is None:
        yield
        return
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    yield


@pytest.fixture
def render(opal, tmp_path):
    """render(scene, engine, size, samples, seed=1) -> float32 (height, width, 4), rows from the bottom up, scene-linear."""
    import bpy

    def run(scene, engine, size, samples, seed=1):
        settings = scene.render
        settings.engine = engine
        settings.resolution_x, settings.resolution_y = size
        settings.resolution_percentage = 100
        if engine == "CYCLES":
            cycles = scene.cycles
            cycles.samples, cycles.seed, cycles.device = samples, seed, "CPU"
            cycles.use_adaptive_sampling = cycles.use_denoising = False
            cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
        else:
            scene.opal.samples_per_pass = min(16, samples)
            scene.opal.passes = max(1, samples // scene.opal.samples_per_pass)
            scene.opal.seed = seed
            scene.opal.denoise = False
        image_settings = settings.image_settings
        if hasattr(image_settings, "media_type"):
            image_settings.media_type = "IMAGE"
        image_settings.file_format, image_settings.color_depth = "OPEN_EXR", "32"
        settings.filepath = str(tmp_path / f"{engine.lower()}.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(settings.filepath, check_existing=False)
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
        return pixels.reshape(size[1], size[0], 4)

    return run


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session, exitstatus):
    session.config.opal_exit_status = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config):
    # bpy 4.5 hangs at its own end after an add-on was enabled by the installer: leave without it.
    if getattr(config, "opal", None) is None:
        return
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    if reporter is not None:
        reporter._tw.flush()
    sys.stdout.flush()
    sys.stderr.flush()
    _profile.cleanup()
    os._exit(getattr(config, "opal_exit_status", 1))
