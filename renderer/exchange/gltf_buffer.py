"""The one binary buffer of a .glb: arrays become accessors, pictures become textures.

glTF 2.0: 3.6.2 (accessors: alignment, bounds), 3.8 (images).
"""

from __future__ import annotations

import io
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import pygltflib as gltf
from PIL import Image

ARRAY_BUFFER: Final = 34962
ELEMENT_ARRAY_BUFFER: Final = 34963
FLOAT: Final = 5126
UNSIGNED_SHORT: Final = 5123
UNSIGNED_INT: Final = 5125
LINEAR: Final = 9729
LINEAR_MIPMAP_LINEAR: Final = 9987
CLAMP_TO_EDGE: Final = 33071
_KINDS: Final = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class GltfBuffer:
    """Collects bytes and fills a document's buffer views, accessors, images and textures."""

    def __init__(self, document: gltf.GLTF2) -> None:
        self.document = document
        self._data = bytearray()
        document.samplers.append(
            gltf.Sampler(
                magFilter=LINEAR,
                minFilter=LINEAR_MIPMAP_LINEAR,
                wrapS=CLAMP_TO_EDGE,
                wrapT=CLAMP_TO_EDGE,
            )
        )

    def vectors(self, values: npt.NDArray[np.floating]) -> int:
        """Add vertex attributes (n, 2 to 4) as floats; return the accessor's number."""
        rows = np.ascontiguousarray(values, dtype="<f4")
        return self._accessor(rows, FLOAT, _KINDS[rows.shape[1]], target=ARRAY_BUFFER)

    def indices(self, triangles: npt.NDArray[np.integer]) -> int:
        """Add triangles (m, 3); return the accessor's number."""
        is_small = triangles.max() < 65535  # the largest number restarts primitives
        flat = triangles.reshape(-1, 1).astype("<u2" if is_small else "<u4")
        kind = UNSIGNED_SHORT if is_small else UNSIGNED_INT
        return self._accessor(flat, kind, "SCALAR", target=ELEMENT_ARRAY_BUFFER)

    def texture(self, pixels: npt.NDArray[np.uint8], name: str) -> int:
        """Add a picture (height, width, 3), first row on top; return the texture's number."""
        png = io.BytesIO()
        Image.fromarray(pixels).save(png, format="PNG")
        view = self._view(png.getvalue())
        document = self.document
        document.images.append(gltf.Image(bufferView=view, mimeType="image/png", name=name))
        document.textures.append(
            gltf.Texture(sampler=0, source=len(document.images) - 1, name=name)
        )
        return len(document.textures) - 1

    def finish(self) -> None:
        """Hand the bytes to the document."""
        self.document.buffers.append(gltf.Buffer(byteLength=len(self._data)))
        self.document.set_binary_blob(bytes(self._data))

    def _accessor(self, rows: npt.NDArray[Any], component: int, kind: str, *, target: int) -> int:
        view = self._view(rows.tobytes(), target=target)
        self.document.accessors.append(
            gltf.Accessor(
                bufferView=view,
                componentType=component,
                count=len(rows),
                type=kind,
                min=rows.min(axis=0).tolist(),
                max=rows.max(axis=0).tolist(),
            )
        )
        return len(self.document.accessors) - 1

    def _view(self, data: bytes, *, target: int | None = None) -> int:
        self._data += b"\0" * (-len(self._data) % 4)
        view = gltf.BufferView(
            buffer=0, byteOffset=len(self._data), byteLength=len(data), target=target
        )
        self._data += data
        self.document.bufferViews.append(view)
        return len(self.document.bufferViews) - 1
