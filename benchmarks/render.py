# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal's measurements: ratios taken in one run on one machine, each with the error reached.

    make bench                                 all that needs no peers: cycles, speed, start
    make bench ARGS="caustics"                 beside LuxCore and Mitsuba: pip install -r benchmarks/requirements.txt first
    make bench ARGS="cycles --repeats 5 --json build/bench.json"

Sub-commands: `cycles` (time to Cycles' error at 64 samples), `examples` (the examples by `opal.compare_cycles`), `caustics` (prism
and brilliant, time to relative MSE 0.01), `gems` (what dispersion costs, and its chroma), `speed` (rays, photons, building), `start`
(import, enable), `viewport` (first image, refinements, edits, F12, memory beside Cycles), `media` (the fog box of the report,
the three volume estimates, the fog box beside Cycles), `media-examples` (the three on the examples of media), `clouds`
(a cloud of noise beside Cycles), `rainbows` (Lorenz-Mie tables beside miepython and scattnlay), `double-bow` (seconds and noise of a
double bow over a landscape). Run it on a machine that does nothing else.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent


def _inside_blender(what: str, options) -> list[dict]:
    """What needs the installed extension: this script again, inside `tools/with_extension.py`."""
    out = ROOT / "build" / f"bench-{what}.json"
    command = [sys.executable, str(ROOT / "tools" / "with_extension.py"), str(HERE / "render.py"), what, "--inside", "--json", str(out)]
    subprocess.run(
        [
            *command,
            "--repeats",
            str(options.repeats),
            "--reference-samples",
            str(options.reference_samples),
            "--seconds",
            str(options.seconds),
        ],
        check=True,
    )
    return json.loads(out.read_text())[what]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "what",
        nargs="*",
        help="cycles, examples, caustics, gems, media, media-examples, clouds, speed, start, viewport, rainbows, double-bow; cycles, speed and start when left out",
    )
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=30.0, help="of each run of caustics, media and media-examples")
    parser.add_argument("--reference-seconds", type=float, default=300.0, help="of the references of caustics, made once")
    parser.add_argument("--reference-samples", type=int, default=4096, help="of the references of cycles")
    parser.add_argument("--scenes", nargs="+", default=["prism", "brilliant"], help="of caustics")
    parser.add_argument("--json", type=Path, help="also write the records there")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    found = {}
    for what in options.what or ["cycles", "speed", "start"]:
        if what in {"cycles", "examples", "media-examples", "clouds", "double-bow"} and not options.inside:
            found[what] = _inside_blender(what, options)
        elif what == "cycles":
            import against_cycles

            found[what] = [*against_cycles.measure(options.repeats, options.reference_samples), against_cycles.translation()]
            against_cycles.report(found[what])
        elif what == "examples":
            import examples_beside_cycles

            found[what] = examples_beside_cycles.measure()
            examples_beside_cycles.report(found[what])
        elif what == "viewport":
            import viewport

            found[what] = viewport.measure(options.repeats) if options.inside else viewport.memory()
            viewport.report(found[what])
            if not options.inside:
                found[what] += _inside_blender(what, options)
        elif what == "media":
            import media

            found[what] = (
                media.beside_cycles(options.repeats, options.reference_samples) if options.inside else media.measure(options.seconds)
            )
            media.report(found[what])
            if not options.inside:
                found[what] += _inside_blender(what, options)
        elif what == "media-examples":
            import media_examples

            found[what] = media_examples.measure(options.seconds)
            media_examples.report(found[what])
        elif what == "clouds":
            import clouds

            found[what] = clouds.measure()
            clouds.report(found[what])
        elif what == "caustics":
            import caustics

            found[what] = caustics.measure(options.scenes, options.seconds, options.repeats, options.reference_seconds)
            caustics.report(found[what])
        elif what == "speed":
            import rays

            found[what] = rays.measure(options.repeats)
            rays.report(found[what])
        elif what == "start":
            import startup

            found[what] = startup.measure(max(5, options.repeats))
            startup.report(found[what])
        elif what == "rainbows":
            import rainbows

            found[what] = rainbows.measure()
            rainbows.report(found[what])
        elif what == "double-bow":
            import double_bow

            found[what] = double_bow.measure_all()
            double_bow.report(found[what])
        elif what == "gems":
            import gems

            found[what] = gems.measure(options.scenes, options.seconds, options.repeats, options.reference_seconds)
            gems.report(found[what])
        else:
            known = "cycles, examples, caustics, gems, media, media-examples, clouds, speed, start, viewport, rainbows or double-bow"
            parser.error(f"there is no {what}: {known}")
    if options.json:
        options.json.parent.mkdir(parents=True, exist_ok=True)
        options.json.write_text(json.dumps(found, indent=1))


if __name__ == "__main__":
    sys.path.insert(0, str(HERE))
    main()
