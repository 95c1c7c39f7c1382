"""An iris in a file: what ``ocularist iris`` takes from a photograph and clips are drawn with.

The file is NumPy's ``.npz`` with the arrays of the procedural bake (see ``maps.bake_iris``) and the
tissue's coefficients. Its SHA-256 stands in the clip, so that another iris is another clip.
"""

from __future__ import annotations

import hashlib
import io
import zipfile
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from renderer.eye.subsurface import LAYERS, Tissue
from renderer.iris.maps import BASE_PX

Arrays = dict[str, npt.NDArray[Any]]

# Type and shape of every array; None is a side of any length that divides the maps'.
LAYOUT: Final[dict[str, tuple[str, tuple[int | None, ...]]]] = {
    "albedo": ("uint16", (BASE_PX, BASE_PX, 3)),
    "height": ("uint16", (BASE_PX, BASE_PX)),
    "cavity": ("uint8", (BASE_PX, BASE_PX)),
    "thickness": ("float32", (None, None, LAYERS)),
    "mean_albedo": ("float32", (3,)),
    "mean_thickness": ("float32", (LAYERS,)),
    "sigma_s": ("float64", (LAYERS, 3)),
    "sigma_t": ("float64", (LAYERS, 3)),
    "anisotropy": ("float64", (LAYERS,)),
}


class IrisFileError(ValueError):
    """An iris file that is none, or another one than the clip names."""


def packed(arrays: Arrays) -> bytes:
    """Return the file's bytes: the same arrays are the same bytes."""
    buffer = io.BytesIO()
    np.savez_compressed(buffer, allow_pickle=False, **arrays)
    return buffer.getvalue()


@lru_cache(maxsize=2)
def read_iris(path: str, sha256: str) -> Arrays:
    """Return the arrays of an iris file.

    Raises IrisFileError where the file is missing, is no iris file or has other contents than
    ``sha256`` says; an empty ``sha256`` accepts any.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise IrisFileError(
            f"{path}: {error.strerror}; put the iris file back or take it anew with "
            "ocularist iris PHOTO"
        ) from None
    found = hashlib.sha256(data).hexdigest()
    if sha256 and found != sha256:
        raise IrisFileError(
            f"{path}: has other contents (SHA-256 {found[:12]}...) than the clip was named for "
            f"({sha256[:12]}...); put the iris file back or name the clip anew"
        )
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as kept:
            arrays = {name: kept[name] for name in kept.files}
    except (OSError, ValueError, EOFError, zipfile.BadZipFile):
        arrays = {}
    for name, (kind, shape) in LAYOUT.items():
        if name not in arrays or not _fits(arrays[name], kind, shape):
            raise IrisFileError(
                f'{path}: is no iris file ("{name}" is missing or of another form); '
                "ocularist iris PHOTO writes one"
            )
    return arrays


def tissue_of(arrays: Arrays) -> Tissue:
    """Return the layers' coefficients of an iris file's arrays."""
    return Tissue(arrays["sigma_s"], arrays["sigma_t"], arrays["anisotropy"])


def _fits(array: npt.NDArray[Any], kind: str, shape: tuple[int | None, ...]) -> bool:
    return (
        array.dtype == kind
        and array.ndim == len(shape)
        and all(
            BASE_PX % side == 0 if wanted is None else side == wanted
            for side, wanted in zip(array.shape, shape, strict=True)
        )
        and bool(np.isfinite(array).all())
    )
