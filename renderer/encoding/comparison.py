"""What is left of a clip after encoding, inside the eyes: frames raw and decoded, LoD and LoD.

Kept of the raw frames are the eyes' rectangles of some frames. FLIP is compared where it matters:
at the pixels in which the clip's two LoDs differ at all. The rest of a rectangle, lids and lashes,
is the same at every LoD and would thin out what people are to see.
"""

from __future__ import annotations

import statistics
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.clip import ClipSpec
from renderer.encoding.decode import as_stored, decode
from renderer.encoding.fidelity import psnr_db, ssim
from renderer.encoding.flip import WHY_NOT, flip_map, is_installed
from renderer.eye_rectangles import frame_rectangles

Pixels = npt.NDArray[np.uint8]
EyePair = tuple[Pixels, Pixels]

SIGNAL_FRAMES: Final = 12  # compared by PSNR and SSIM
FLIP_FRAMES: Final = 3  # compared by FLIP, which costs ten times as much; one is the middle
NOT_ASKED: Final = "FLIP was not asked for"
SAME_LODS: Final = "both eyes have one LoD, so there is no difference to compare with"
SWITCHING: Final = "an eye switches its LoD, so there is no one difference to compare with"


@dataclass(frozen=True, kw_only=True)
class Fidelity:
    """Means over the compared frames, each for the left and the right eye.

    ``flip_encoding`` is raw against decoded, ``flip_lods`` the clip's LoDs against each other, both
    over the pixels in which the LoDs differ; where they are one LoD, over the whole rectangle and
    None. ``flip_rectangle`` is raw against decoded over the whole rectangle. ``flip_floor`` is the
    share of ``flip_lods`` that 8 bits of 4:2:0 alone have, in the middle frame: no encoding of this
    form comes below it. ``flip_note`` says why any is None.
    """

    psnr_db: list[float]
    ssim: list[float]
    flip_rectangle: list[float] | None = None
    flip_encoding: list[float] | None = None
    flip_lods: list[float] | None = None
    flip_floor: float | None = None
    flip_note: str = ""

    @property
    def flip_share(self) -> float | None:
        """FLIP of the encoding as a share of FLIP between the LoDs, None without a difference."""
        if self.flip_encoding is None or not self.flip_lods or sum(self.flip_lods) == 0:
            return None
        return sum(self.flip_encoding) / sum(self.flip_lods)


