"""``ocularist still``: one frame of any pair of eyes, without a study."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Final

from study.commands.errors import CommandError
from study.commands.eye_arguments import add_picture
from study.commands.eye_options import spec_of, viewpoint_of

HELP = "render one frame"
DESCRIPTION = (
    "Render one frame of a pair of eyes. Left and right are the viewer's, as seen on the screen. "
    "Every effect can be set on its own (--effect reflection=low, --effect left.caustics=off) or "
    "shown alone (--only-effect caustics). A file named .exr gets linear radiance."
)
KINDS: Final = (".png", ".exr")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_picture(parser)
    parser.add_argument("--wireframe", action="store_true", help="draw the eyes' meshes as lines")
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("out/still.png"),
        metavar="FILE",
        help="where to write the picture: .png as shown, .exr linear radiance without exposure, "
        "bloom and tone curve (default: %(default)s)",
    )


def run(options: argparse.Namespace) -> int:
    """Render the frame and write it."""
    if options.out.suffix not in KINDS:
        raise CommandError(
            f'{options.out}: unknown kind of picture "{options.out.suffix}"; {" or ".join(KINDS)}'
        )
    spec = spec_of(options)

    from renderer.still import write_still

    viewpoint = viewpoint_of(options, spec)
    write_still(options.out, spec, **viewpoint, wireframe=options.wireframe)
    print(options.out)
    return 0
