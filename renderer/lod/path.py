"""Which LoD each eye has in each frame of a clip: from the camera's path alone. Pure.

An eye that switches at once remembers its last LoD. The memory starts with the clip and follows its
path, so that any frame can be drawn by itself and is the same every time.
"""

from __future__ import annotations

from functools import lru_cache

from renderer.camera import iris_px, iris_px_of_frame
from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.lod.choice import shares

Places = tuple[float, float]
Shares = tuple[tuple[Detail, float], ...]


@lru_cache(maxsize=64)
def places_of_clip(spec: ClipSpec) -> tuple[Places, ...]:
    """Return where between the policy's steps the left and the right eye are, frame by frame.

    Empty for a clip whose eyes keep their LoDs.
    """
    if spec.lod_policy is None:
        return ()
    found: list[Places] = []
    for frame in range(spec.frame_count):
        sizes = iris_px_of_frame(spec, frame)
        found.append(_places(spec, sizes, found[-1] if found else (None, None)))
    return tuple(found)


def places_of_view(
    spec: ClipSpec, azimuth_deg: float, *, distance_px: float | None = None
) -> Places | None:
    """Return the same for a camera that came from nowhere; None where eyes keep their LoDs."""
    if spec.lod_policy is None:
        return None
    return _places(spec, iris_px(spec, azimuth_deg, distance_px=distance_px), (None, None))


def _places(
    spec: ClipSpec, sizes: tuple[float, float], last: tuple[float | None, float | None]
) -> Places:
    assert spec.lod_policy is not None
    switching = (spec.left_switching, spec.right_switching)
    left, right = (
        spec.lod_policy.place(sizes[eye], switching[eye], last=last[eye]) for eye in (0, 1)
    )
    return left, right


def shares_of(spec: ClipSpec, places: Places | None) -> tuple[Shares, Shares]:
    """Return the LoDs that each eye is drawn with and their shares, the coarser first."""
    if spec.lod_policy is None or places is None:
        return ((spec.left, 1.0),), ((spec.right, 1.0),)
    steps = spec.lod_policy.steps
    left, right = (
        tuple((steps[step].detail, share) for step, share in shares(place)) for place in places
    )
    return left, right


def details_of(spec: ClipSpec) -> tuple[Detail, ...]:
    """Return every LoD that the clip's eyes may have."""
    if spec.lod_policy is None:
        return spec.left, spec.right
    return spec.left, spec.right, *(step.detail for step in spec.lod_policy.steps)
