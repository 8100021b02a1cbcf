"""Build and validate the extension's zip with Blender's own builder, the one inside the bpy wheel.

    python tools/build_extension.py OUTPUT_FOLDER

Prints the path of the zip last.
"""

import importlib.util
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def builder() -> Path:
    """Blender's `blender_ext.py`, found without importing bpy (which takes a second)."""
    spec = importlib.util.find_spec("bpy")
    if spec is None:
        raise SystemExit("bpy is not installed in this Python: run `make zip`.")
    (script,) = Path(spec.origin).parent.glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py")
    return script


def main() -> None:
    output = Path(sys.argv[1]).resolve()
    output.mkdir(parents=True, exist_ok=True)
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
    missing = [wheel for wheel in manifest["wheels"] if not (ROOT / wheel).is_file()]
    if missing:
        there = ", ".join(path.name for path in (ROOT / "wheels").glob("*.whl")) or "nothing"
        raise SystemExit(f"blender_manifest.toml names {', '.join(missing)}, but wheels/ holds {there}.")

    # The manifest names whole folders, and in Blender's patterns what is named wins over what is excluded inside it.
    for folder in ("addon", "operators"):
        for cache in list((ROOT / folder).rglob("__pycache__")):
            shutil.rmtree(cache, ignore_errors=True)

    archive = output / f"{manifest['id']}-{manifest['version']}.zip"
    archive.unlink(missing_ok=True)
    for arguments in (
        ["build", "--source-dir", str(ROOT), "--output-filepath", str(archive)],
        ["validate", str(archive)],
    ):
        done = subprocess.run([sys.executable, str(builder()), *arguments], capture_output=True, text=True)
        if done.returncode:
            raise SystemExit(f"Blender's builder refused to {arguments[0]}:\n{done.stdout}{done.stderr}")
    print(archive)


if __name__ == "__main__":
    main()
