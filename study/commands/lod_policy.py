"""``ocularist lod-policy``: measure from which size on each LoD shows, and write the policy."""

from __future__ import annotations

import argparse

from study.commands.places import new_file

HELP = "measure from which size on each LoD shows"
DESCRIPTION = (
    "Render both eyes with every LoD at many sizes, find the largest at which each cannot be told "
    "from ultra, and write the thresholds in pixels as a LoD policy (docs/lod-by-pixels.md). Takes "
    "about ten minutes without a GPU."
)
EXAMPLE = "--out lod_policy.json"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    parser.add_argument(
        "--out",
        type=new_file,
        default="out/lod_policy.json",
        metavar="FILE",
        help="where to write the policy (default: %(default)s)",
    )


def run(options: argparse.Namespace) -> int:
    """Measure, write the file and say what it holds."""
    from renderer.lod.error import derive
    from renderer.lod.policy import write_policy
    from renderer.studio import Studio

    studio = Studio()
    try:
        file = derive(studio, progress=lambda what: print(f"measuring: {what}"))
    finally:
        studio.close()
    write_policy(file, options.out)
    for step in file.policy.steps:
        limit = "any size" if step.up_to_iris_px is None else f"{step.up_to_iris_px:g} px"
        print(f"{step.lod:8} up to {limit}")
    print(options.out)
    return 0
