"""``ocularist still``: one frame of any pair of eyes, without a study."""

from __future__ import annotations

import argparse
from pathlib import Path

from study.commands.errors import CommandError
from study.commands.eye_options import SIDES, effect_level, iris, spec_of
from study.commands.options import count, size

HELP = "render one frame"
DESCRIPTION = (
    "Render one frame of a pair of eyes. Left and right are the viewer's, as seen on the screen. "
    "Every effect can be set on its own (--effect reflection=low, --effect left.caustics=off) or "
    "shown alone (--only-effect caustics)."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    from renderer.clip import CAUSTIC_PATTERNS, CROWDS, DISTANCES, PRESETS
    from renderer.detail import LEVELS

    levels = ", ".join(LEVELS)
    parser.add_argument(
        "--distance",
        choices=DISTANCES,
        default="macroscopic",
        help="viewing distance (default: %(default)s)",
    )
    for side in SIDES:
        parser.add_argument(
            f"--{side}",
            choices=LEVELS,
            default="ultra",
            metavar="LOD",
            help=f"LoD of the {side} eye: {levels} (default: %(default)s)",
        )
    parser.add_argument(
        "--effect",
        action="append",
        type=effect_level,
        default=[],
        metavar="NAME=LEVEL",
        help="set one effect's level in both eyes, or in one: left.NAME=LEVEL; repeatable",
    )
    parser.add_argument(
        "--only-effect",
        action="append",
        default=[],
        metavar="NAME",
        help="keep this effect and switch the others off; repeatable",
    )
    parser.add_argument(
        "--azimuth",
        type=float,
        default=0.0,
        metavar="DEG",
        help="camera to the viewer's right of the face, in degrees (default: %(default)g)",
    )
    parser.add_argument(
        "--elevation", type=float, default=0.0, metavar="DEG", help="camera above the eyes"
    )
    parser.add_argument(
        "--gaze",
        nargs=2,
        type=float,
        default=(0.0, 0.0),
        metavar=("YAW", "PITCH"),
        help="direction of both eyes in degrees, to the viewer's right and up",
    )
    parser.add_argument(
        "--vergence", type=float, default=0.0, metavar="DEG", help="angle between the two gazes"
    )
    parser.add_argument(
        "--blink",
        type=float,
        default=0.0,
        metavar="SHARE",
        help="how far the lids are closed, 0 (default) to 1",
    )
    parser.add_argument(
        "--subsurface-samples",
        type=int,
        default=0,
        metavar="N",
        help="the thesis's own sum with 2 to 200 samples instead of our integrator (0, default)",
    )
    parser.add_argument(
        "--caustic-pattern",
        choices=CAUSTIC_PATTERNS,
        default="computed",
        help="painted: the thesis's artist's map (default: %(default)s)",
    )
    parser.add_argument(
        "--iris",
        type=iris,
        default={},
        metavar="SEED|COLOUR|SEED:COLOUR",
        help="which iris, such as 7, brown or 7:brown",
    )
    parser.add_argument("--pupil", type=float, metavar="MM", help="diameter of the pupil in mm")
    parser.add_argument(
        "--sun",
        nargs=2,
        type=float,
        metavar=("AZIMUTH", "ELEVATION"),
        help="direction of the sun in degrees",
    )
    parser.add_argument(
        "--crowd", type=int, choices=CROWDS, help="number of other characters in the scene"
    )
    parser.add_argument("--preset", choices=PRESETS, help="how effects are balanced")
    parser.add_argument(
        "--frame", type=count, metavar="N", help="the N-th frame of the clip instead of --azimuth"
    )
    parser.add_argument(
        "--size", type=size, default=(1920, 1080), metavar="WIDTHxHEIGHT", help="picture size"
    )
    parser.add_argument("--wireframe", action="store_true", help="draw the eyes' meshes as lines")
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("out/still.png"),
        metavar="FILE.png",
        help="where to write the picture (default: %(default)s)",
    )


def run(options: argparse.Namespace) -> int:
    """Render the frame and write it."""
    if options.out.suffix != ".png":
        raise CommandError(f'{options.out}: unknown kind of picture "{options.out.suffix}"; .png')
    spec = spec_of(options)

    from PIL import Image

    from renderer.still import render_still

    azimuth_deg, time_s = options.azimuth, 0.0
    if options.frame is not None:
        azimuth_deg, time_s = spec.azimuth_deg(options.frame - 1), spec.time_s(options.frame - 1)
    pixels = render_still(
        spec,
        azimuth_deg,
        elevation_deg=options.elevation,
        time_s=time_s,
        wireframe=options.wireframe,
    )
    options.out.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(pixels).save(options.out)
    print(options.out)
    return 0
