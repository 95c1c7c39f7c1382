"""``ocularist certify``: our eye beside a path tracer's of the same eye, light and camera."""

from __future__ import annotations

import argparse
import sys
import time
from typing import Any

from study.commands.errors import CommandError
from study.commands.eye_options import iris
from study.commands.places import new_folder
from study.commands.values import count, whole_number

HELP = "compare the eye with a path tracer's"
DESCRIPTION = (
    "Render the eye and path-trace its twin: the same surface, index, iris, light and camera. "
    "Reports RMS, FLIP, SSIM and luminance profiles per region, sunlight and sky inside the "
    "anterior chamber, and the error of the iris's layers; fails when an aim is missed. "
    'Needs a path tracer and a metric: pip install "ocularist[certify]".'
)
EXAMPLE = "--quick"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    parser.add_argument(
        "--out",
        type=new_folder,
        default="out/certification",
        metavar="FOLDER",
        help="where to write report.html, certification.json and pictures (default: %(default)s)",
    )
    parser.add_argument(
        "--quick", action="store_true", help="fewer and smaller pictures: less than a minute"
    )
    parser.add_argument(
        "--spp", type=count, metavar="N", help="paths per pixel of the path tracer's pictures"
    )
    parser.add_argument(
        "--iris",
        action="append",
        type=iris,
        metavar="SEED|COLOUR|SEED:COLOUR",
        help="which iris, such as 7, brown or 7:brown; repeatable (default: 1:blue and 7:brown)",
    )
    parser.add_argument(
        "--seed", type=whole_number, default=0, metavar="N", help="the path tracer's (default: 0)"
    )


def run(options: argparse.Namespace) -> int:
    """Measure, write, and tell whether the aims are met."""
    from renderer.certification.tracer import SAFE_VARIANT, best_variant, check_installed

    check_installed()
    from renderer.certification.certificate import certify
    from renderer.certification.plan import IRISES, full_plan, quick_plan
    from renderer.certification.report import write_report
    from renderer.certification.tracer import path_tracer
    from renderer.gl.context import create_context

    start_s = time.monotonic()
    irises = tuple(_seed_and_colour(wanted) for wanted in options.iris or ())
    plan = (quick_plan if options.quick else full_plan)(irises or IRISES).with_spp(options.spp)
    variant = SAFE_VARIANT if options.quick else best_variant()
    gl = create_context()
    try:
        certificate = certify(
            gl, path_tracer(variant), plan, variant=variant, seed=options.seed, progress=_tell
        )
    finally:
        gl.release()
    report = write_report(certificate, options.out)
    aims = certificate.aims()
    print("\n".join(aim.line() for aim in aims))
    print(f"\nWritten to {report} after {time.monotonic() - start_s:.0f} s")
    return 0 if all(aim.is_met for aim in aims) else 1


def _seed_and_colour(wanted: dict[str, Any]) -> tuple[int, str]:
    if "iris_file" in wanted:
        raise CommandError(f"--iris {wanted['iris_file']}: only grown irises; write SEED:COLOUR")
    return wanted.get("iris_seed", 1), wanted.get("iris_colour", "blue")


def _tell(step: str) -> None:
    print(f"certify: {step}", file=sys.stderr, flush=True)
