"""Members of the crowd with their meshes. Pure numpy."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.crowd.figure import Body
from renderer.crowd.gait import stride_s
from renderer.crowd.stage import Member

Floats = npt.NDArray[np.float64]

_SPHERES_PER_BONE: Final = 4


@dataclass(frozen=True)
class Figure:
    """A member with its mesh, and where its vertices lie in the crowd's buffers.

    The mesh is of the size of the member's body; ``scale`` makes it as tall as the person.
    ``is_awake`` where its lids are raised for real eyes.
    """

    member: Member
    body: Body
    first_vertex: int
    seed: int
    scale: float = 1.0
    is_awake: bool = False

    @functools.cached_property
    def stride(self) -> float:
        """Duration of a stride in seconds."""
        rig = self.body.rig
        leg = rig.heads_mm[rig.index("thigh_l")] - rig.heads_mm[rig.index("foot_l")]
        return stride_s(self.scale * float(np.linalg.norm(leg)))

    @functools.cached_property
    def spheres(self) -> tuple[Floats, Floats, npt.NDArray[np.int64]]:
        """Spheres at rest that hold the mesh: centres (k, 3), posed radii (k,), bones (k,)."""
        body, rig = self.body, self.body.rig
        share = np.linspace(0.0, 1.0, _SPHERES_PER_BONE)[:, None]
        owner = body.bones[:, 0]  # the strongest bone of each vertex
        centres, radii, bones = [], [], []
        for bone in np.unique(owner):
            places = body.positions_mm[owner == bone]
            along = rig.heads_mm[bone] + share * (rig.tails_mm[bone] - rig.heads_mm[bone])
            distance = np.linalg.norm(places[:, None] - along[None], axis=2)
            nearest = distance.argmin(axis=1)
            for number in np.unique(nearest):
                centres.append(along[number])
                # Blending with other bones moves a vertex a little out of its own bone's sphere.
                reach = distance[nearest == number, number].max() + 25.0
                radii.append(self.scale * reach)
                bones.append(bone)
        return np.array(centres), np.array(radii), np.array(bones)
