"""The arguments of one picture: which eyes, in what light, from where.

A still and an exported scene take the same ones, so that one shows what the other holds.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from study.commands.eye_options import SIDES, effect_level, iris
from study.commands.values import count, number, size, whole_number


def add_picture(parser: argparse.ArgumentParser) -> None:
    """Add everything that ``eye_options.spec_of`` and ``viewpoint_of`` read."""
    _add_lods(parser)
    _add_view(parser)
    _add_eyes(parser)
    _add_surroundings(parser)


def add_lod_policy(parser: argparse.ArgumentParser, *, used_by: str) -> None:
    """Add the option that ``eye_options.policy_of`` reads."""
    parser.add_argument(
        "--lod-policy",
        type=Path,
        metavar="FILE",
        help=f"{used_by}: another policy, as lod-policy or analyse write it",
    )


def _add_lods(parser: argparse.ArgumentParser) -> None:
    from renderer.clip_values import PRESETS
    from renderer.detail import LEVELS

    for side in SIDES:
        parser.add_argument(
            f"--{side}",
            choices=LEVELS,
            default="ultra",
            metavar="LOD",
            help=f"LoD of the {side} eye: {', '.join(LEVELS)} (default: %(default)s)",
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
    parser.add_argument("--preset", choices=PRESETS, help="how effects are balanced")


def _add_view(parser: argparse.ArgumentParser) -> None:
    from renderer.clip_values import DISTANCES

    parser.add_argument(
        "--distance",
        choices=DISTANCES,
        default="macroscopic",
        help="viewing distance (default: %(default)s)",
    )
    parser.add_argument(
        "--azimuth",
        type=number,
        default=0.0,
        metavar="DEG",
        help="camera to the viewer's right of the face, in degrees (default: %(default)g)",
    )
    parser.add_argument(
        "--elevation", type=number, default=0.0, metavar="DEG", help="camera above the eyes"
    )
    parser.add_argument(
        "--frame", type=count, metavar="N", help="the N-th frame of the clip instead of --azimuth"
    )
    parser.add_argument(
        "--size", type=size, default=(1920, 1080), metavar="WIDTHxHEIGHT", help="picture size"
    )


def _add_eyes(parser: argparse.ArgumentParser) -> None:
    from renderer.clip_values import CAUSTIC_PATTERNS, CUBE_SIZES

    parser.add_argument(
        "--gaze",
        nargs=2,
        type=number,
        default=(0.0, 0.0),
        metavar=("YAW", "PITCH"),
        help="direction of both eyes in degrees, to the viewer's right and up",
    )
    parser.add_argument(
        "--vergence", type=number, default=0.0, metavar="DEG", help="angle between the two gazes"
    )
    parser.add_argument(
        "--blink",
        type=number,
        default=0.0,
        metavar="SHARE",
        help="how far the lids are closed, 0 (default) to 1",
    )
    parser.add_argument(
        "--subsurface-samples",
        type=whole_number,
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
        "--cube-size",
        choices=CUBE_SIZES,
        default="table",
        help="auto: mirror cubes no finer than the cornea shows (default: %(default)s)",
    )
    parser.add_argument(
        "--iris",
        type=iris,
        default={},
        metavar="SEED|COLOUR|SEED:COLOUR|FILE",
        help="which iris, such as 7, brown or 7:brown, or a file from ocularist iris",
    )
    parser.add_argument("--pupil", type=number, metavar="MM", help="diameter of the pupil in mm")


def _add_surroundings(parser: argparse.ArgumentParser) -> None:
    from renderer.clip_values import CROWDS

    parser.add_argument(
        "--environment",
        type=Path,
        metavar="FILE",
        help="an HDR picture of the surroundings instead of the park: latitude-longitude, .exr or "
        ".hdr; its middle lies before the face, its sun casts the shadows",
    )
    parser.add_argument(
        "--environment-turn",
        type=number,
        metavar="DEG",
        help="turn that picture to the viewer's right",
    )
    parser.add_argument(
        "--environment-exposure",
        type=number,
        metavar="EV",
        help="brighten that picture, in stops; 0 (default): a white ball's brightest side is white",
    )
    parser.add_argument(
        "--sun",
        nargs=2,
        type=number,
        metavar=("AZIMUTH", "ELEVATION"),
        help="direction of the park's sun in degrees",
    )
    parser.add_argument(
        "--crowd", type=whole_number, choices=CROWDS, help="number of other characters in the scene"
    )
