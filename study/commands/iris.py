"""``ocularist iris``: a photograph of an eye becomes an iris that clips can be drawn with."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from study.commands.errors import CommandError
from study.commands.places import new_file, new_folder
from study.commands.values import number

if TYPE_CHECKING:
    from renderer.unrefraction.recovery import Recovery

HELP = "take an iris from a photograph"
DESCRIPTION = (
    "Find the eye in a photograph, undo the cornea's refraction and the light, and write the "
    "iris's maps. Use the file iris.npz with ocularist still --iris FILE, or in a study file: "
    'eye.iris_file = "FILE". See docs/iris-photographs.md.'
)
EXAMPLE = "anna.jpg --out anna"
LIMBUS_MM = (9.0, 14.0)  # of all human eyes
FOCAL_MM = (10.0, 2000.0)
DISTANCE_MM = (60.0, 5000.0)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    parser.add_argument("photograph", type=Path, metavar="PHOTO", help="JPEG, PNG, TIFF, WebP ...")
    parser.add_argument(
        "--out",
        type=place,
        metavar="PLACE",
        help="folder for everything, or a file ending in .npz for the iris alone "
        "(default: out/iris/PHOTO)",
    )
    parser.add_argument(
        "--limbus-mm",
        type=number,
        default=11.7,
        metavar="MM",
        help="true width of the visible iris (default: %(default)s)",
    )
    parser.add_argument(
        "--focal",
        type=number,
        metavar="MM",
        help="focal length, 35 mm equivalent, of an uncropped photograph that does not say it",
    )
    parser.add_argument(
        "--distance", type=number, metavar="MM", help="from the camera to the eye, if you know it"
    )
    parser.add_argument(
        "--no-drawing", action="store_true", help="leave the drawn eye out of the preview: no GL"
    )


def place(text: str) -> Path:
    """Read where an iris goes: a folder, or a file of its own."""
    return (new_file if text.endswith(".npz") else new_folder)(text)


def run(options: argparse.Namespace) -> int:
    """Take the iris and write it."""
    for name, (least, most) in (
        ("limbus_mm", LIMBUS_MM),
        ("focal", FOCAL_MM),
        ("distance", DISTANCE_MM),
    ):
        value = getattr(options, name)
        if value is not None and not least <= value <= most:
            option = name.replace("_", "-")
            raise CommandError(f"--{option}: {value:g} lies outside {least:g} to {most:g} mm")
    from renderer.unrefraction.photograph import read_photograph
    from renderer.unrefraction.recovery import recover_iris
    from renderer.unrefraction.writing import IRIS_FILE, write_iris

    with _Steps() as steps:
        steps.show("reading the photograph")
        photograph = read_photograph(options.photograph, focal_mm=options.focal)
        recovery = recover_iris(
            photograph,
            limbus_mm=options.limbus_mm,
            distance_mm=options.distance,
            tell=steps.show,
        )
        out = options.out or Path("out/iris") / options.photograph.stem
        path = out if out.suffix == ".npz" else out / IRIS_FILE
        steps.show("writing the maps")
        sha256 = write_iris(recovery, path)
        if out.suffix != ".npz":
            _write_rest(recovery, out, sha256, steps, is_drawn=not options.no_drawing)
    _report(recovery)
    print(path)
    return 0


def _write_rest(
    recovery: Recovery, folder: Path, sha256: str, steps: _Steps, *, is_drawn: bool
) -> None:
    from renderer.unrefraction.preview import draw_preview
    from renderer.unrefraction.writing import IRIS_FILE, write_found, write_textures

    write_textures(recovery, folder)
    write_found(recovery, folder / "found.json", sha256=sha256)
    drawn = None
    if is_drawn:
        steps.show("drawing the eye")
        from renderer.clip import ClipSpec
        from renderer.detail import Detail
        from renderer.gl.context import create_context
        from renderer.unrefraction.portrait import developed, portrait

        yaw_deg, pitch_deg = recovery.gaze_deg
        spec = ClipSpec(
            left=Detail.uniform("ultra"),
            right=Detail.uniform("off"),
            iris_file=str((folder / IRIS_FILE).absolute()),
            iris_sha256=sha256,
            pupil_mm=min(max(2 * recovery.pose.pupil_mm, 1.5), 8.0),
            gaze_yaw_deg=yaw_deg,
            gaze_pitch_deg=pitch_deg,
        )
        gl = create_context()
        try:
            drawn = developed(portrait(gl, spec, size_px=720))
        finally:
            gl.release()
    draw_preview(recovery, drawn).save(folder / "preview.png")


def _report(recovery: Recovery) -> None:
    """Say in a few lines what was found."""
    found = recovery.found
    print(
        f"pupil {found['pupil_true_mm']:.2f} mm (seen as {found['pupil_apparent_mm']:.2f}), "
        f"tilt {found['tilt_deg']:.0f} degrees, {found['px_per_mm']:.1f} pixels per mm, "
        f"{found['iris_seen']:.0%} of the iris seen"
    )
    for warning in found["warnings"]:
        print(f"warning: {warning}")


class _Steps:
    """The current step in the terminal; where nobody watches, a line per step."""

    def __init__(self) -> None:
        from tqdm import tqdm

        self._bar: tqdm[Any] = tqdm(bar_format="{desc} ({elapsed})", leave=False, disable=None)

    def __enter__(self) -> _Steps:
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.close()

    def show(self, step: str) -> None:
        """Name the step that begins."""
        if self._bar.disable:
            print(f"Iris: {step}", file=sys.stderr, flush=True)
        else:
            self._bar.set_description_str(f"Iris: {step}")
