"""The main character: her shape, her clothes and hair, and what reaches the picture."""

from __future__ import annotations

from collections.abc import Iterator

import moderngl
import numpy as np
import pytest
from scipy.spatial import cKDTree

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye.place import INTEROCULAR_MM
from renderer.head.cells import sort_into_cells
from renderer.head.character import figure
from renderer.head.clothing import sweater
from renderer.head.face_mesh import face_mesh
from renderer.head.hair import grow_hair
from renderer.head.hair_cap import hair_cap, inside_hairline
from renderer.head.head import Head
from renderer.head.lid_outline import OUTLINE_MM
from renderer.head.patch_space import to_patch
from renderer.head.sun_shadow import build_light
from renderer.light import Light, Sky
from renderer.view import Matrix, look_at, perspective

SIZE = (160, 120)
Place = tuple[float, float, float]


def sky() -> Sky:
    direction = np.array([-0.4, 0.6, 0.7])
    harmonics = np.zeros((9, 3))
    harmonics[0] = 0.4 / 0.282095
    return Sky(direction / np.linalg.norm(direction), np.full(3, 2.4), harmonics)


@pytest.fixture(scope="module")
def head(gl: moderngl.Context) -> Head:
    low = Detail.uniform("low")
    return Head(gl, ClipSpec(left=low, right=low))


@pytest.fixture(scope="module")
def light(gl: moderngl.Context, head: Head) -> Iterator[Light]:
    light = build_light(gl, sky(), head)
    yield light
    light.shadow_map.release()


def picture(
    gl: moderngl.Context,
    head: Head,
    light: Light,
    *,
    position: Place,
    target: Place = (0.0, 0.0, 0.0),
) -> tuple[np.ndarray, np.ndarray]:
    """Return radiance (h, w, 4), rows from below, before and after the hair is drawn."""
    frame = gl.framebuffer([gl.texture(SIZE, 4, dtype="f4")], gl.depth_renderbuffer(SIZE))
    frame.use()
    frame.clear(0.0, 0.0, 0.0, 0.0)
    place = np.array(position)
    distance = float(np.linalg.norm(place))
    view: Matrix = look_at(place, np.array(target))
    lens: Matrix = perspective(12.0, SIZE[0] / SIZE[1], distance / 2, distance * 4)
    pictures = []
    for draw in (head.draw, head.draw_hair):
        draw(view_matrix=view, projection=lens, camera_mm=place, light=light)
        data = np.frombuffer(frame.color_attachments[0].read(), dtype=np.float32)
        pictures.append(data.reshape(SIZE[1], SIZE[0], 4).copy())
    frame.release()
    return pictures[0], pictures[1]


def test_her_eyes_stand_where_the_camera_looks() -> None:
    body = figure()
    for side, x in (("l", INTEROCULAR_MM / 2), ("r", -INTEROCULAR_MM / 2)):
        centre = body.vertices_mm[body.mesh.vertices_of(f"helper-{side}-eye")].mean(axis=0)
        np.testing.assert_allclose(centre[:2], [x, 0.0], atol=0.6)


def test_her_head_has_human_size_and_her_arms_hang() -> None:
    body = figure()
    face = face_mesh().coarse.points_mm
    assert 190 < np.ptp(face[face[:, 1] > -130, 1]) < 270
    hand = body.rig.weights[:, body.rig.index("hand_l")] > 0.9
    assert body.vertices_mm[hand, 1].max() < -400


def test_skin_has_no_hole_between_fine_and_rest() -> None:
    face = face_mesh()
    low, high = face.fine.points_mm.min(axis=0), face.fine.points_mm.max(axis=0)
    inside = ((face.rest.points_mm > low) & (face.rest.points_mm < high)).all(axis=1)
    assert inside.any()


def test_normals_are_unit_vectors_that_point_outwards() -> None:
    face = face_mesh()
    for part in (face.fine, face.coarse, *face.patches):
        np.testing.assert_allclose(np.linalg.norm(part.normals, axis=1), 1.0, atol=1e-6)
    front = face.coarse.points_mm[:, 2] > 15
    assert np.median(face.coarse.normals[front, 2]) > 0.3
    for patch in face.patches:
        assert np.median(patch.normals[:, 2]) > 0.3


def test_the_sweater_covers_the_body_below_the_neck() -> None:
    garment = sweater(figure())
    assert garment.points_mm[:, 1].max() > -140
    assert garment.points_mm[:, 1].min() < -600
    lowest_skin = face_mesh().coarse.points_mm[:, 1].min()
    assert garment.points_mm[:, 1].max() > lowest_skin + 40


def test_no_skin_comes_through_the_sweater() -> None:
    garment, skin = sweater(figure()), face_mesh().coarse.points_mm
    hidden = skin[skin[:, 1] < -150.0]
    _, nearest = cKDTree(garment.points_mm).query(hidden)
    outwards = ((hidden - garment.points_mm[nearest]) * garment.normals[nearest]).sum(axis=1)
    assert len(hidden) > 100
    assert outwards.max() < -1.0