def signal_numbers(spec: ClipSpec) -> list[int]:
    """Return the numbers of the frames compared by PSNR and SSIM, from the first on."""
    return list(range(0, spec.frame_count, max(1, spec.frame_count // SIGNAL_FRAMES)))


def flip_numbers(spec: ClipSpec) -> list[int]:
    """Return the numbers of the frames compared by FLIP: each the middle of a third."""
    return sorted({int((k + 0.5) / FLIP_FRAMES * spec.frame_count) for k in range(FLIP_FRAMES)})


def eyes_of(spec: ClipSpec, number: int, pixels: Pixels) -> EyePair:
    """Return copies of both eyes' rectangles of a frame."""
    left, right = frame_rectangles(spec, number)
    return pixels[left].copy(), pixels[right].copy()


class Comparison:
    """Keeps the eyes of a clip's raw frames as they pass by, and compares encodings with them."""

    def __init__(self, spec: ClipSpec, *, with_flip: bool) -> None:
        self.spec = spec
        self.with_flip = with_flip and is_installed()
        self._note = "" if self.with_flip else WHY_NOT if with_flip else NOT_ASKED
        self._signal = signal_numbers(spec)
        self._flip = flip_numbers(spec) if self.with_flip else []
        self._wanted = {*self._signal, *self._flip}
        self._raw: dict[int, EyePair] = {}
        self._differs: dict[int, list[npt.NDArray[np.bool_]]] = {}
        self._lods: dict[int, tuple[float, float]] = {}
        self._others: dict[int, EyePair] = {}

    @property
    def other_lods(self) -> list[int]:
        """The frames that ``take_other`` waits for: of the same clip with its LoDs exchanged.

        None where the eyes have one LoD, and none where one switches: its policy chooses LoDs that
        hardly differ, and what is rated is the switch, not a difference that a frame has.
        """
        is_switching = self.spec.lod_policy is not None
        return [] if is_switching or self.spec.swapped() == self.spec else self._flip

    def take(self, number: int, pixels: Pixels) -> None:
        """Keep what is compared later of a raw frame (height, width, 3)."""
        if number in self._wanted:
            self._raw[number] = eyes_of(self.spec, number, pixels)

    def take_other(self, frames: Iterator[Pixels]) -> None:
        """Take the frames ``other_lods`` of the clip with its LoDs exchanged, in their order."""
        for number, pixels in zip(self.other_lods, frames, strict=True):
            self._others[number] = eyes_of(self.spec, number, pixels)

    def compare(self, path: Path) -> Fidelity:
        """Decode an encoding of the clip and compare it with what was kept."""
        seen = {
            number: eyes_of(self.spec, number, pixels)
            for number, pixels in decode(
                path, list(self._raw), size=(self.spec.width, self.spec.height)
            ).items()
        }
        self._compare_lods()
        both = [self._compare_eye(eye, seen) for eye in (0, 1)]
        psnr, similar, rectangle, encoding = (list(values) for values in zip(*both, strict=True))
        if not self.with_flip:
            return Fidelity(psnr_db=psnr, ssim=similar, flip_note=self._note)
        return Fidelity(
            psnr_db=psnr,
            ssim=similar,
            flip_rectangle=rectangle,
            flip_encoding=encoding,
            flip_lods=self._mean_lods(),
            flip_floor=self._floor(),
            flip_note=self._why_no_lods(),
        )

    def _compare_lods(self) -> None:
        for number, others in self._others.items():
            pairs = list(zip(self._raw[number], others, strict=True))
            masks = [(own != other).any(axis=-1) for own, other in pairs]
            left, right = (
                _mean(flip_map(*pair), mask) for pair, mask in zip(pairs, masks, strict=True)
            )
            self._differs[number], self._lods[number] = masks, (left, right)

    def _mean_lods(self) -> list[float] | None:
        return [statistics.fmean(eye) for eye in zip(*self._lods.values(), strict=True)] or None

    def _why_no_lods(self) -> str:
        if self._lods:
            return ""
        return SAME_LODS if self.spec.lod_policy is None else SWITCHING

    def _floor(self) -> float | None:
        """Return the share of the LoDs' FLIP that the form alone has, in the middle frame."""
        middle = self._flip[len(self._flip) // 2]
        if not sum(self._lods.get(middle, (0.0,))):
            return None
        eyes = zip(self._raw[middle], self._differs[middle], strict=True)
        lost = [_mean(flip_map(raw, as_stored(raw)), mask) for raw, mask in eyes]
        return sum(lost) / sum(self._lods[middle])

    def _compare_eye(self, eye: int, seen: dict[int, EyePair]) -> tuple[float, float, float, float]:
        """Return PSNR, SSIM, FLIP in the rectangle and FLIP where LoDs differ of one eye."""
        signal = [(self._raw[n][eye], seen[n][eye]) for n in self._signal]
        maps = [(n, flip_map(self._raw[n][eye], seen[n][eye])) for n in self._flip]
        masked = [
            _mean(found, self._differs[n][eye] if self._differs else None) for n, found in maps
        ]
        return (
            statistics.fmean(psnr_db(raw, decoded) for raw, decoded in signal),
            statistics.fmean(ssim(raw, decoded) for raw, decoded in signal),
            statistics.fmean(float(found.mean()) for _, found in maps) if maps else 0.0,
            statistics.fmean(masked) if masked else 0.0,
        )


def _mean(values: npt.NDArray[np.float64], mask: npt.NDArray[np.bool_] | None) -> float:
    """Return the mean of the masked values; of none, where two LoDs are drawn alike, 0."""
    chosen = values if mask is None else values[mask]
    return float(chosen.mean()) if chosen.size else 0.0
