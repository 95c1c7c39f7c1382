"""A tiling noise texture for sky and ground: four fields shaped in frequency. Pure numpy."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

SIZE: Final = 512
# Fall of amplitude with frequency per channel: two for clouds, one for grass, one near white.
_SLOPES: Final = (1.75, 1.55, 0.75, 0.25)


def tiling_noise(seed: int = 3) -> npt.NDArray[np.uint8]:
    """Return four independent noise fields, (SIZE, SIZE, 4) uint8, that tile without a seam.

    Values are ranks: each field is uniform over 0 to 255, so a threshold is a share of the area.
    """
    rng = np.random.Generator(np.random.PCG64(seed))
    frequency = np.hypot(
        np.fft.fftfreq(SIZE)[:, None] * SIZE, np.fft.rfftfreq(SIZE)[None, :] * SIZE
    )
    frequency[0, 0] = 1.0
    fields = []
    for slope in _SLOPES:
        spectrum = np.fft.rfft2(rng.standard_normal((SIZE, SIZE))) * frequency**-slope
        spectrum[0, 0] = 0.0
        field = np.fft.irfft2(spectrum, s=(SIZE, SIZE))
        ranks = np.empty(SIZE * SIZE)
        # Rounding first makes the order independent of the last bits of the transform.
        ranks[np.argsort(np.round(field.ravel(), 9), kind="stable")] = np.arange(SIZE * SIZE)
        fields.append((ranks * (256 / SIZE**2)).reshape(SIZE, SIZE))
    return np.stack(fields, axis=-1).astype(np.uint8)
