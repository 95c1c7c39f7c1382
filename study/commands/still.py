"""``ocularist still``: one frame of any pair of eyes, without a study."""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from study.commands.errors import CommandError
from study.commands.eye_arguments import add_lod_policy, add_picture
from study.commands.eye_options import policy_of, spec_of, viewpoint_of
from study.commands.places import new_file
from study.commands.values import number

if TYPE_CHECKING:
    from renderer.clip import ClipSpec
    from renderer.lod.choice import LodPolicy

HELP = "render one frame"
DESCRIPTION = (
    "Render one frame of a pair of eyes. Left and right are the viewer's, as seen on the screen. "
    "Every effect can be set on its own (--effect reflection=low, --effect left.caustics=off) or "
    "shown alone (--only-effect caustics). A file named .exr gets linear radiance."
)
EXAMPLE = "--distance near --left low --right ultra --out near.png"
KINDS: Final = (".png", ".exr")
VIEWS: Final = ("face", "crowd")
GROUP: Final = 30  # people in the crowd's view unless --crowd says otherwise


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_picture(parser)
    parser.add_argument(
        "--iris-px",
        type=number,
        metavar="PX",
        help="instead of --distance: one camera, as far off as makes an iris this wide on 1080 "
        "lines, at most 243",
    )
    parser.add_argument(
        "--switching",
        choices=("blended", "instant"),
        help="take both eyes' LoDs from their size in pixels, by Ocularist's own policy",
    )
    add_lod_policy(parser, used_by="with --switching or --view crowd")
    parser.add_argument(
        "--view",
        choices=VIEWS,
        default="face",
        help="crowd: the other characters alone, in rows before a wide lens, each eye at the LoD "
        "of its size; --crowd says how many (default: %(default)s)",
    )
    parser.add_argument("--wireframe", action="store_true", help="draw the eyes' meshes as lines")
    parser.add_argument(
        "--out",
        type=new_file,
        default="out/still.png",
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
    is_group = options.view == "crowd"
    if is_group:
        _check_group(options)
    elif options.lod_policy is not None and options.switching is None:
        raise CommandError("--lod-policy: says where eyes switch; add --switching, or --view crowd")
    policy = policy_of(options.lod_policy)
    spec = _by_size(spec_of(options), options, policy)

    from renderer.still import write_still

    write_still(
        options.out,
        spec,
        **viewpoint_of(options, spec),
        wireframe=options.wireframe,
        view=options.view,
        policy=policy,
    )
    print(options.out)
    return 0


def _check_group(options: argparse.Namespace) -> None:
    """Give the crowd's view its people; raises CommandError for options it cannot have."""
    for name, given in (("wireframe", options.wireframe), ("switching", options.switching)):
        if given:
            raise CommandError(f"--{name}: only the main character's eyes; leave out --view crowd")
    if options.crowd == 0:
        raise CommandError("--crowd 0: the crowd's view needs people; choose 5, 10 or 30")
    options.crowd = options.crowd or GROUP


def _by_size(spec: ClipSpec, options: argparse.Namespace, policy: LodPolicy) -> ClipSpec:
    """Put the camera where --iris-px says, and let the LoDs follow from the eyes' size."""
    if options.iris_px is not None:
        if options.frame is not None:
            raise CommandError("--frame: a frame has its own distance; leave --iris-px out")
        spec = replace(spec, motion="approach", approach_end_px=options.iris_px)
    if options.switching is None:
        return spec
    if options.effect or options.only_effect:
        raise CommandError("--switching: takes the levels from a policy; leave effects out")
    if {options.left, options.right} != {"ultra"}:  # the defaults
        raise CommandError(
            "--switching: takes the LoDs from a policy; leave --left and --right out"
        )
    return replace(
        spec,
        left=policy.finest,
        right=policy.finest,
        left_switching=options.switching,
        right_switching=options.switching,
        lod_policy=policy,
    )
