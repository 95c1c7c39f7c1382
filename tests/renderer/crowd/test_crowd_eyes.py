"""Sixty eyes: which are drawn, at which LoD, where they look, how their lids fit."""

from __future__ import annotations

from dataclasses import replace

import moderngl
import numpy as np
import pytest

from renderer.body.rig import skin_vertices
from renderer.camera import LIMBUS_Z_MM, iris_px, views
from renderer.clip import ClipSpec
from renderer.crowd import gaze
from renderer.crowd.bodies import build_figures
from renderer.crowd.eye_groups import (
    CAUSTIC_STEP_DEG,
    IRISES,
    caustic_layers,
    crowd_detail,
    crowd_mesh,
)
from renderer.crowd.eyes import PAINTED_PX
from renderer.crowd.figure import BONES
from renderer.crowd.figures import Figure
from renderer.crowd.formation import CAMERA_MM, formation, group_view
from renderer.crowd.gaze import CrowdGaze
from renderer.crowd.group import GroupRenderer
from renderer.crowd.sockets import AWAKE_MM, sockets
from renderer.crowd.stage import members
from renderer.crowd.troupe import Troupe
from renderer.detail import STANDARD_LODS, Detail
from renderer.eye.anatomy import GLOBE_RADIUS_MM
from renderer.eye.caustics import caustic_map
from renderer.lod.choice import LodPolicy, LodStep
from renderer.lod.policy import default_policy
from renderer.scene import Scene
from renderer.view import look_at, perspective

LOW = Detail.uniform("low")
SPEC = ClipSpec(left=LOW, right=LOW, width=640, height=360, crowd=30)
LIMITS_PX = zip(STANDARD_LODS, (14.0, 48.0, 200.0, None), strict=True)
POLICY = LodPolicy(tuple(LodStep(lod, Detail.uniform(lod), px) for lod, px in LIMITS_PX))


@pytest.fixture(scope="module")
def group(gl: moderngl.Context) -> GroupRenderer:
    return GroupRenderer(gl, SPEC, policy=POLICY)


@pytest.fixture(scope="module")
def figures() -> tuple[Figure, ...]:
    return build_figures(formation(30), is_awake=True)


@pytest.fixture(scope="module")
def gazes(figures: tuple[Figure, ...]) -> CrowdGaze:
    return CrowdGaze.of(figures, [sockets(figure.body) for figure in figures])


def test_all_sixty_eyes_are_in_the_group_view_and_nobody_hides_one(
    figures: tuple[Figure, ...], gazes: CrowdGaze
) -> None:
    bones = Troupe(figures).bones(1.0)
    placed, _ = gazes.placed(bones)
    view = group_view((1920, 1080))
    sizes = gaze.iris_px(
        placed, view_matrix=view.view_matrix, projection=view.projection, lines=1080
    )
    assert len(sizes) == 60
    assert sizes.min() > PAINTED_PX, "every eye is a real one"
    assert sizes.max() > 4 * sizes.min()
    assert len({default_policy().choose(px) for px in sizes}) >= 2
    pupils = placed[:, :3, 3] + 13.0 * placed[:, :3, 2]
    for number, figure in enumerate(figures):
        body = figure.body
        weights = np.zeros((len(body.positions_mm), len(BONES)))
        np.add.at(weights, (np.arange(len(weights))[:, None], body.bones), body.weights)
        posed = skin_vertices(body.positions_mm, bones[number], weights=weights)
        others = pupils[gazes.figure != number]
        assert distance_from_sight_mm(posed, others) > 30.0, figure.member.person.name


def distance_from_sight_mm(points: np.ndarray, pupils: np.ndarray) -> float:
    """Return how near points come to the lines from the camera to pupils."""
    from_camera, far = points - CAMERA_MM, pupils - CAMERA_MM
    reach = np.linalg.norm(far, axis=1)
    along = from_camera @ (far / reach[:, None]).T
    off = np.sqrt(np.maximum((from_camera**2).sum(axis=1)[:, None] - along**2, 0.0))
    return float(off[(along > 0) & (along < reach)].min(initial=np.inf))


def test_eyes_are_measured_as_the_main_characters_are() -> None:
    spec = replace(SPEC, distance="medium")
    view = views(spec, 0.0)[0]
    placed = np.tile(np.eye(4), (2, 1, 1))
    placed[:, 0, 3] = -31.0, 31.0
    found = gaze.iris_px(
        placed, view_matrix=view.view_matrix, projection=view.projection, lines=spec.height
    )
    np.testing.assert_allclose(found, iris_px(spec, 0.0), rtol=1e-5)