def test_hair_grows_inside_the_hairline_only() -> None:
    cap = hair_cap(face_mesh())
    strands = grow_hair(cap, np.random.Generator(np.random.PCG64(1)))
    assert inside_hairline(strands.points_mm[:, 0]).min() > -8.0
    face = np.array([[0.0, 0.0, 10.0], [0.0, -60.0, 10.0], [40.0, 30.0, 0.0]])
    assert (inside_hairline(face) < 0).all()


def test_cells_hold_every_triangle_once_and_skip_what_faces_away() -> None:
    part = face_mesh().coarse
    ordered, cells = sort_into_cells(part.points_mm, part.triangles)
    assert cells.count.sum() == 3 * len(part.triangles)
    np.testing.assert_array_equal(
        np.sort(np.sort(ordered, axis=1), axis=0),
        np.sort(np.sort(part.triangles, axis=1), axis=0),
    )
    place = np.array([0.0, 0.0, 1500.0])
    clip = perspective(40.0, 1.0, 500.0, 4000.0) @ look_at(place, np.zeros(3))
    everything = sum(count for _, count in cells.visible(clip.astype(float)))
    fronts = sum(count for _, count in cells.visible(clip.astype(float), place))
    assert everything == 3 * len(part.triangles)
    assert fronts < everything


def test_the_shadow_map_sees_the_head(light: Light) -> None:
    size = light.shadow_map.size[0]
    depth = np.frombuffer(light.shadow_map.read(), dtype=np.float32).reshape(size, size)
    assert 0.25 < (depth < 1.0).mean() < 0.95
    clip = light.world_to_shadow @ np.array([0.0, -40.0, 40.0, 1.0])
    assert (np.abs(clip[:3]) < 1.0).all()


@pytest.mark.parametrize("distance", [165.0, 380.0, 1500.0, 5000.0])
def test_skin_is_lit_and_finite_at_every_distance(
    gl: moderngl.Context, head: Head, light: Light, distance: float
) -> None:
    bare, _ = picture(gl, head, light, position=(0.0, 0.0, distance))
    assert np.isfinite(bare).all()
    covered = bare[..., 3] > 0
    assert covered.mean() > (0.05 if distance > 2000 else 0.25)
    lit = bare[covered][:, :3]
    assert 0.03 < np.median(lit) < 1.0


def test_the_fissure_is_left_open_for_the_eye(
    gl: moderngl.Context, head: Head, light: Light
) -> None:
    bare, _ = picture(gl, head, light, position=(31.0, 0.0, 165.0), target=(31.0, 0.0, 0.0))
    # The socket behind a globe that is not drawn here: dark or empty, never skin in the light.
    middle = bare[56:64, 78:84, :3]
    assert middle.max() < 0.15


def test_lashes_and_brows_change_a_close_picture(
    gl: moderngl.Context, head: Head, light: Light
) -> None:
    bare, haired = picture(gl, head, light, position=(0.0, 0.0, 380.0))
    changed = np.abs(haired - bare).max(axis=2) > 0.02
    assert 0.005 < changed.mean() < 0.2


def test_the_same_view_gives_the_same_pixels(
    gl: moderngl.Context, head: Head, light: Light
) -> None:
    first = picture(gl, head, light, position=(100.0, 0.0, 360.0))[1]
    picture(gl, head, light, position=(-900.0, 0.0, 1200.0))
    np.testing.assert_array_equal(first, picture(gl, head, light, position=(100.0, 0.0, 360.0))[1])


def test_shut_lids_close_the_fissure_with_lit_skin(gl: moderngl.Context, light: Light) -> None:
    low = Detail.uniform("low")
    spec = ClipSpec(left=low, right=low, blink=1.0)
    shut = Head(gl, spec)
    bare, haired = picture(gl, shut, light, position=(31.0, 0.0, 165.0), target=(31.0, 0.0, 0.0))
    middle = bare[56:64, 76:84, :3]
    assert middle.min() > 0.1
    assert np.median(middle) > 0.25
    # Her lashes went down with the lid.
    below = (haired - bare)[30:50].min()
    assert below < -0.05
    upper = shut.rims[1].upper_mm
    lower = np.interp(upper[:, 0], *shut.rims[1].lower_mm[:, :2].T)
    assert (upper[:, 1] - lower).max() < 1e-3


@pytest.mark.parametrize("name", ["fine", "coarse"])
def test_the_face_laps_over_the_lids_patches_all_around(name: str) -> None:
    """A face that ended beyond a patch's outline would let grazing views through between them."""
    part = getattr(face_mesh(), name)
    edges = np.sort(part.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, owners = np.unique(edges, axis=0, return_counts=True)
    open_points = part.points_mm[np.unique(edges[owners == 1])]
    for eye in (0, 1):
        x, y, z = to_patch(open_points, eye).T
        temple, nose, up, down = OUTLINE_MM
        reach = np.hypot(x / np.where(x > 0, temple, nose), y / np.where(y > 0, up, down))
        around = (reach < 1.3) & (z > -30.0)
        assert around.sum() > 40
        assert reach[around].max() < 1.0
