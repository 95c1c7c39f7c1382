"""How far a LoD is from the best one in the picture, by the size of the eye: measured on real GL.

The same frame is rendered with the LoD and with the reference, and the two are compared inside the
eye's rectangle as they are shown: after exposure, tone curve and 8 bits. Only that rectangle is
rendered, through the camera of an approach, so that perspective is right at every size.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Final

from renderer.camera import views
from renderer.clip import ClipSpec
from renderer.detail import STANDARD_LODS, Detail
from renderer.eye_rectangles import Rectangle, eye_rectangles
from renderer.frame.frame import FrameRenderer
from renderer.frame.picture import Pixels
from renderer.lod.derivation import LodError, derive_policy
from renderer.lod.policy import PolicyFile
from renderer.lod.visibility import JUST_NOTICEABLE, PIXELS_PER_DEGREE, visible_difference
from renderer.sources import code_version
from renderer.studio import Studio
from renderer.view import cropped

REFERENCE_SIZE: Final = (1920, 1080)  # of the frame that rectangles are cut from
LEAST_CROP_PX: Final = 64  # rectangles of small eyes are rendered with what lies around them
SIDES: Final = ("left", "right")

# What the policy that comes with the renderer was measured on.
SIZES_PX: Final = (6.0, 8.0, 11.0, 16.0, 23.0, 32.0, 45.0, 64.0, 90.0, 128.0, 181.0, 240.0)
AZIMUTHS_DEG: Final = (-35.0, 0.0, 35.0)


@dataclass(frozen=True)
class Look:
    """What else an error depends on: whose eyes they are and how effects are balanced."""

    iris_seed: int = 1
    iris_colour: str = "blue"
    preset: str = "thesis"


LOOKS: Final = (Look(), Look(iris_seed=2, iris_colour="brown"))


@dataclass(frozen=True)
class Sight:
    """From where an eye is seen: the iris's diameter on 1080 lines, were it in front; azimuth.

    Seen from the side and close, the nearer eye is a few percent larger, the farther one smaller.
    """

    size_px: float
    azimuth_deg: float


def measure_errors(
    studio: Studio,
    lods: Mapping[str, Detail],
    *,
    reference: Detail,
    sights: Sequence[Sight],
    looks: Iterable[Look],
    progress: Callable[[str], None] = lambda _what: None,
) -> list[LodError]:
    """Render both eyes with every LoD and with the reference from everywhere, and compare them."""
    errors = []
    for look in looks:
        progress(f"{look.iris_colour} iris, reference")
        best = render_rectangles(studio, reference, sights=sights, look=look)
        for lod, detail in lods.items():
            progress(f"{look.iris_colour} iris, {lod}")
            found = render_rectangles(studio, detail, sights=sights, look=look)
            for sight, shown, ideal in zip(sights, found, best, strict=True):
                errors += [
                    LodError(
                        lod,
                        f"{look.iris_colour} {look.iris_seed}, {SIDES[eye]} eye, "
                        f"{sight.azimuth_deg:g} degrees",
                        sight.size_px,
                        visible_difference(shown[eye], ideal[eye]),
                    )
                    for eye in (0, 1)
                ]
    return errors


def derive(studio: Studio, *, progress: Callable[[str], None] = lambda _what: None) -> PolicyFile:
    """Measure the standard LoDs against ultra and return the policy that follows."""
    lods = {name: Detail.uniform(name) for name in STANDARD_LODS}
    reference = STANDARD_LODS[-1]
    best = lods.pop(reference)
    errors = measure_errors(
        studio,
        lods,
        reference=best,
        sights=[Sight(size, azimuth) for size in SIZES_PX for azimuth in AZIMUTHS_DEG],
        looks=LOOKS,
        progress=progress,
    )
    provenance = {
        "command": "ocularist lod-policy",
        "azimuths_deg": AZIMUTHS_DEG,
        "looks": [asdict(look) for look in LOOKS],
        "pixels_per_degree": PIXELS_PER_DEGREE,
        "gl_renderer": studio.gl_renderer,
        "code_version": code_version(),
    }
    return derive_policy(
        errors,
        lods,
        reference=(reference, best),
        just_noticeable=JUST_NOTICEABLE,
        provenance=provenance,
    )


def render_rectangles(
    studio: Studio, detail: Detail, *, sights: Sequence[Sight], look: Look
) -> list[tuple[Pixels, Pixels]]:
    """Render both eyes with one LoD and return their rectangles, left and right, per sight."""
    spec = _spec(detail, look)
    places = [
        eye_rectangles(spec, sight.azimuth_deg, distance_px=sight.size_px) for sight in sights
    ]
    boxes = [_box(*rectangle) for pair in places for rectangle in pair]
    size = max(box[2] for box in boxes), max(box[3] for box in boxes)
    renderer = studio.renderer(spec.resized(*size))
    return [
        (
            _render(renderer, sight, rectangle=pair[0]),
            _render(renderer, sight, rectangle=pair[1]),
        )
        for sight, pair in zip(sights, places, strict=True)
    ]


def _render(renderer: FrameRenderer, sight: Sight, *, rectangle: Rectangle) -> Pixels:
    """Render one eye's rectangle of a frame of REFERENCE_SIZE, in a corner of the picture."""
    rows, columns = rectangle
    box = _box(rows, columns)
    frame = renderer.spec.resized(*REFERENCE_SIZE)
    (view,) = views(frame, sight.azimuth_deg, distance_px=sight.size_px)
    pixels = renderer.render_views((cropped(view, box),)).pixels
    # The part lies at the picture's lower left; its first row is this far from the top.
    left, top = columns.start - box[0], rows.start - (REFERENCE_SIZE[1] - box[1] - box[3])
    top += renderer.spec.height - box[3]
    height, width = rows.stop - rows.start, columns.stop - columns.start
    return pixels[top : top + height, left : left + width].copy()


def _spec(detail: Detail, look: Look) -> ClipSpec:
    return ClipSpec(
        left=detail,
        right=detail,
        motion="approach",
        width=REFERENCE_SIZE[0],
        height=REFERENCE_SIZE[1],
        iris_seed=look.iris_seed,
        iris_colour=look.iris_colour,
        preset=look.preset,
    )


def _box(rows: slice, columns: slice) -> tuple[int, int, int, int]:
    """Return the part of the frame to render: x, y from the lower left, even width and height."""
    x, width = _span(columns, REFERENCE_SIZE[0])
    top, height = _span(rows, REFERENCE_SIZE[1])
    return x, REFERENCE_SIZE[1] - top - height, width, height


def _span(part: slice, whole: int) -> tuple[int, int]:
    length = max(LEAST_CROP_PX, part.stop - part.start)
    length += length % 2
    start = (part.start + part.stop - length) // 2
    return min(max(start, 0), whole - length), length
