"""Skeletons: fitted joints, weights, posing."""

from __future__ import annotations

import numpy as np
import pytest

from renderer.body import makehuman, rig

VERTICES = makehuman.base_mesh().vertices_mm


def test_rest_pose_moves_nothing() -> None:
    posed = rig.pose_vertices(VERTICES, rig.fit_rig(VERTICES), rotations={})
    np.testing.assert_allclose(posed, VERTICES, atol=2e-3)


def test_weights_share_every_vertex_fully() -> None:
    skeleton = rig.fit_rig(VERTICES)
    np.testing.assert_allclose(skeleton.weights.sum(axis=1), 1.0, atol=1e-5)
    assert skeleton.weights.min() >= 0.0


def test_parents_come_before_children() -> None:
    skeleton = rig.fit_rig(VERTICES)
    assert (skeleton.parents < np.arange(len(skeleton.names))).all()
    assert skeleton.parents[0] == -1


def test_raising_an_arm_moves_the_hand_and_not_the_head() -> None:
    skeleton = rig.fit_rig(VERTICES)
    turn = rig.rotation([0, 0, 1], 60.0)
    posed = rig.pose_vertices(VERTICES, skeleton, rotations={"upperarm_l": turn})
    hand = skeleton.weights[:, skeleton.index("hand_l")] > 0.99
    head = skeleton.weights[:, skeleton.index("head")] > 0.99
    assert (posed[hand, 1] - VERTICES[hand, 1]).min() > 300
    np.testing.assert_allclose(posed[head], VERTICES[head], atol=1e-2)


def test_a_shift_moves_the_whole_body() -> None:
    moved = rig.pose_vertices(
        VERTICES, rig.fit_rig(VERTICES), rotations={}, shift_mm=np.array([0.0, 50.0, 0.0])
    )
    np.testing.assert_allclose(moved - VERTICES, np.tile([0, 50.0, 0], (len(moved), 1)), atol=1e-2)


def test_an_unknown_rig_or_bone_names_the_choices() -> None:
    with pytest.raises(ValueError, match=r'unknown rig "hero"; choose one of .*game_engine'):
        rig.fit_rig(VERTICES, name="hero")
    with pytest.raises(ValueError, match=r'no bone "tail"; choose one of .*upperarm_l'):
        rig.fit_rig(VERTICES).index("tail")