def test_eyes_that_look_away_or_stand_outside_are_not_drawn() -> None:
    view = look_at(np.array([0.0, 0.0, 1000.0]), np.zeros(3))
    placed = np.tile(np.eye(4), (3, 1, 1))
    placed[1, :3, :3] = np.diag([-1.0, 1.0, -1.0])
    placed[2, 0, 3] = 400.0
    sizes = gaze.iris_px(
        placed, view_matrix=view, projection=perspective(12.0, 1.0, 10.0, 5000.0), lines=500
    )
    assert sizes[0] > 0
    assert sizes[1:].tolist() == [0.0, 0.0]


def test_each_eye_has_the_lod_of_its_size_and_one_iris_pool_serves_all(
    group: GroupRenderer,
) -> None:
    group.render(time_s=0.5)
    assert group.eyes_drawn
    for eye in group.eyes_drawn:
        assert eye.lod == POLICY.steps[POLICY.choose(eye.iris_px)].lod
        assert eye.iris_px > 0
    per_figure = {eye.figure for eye in group.eyes_drawn}
    assert len(group.eyes_drawn) == 2 * len(per_figure)
    assert max(eye.iris_px for eye in group.eyes_drawn) >= PAINTED_PX
    assert len(group.crowd._eyes._groups._irises) <= 4 * len(IRISES)


def test_eyes_of_one_kind_are_drawn_together(group: GroupRenderer) -> None:
    group.render(time_s=0.5)
    eyes = group.crowd._eyes
    assert len({run.kind for run in eyes._runs}) == len(eyes._runs)
    details = {(eye.figure, eye.eye): crowd_detail(eye.detail) for eye in group.eyes_drawn}
    drawn = []
    for run in eyes._runs:
        assert run.first == len(drawn)
        for row in eyes._rows[run.first : run.first + run.count].tolist():
            figure, eye = divmod(row, 2)
            person = group.crowd.figures[figure].member.person
            assert run.kind == (details[figure, eye], person.eye)
            drawn.append((figure, eye))
    assert sorted(drawn) == sorted(details)


def test_sizes_follow_the_pictures_lines(gl: moderngl.Context, group: GroupRenderer) -> None:
    group.render(time_s=0.5)
    small = len(group.eyes_drawn)
    finer = GroupRenderer(gl, SPEC.resized(1280, 720), surroundings=group.surroundings)
    finer.render(time_s=0.5)
    assert small < len(finer.eyes_drawn) <= 60
    own = default_policy()  # nobody named another
    assert {eye.lod for eye in finer.eyes_drawn} == {
        own.steps[own.choose(eye.iris_px)].lod for eye in finer.eyes_drawn
    }


def test_real_eyes_change_the_picture_only_around_eyes(group: GroupRenderer) -> None:
    real = group.render(time_s=0.5).pixels.astype(int)
    eyes, group.crowd._eyes = group.crowd._eyes, None
    try:
        painted = group.render(time_s=0.5).pixels.astype(int)
    finally:
        group.crowd._eyes = eyes
    changed = np.abs(real - painted).max(axis=2) > 2
    assert changed.any()
    assert changed.mean() < 0.01


def test_a_group_is_the_same_picture_every_time(group: GroupRenderer) -> None:
    first = group.render(10.0, time_s=0.5).pixels.copy()
    other = group.render(-20.0, time_s=1.5).pixels.copy()
    assert (group.render(10.0, time_s=0.5).pixels == first).all()
    assert (other != first).any()


def test_the_first_frame_that_needs_a_lod_is_like_those_after_it(group: GroupRenderer) -> None:
    later = group.render(5.0, time_s=0.5).pixels.copy()
    groups = group.crowd._eyes._groups
    groups._kinds.clear()
    groups._irises.clear()
    group.surroundings._cubes.clear()
    assert (group.render(5.0, time_s=0.5).pixels == later).all()


@pytest.mark.parametrize(("distance_mm", "lod"), [(1300, "medium"), (260, "high"), (90, "ultra")])
def test_every_lod_draws_the_eyes_of_whoever_comes_near(
    group: GroupRenderer, distance_mm: float, lod: str
) -> None:
    crowd = group.crowd
    crowd.pose(1.0)
    placed, _ = crowd._eyes.gaze.placed(crowd._bones)
    figure = 16
    eye = placed[2 * figure]
    position = eye[:3, 3] + (13.0 + distance_mm) * eye[:3, 2]
    view = look_at(position, eye[:3, 3])
    pictures = []
    for has_eyes in (True, False):
        group._picture.begin()
        group._picture.use_rectangle((0, 0, SPEC.width, SPEC.height))
        kept = crowd._eyes
        crowd._eyes = kept if has_eyes else None
        crowd.draw(
            view_matrix=view,
            projection=perspective(12.0, 16 / 9, 20.0, 20000.0),
            camera_mm=position,
            time_s=1.0,
        )
        if has_eyes:
            drawn = [e for e in crowd.eyes_drawn if (e.figure, e.eye) == (figure, 0)]
        crowd._eyes = kept
        pictures.append(group._picture.radiance()[170:190, 310:330])
    assert [e.lod for e in drawn] == [lod]
    real, painted = pictures
    assert np.isfinite(real).all()
    assert (real != painted).any()
    assert 0.001 < real.mean() < 2.0


def test_a_crowd_of_five_keeps_painted_eyes(standard_scene: Scene) -> None:
    assert len(standard_scene.crowd.figures) == 5
    assert standard_scene.crowd._eyes is None


def test_eyes_look_where_the_head_points_unless_they_seek_something(
    figures: tuple[Figure, ...], gazes: CrowdGaze
) -> None:
    around = build_figures(members(10))
    own = CrowdGaze.of(around, [sockets(figure.body) for figure in around])
    placed, aside = own.placed(Troupe(around).bones(0.4))
    assert (aside == 0.0).all()
    np.testing.assert_allclose(np.linalg.det(placed[:, :3, :3]), 1.0, atol=1e-9)
    placed, aside = gazes.placed(Troupe(figures).bones(0.4))
    towards = np.array(CAMERA_MM) - placed[:, :3, 3]
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    met = np.einsum("ei,ei->e", towards, placed[:, :3, 2])
    is_free = (np.abs(aside) < [gaze.YAW_DEG, gaze.PITCH_DEG]).all(axis=1)
    assert is_free.mean() > 0.9
    assert met[is_free].min() > np.cos(np.radians(1.0))


def test_globes_fit_their_sockets_and_lids_leave_the_iris_open(
    figures: tuple[Figure, ...], gazes: CrowdGaze
) -> None:
    for figure in figures:
        left, right = sockets(figure.body)
        assert left.centre_mm[0] < 0 < right.centre_mm[0], "the viewer's left first"
        for socket in (left, right):
            assert 14.0 < socket.radius_mm < 18.0
            painted = figure.body.positions_mm[socket.rows]
            apart = np.linalg.norm(painted - socket.centre_mm, axis=1)
            np.testing.assert_allclose(apart, socket.radius_mm, atol=1e-6)
            assert socket.rims.upper_mm[:, 1].max() == pytest.approx(AWAKE_MM, abs=1.2)
            assert -8.0 < socket.rims.lower_mm[:, 1].min() < -4.5
            width = np.ptp(socket.rims.upper_mm[:, 0])
            assert 16.0 < width < 26.0
            assert (np.diff(socket.rims.upper_mm[:, 0]) > 0).all()
    placed, _ = gazes.placed(Troupe(figures).bones(0.0))
    fronts = placed[:, :3, 3] + GLOBE_RADIUS_MM * placed[:, :3, 2]
    heads = Troupe(figures).bones(0.0)[gazes.figure, gaze.HEAD]
    centres = np.einsum("eij,ej->ei", heads[:, :3, :3], gazes.centres_mm) + heads[:, :3, 3]
    np.testing.assert_allclose(np.linalg.norm(fronts - centres, axis=1), gazes.radii_mm)
    assert LIMBUS_Z_MM < GLOBE_RADIUS_MM


def test_the_pool_of_caustics_is_the_clips_own_turned() -> None:
    layers = caustic_layers()
    angle = np.radians(3 * CAUSTIC_STEP_DEG)
    upright = caustic_map(np.array([0.0, np.sin(angle), np.cos(angle)]), 128)
    turned = np.rot90(layers[3][..., 2])
    inner = slice(40, 88)
    ours, theirs = np.rot90(turned, 2), upright[..., 2]
    np.testing.assert_allclose(ours[inner, inner], theirs[inner, inner], atol=1e-3)


def test_globes_of_the_crowd_are_a_step_coarser_where_a_formula_shades_them() -> None:
    counts = [len(crowd_mesh(Detail.uniform(lod)).triangles) for lod in STANDARD_LODS]
    np.testing.assert_allclose(counts, [150, 500, 500, 2000], rtol=0.05)


def test_the_crowd_mirrors_no_moving_people() -> None:
    assert crowd_detail(Detail.uniform("ultra")).reflection == "high"
    assert crowd_detail(LOW) == LOW


@pytest.mark.parametrize("count", [0, 31])
def test_a_group_needs_people_and_has_no_more_than_there_are(count: int) -> None:
    with pytest.raises(ValueError, match=f"crowd: {count}; a group view needs 1 to 30 people"):
        formation(count)
