"""Skin: paint, the tile of pores, scattering and skylight."""

from __future__ import annotations

import numpy as np

from renderer.body.subdivide import subdivide, triangles_of
from renderer.head import skin, skin_light
from renderer.head.face_mesh import face_mesh
from renderer.head.sky_visibility import DIRECTIONS, look_up
from renderer.head.sun_shadow import orthographic
from renderer.light import Sky


def plane(size: int = 41, step_mm: float = 0.5) -> tuple[np.ndarray, np.ndarray]:
    """Return points and triangles of a flat square grid facing +z."""
    x, y = np.meshgrid(np.arange(size) * step_mm, np.arange(size) * step_mm, indexing="ij")
    points = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(size - 1), np.arange(size - 1), indexing="ij")
    corner = (i * size + j).ravel()
    quads = np.stack([corner, corner + size, corner + size + 1, corner + 1], axis=1)
    return points, triangles_of(quads)


def even_sky(radiance: float) -> Sky:
    harmonics = np.zeros((9, 3))
    harmonics[0] = radiance / 0.282095
    return Sky(np.array([0.0, 0.0, 1.0]), np.full(3, 2.0), harmonics)


def test_albedo_is_physical_and_skin_is_redder_than_blue() -> None:
    for part in (face_mesh().coarse, face_mesh().patches[0]):
        albedo, gloss = skin.paint(part)
        assert albedo.min() > 0.0
        assert albedo.max() < 0.8
        assert (albedo[:, 0] > albedo[:, 2]).all()
        assert gloss.min() >= 0.0
        assert gloss.max() <= 1.0


def lab(albedo: np.ndarray) -> np.ndarray:
    """Return CIELAB (n, 3) of linear Rec. 709 under D65 (IEC 61966-2-1, CIE 15)."""
    matrix = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    share = albedo @ np.array(matrix).T / [0.9505, 1.0, 1.089]
    x, y, z = np.cbrt(share).T
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=1)


def test_dry_skin_has_colours_that_were_measured_on_faces() -> None:
    """L* 55 to 73, a* 5 to 18, b* 8 to 22 hold the Caucasian faces of Xiao et al. 2017,

    "Characterising the variations in ethnic skin colours" (means 63, 11, 15), lids included.
    """
    face = face_mesh()
    for part, dry in (
        (face.fine, (face.fine.lips < 0.01) & (np.abs(face.fine.points_mm[:, 1]) < 12)),
        (face.patches[0], (face.patches[0].margin < 0.01) & (face.patches[0].wet < 0.01)),
    ):
        front = dry & (part.points_mm[:, 2] > 0.0) & (part.points_mm[:, 1] < 11.0)
        colours = lab(skin.paint(part)[0][front])
        assert front.sum() > 100
        low, high = np.percentile(colours, (2, 98), axis=0)
        assert (low > [55.0, 5.0, 8.0]).all(), low
        assert (high < [73.0, 18.0, 22.0]).all(), high


def test_thin_skin_is_bluer_and_inner_corners_are_redder_than_the_cheek() -> None:
    face = face_mesh()
    patch = face.patches[1]
    colours = lab(skin.paint(patch)[0])
    around, across = patch.along_mm.T
    upper_lid = (around > 10) & (around < 24) & (across > 3.5) & (across < 5.5)
    cheek = (around > 44) & (around < 58) & (across > 12.0)
    assert upper_lid.any()
    assert cheek.any()
    assert colours[upper_lid, 2].mean() < colours[cheek, 2].mean() - 0.5
    assert colours[upper_lid, 0].mean() < colours[cheek, 0].mean() - 2.0
    inner = (np.abs(around - 34) < 2) & (across > 2.0) & (across < 4.0)
    assert colours[inner, 1].mean() > colours[cheek, 1].mean() + 1.0


def test_the_wet_rim_is_redder_than_the_cheek() -> None:
    patch = face_mesh().patches[1]
    albedo, _ = skin.paint(patch)
    wet, dry = patch.wet > 0.9, (patch.lid < 0.1) & (patch.margin < 0.01)
    ratio = albedo[:, 1] / albedo[:, 0]
    assert ratio[wet].mean() < ratio[dry].mean() - 0.05


def test_pores_are_not_smeared_on_the_flanks_of_the_nose() -> None:
    """Neighbours across the face lie as far apart in the tile as in space, up to a third."""
    points = face_mesh().fine.points_mm
    edges = face_mesh().fine.triangles[:, :2]
    start, end = points[edges[:, 0]], points[edges[:, 1]]
    step = end - start
    flank = (np.abs(start[:, 0]) > 6) & (np.abs(start[:, 0]) < 15) & (np.abs(start[:, 1] + 25) < 14)
    across = np.abs(step[:, 1]) < 0.25 * np.linalg.norm(step, axis=1)
    chosen = edges[flank & across & (start[:, 2] > 0)]
    tile = skin.detail_coordinates(points) * skin.TILE_MM
    in_tile = np.linalg.norm(tile[chosen[:, 1]] - tile[chosen[:, 0]], axis=1)
    in_space = np.linalg.norm(points[chosen[:, 1]] - points[chosen[:, 0]], axis=1)
    assert len(chosen) > 20
    assert 0.75 < np.median(in_tile / in_space) < 1.35


def test_the_sockets_of_the_eyes_get_more_bounced_light_but_only_where_covered() -> None:
    points = np.array([[31.0, 9.0, 14.0], [31.0, -80.0, 14.0]])
    triangle = np.zeros((0, 3), dtype=int)
    normals = np.tile([0.0, 0.0, 1.0], (2, 1))

    def lit(share: float) -> np.ndarray:
        free = np.full((2, DIRECTIONS), share, dtype=np.float32)
        result = skin_light.light_skin(
            points, normals, triangle, sky=even_sky(0.5), open_sky=free, sun=np.zeros(2)
        )
        return result.diffuse

    covered, open_air = lit(0.5), lit(1.0)
    assert (covered[0] > 1.3 * covered[1]).all()
    np.testing.assert_allclose(open_air[0], open_air[1], rtol=1e-3)


def test_scattering_keeps_energy_and_spreads_red_the_furthest() -> None:
    points, triangles = plane()
    spot = np.zeros((len(points), 3))
    middle = len(points) // 2
    spot[middle] = 1.0
    spread = skin_light.scatter(points, triangles, spot)
    np.testing.assert_allclose(spread.sum(axis=0), 1.0, rtol=0.02)
    d2 = ((points - points[middle]) ** 2).sum(axis=1)
    width = (spread * d2[:, None]).sum(axis=0)
    assert width[0] > 2 * width[1] > 2 * width[2]


def test_an_open_white_plane_under_an_even_sky_sends_its_radiance_back() -> None:
    points, triangles = plane(11)
    normals = np.tile([0.0, 0, 1], (len(points), 1))
    sky = even_sky(0.5)
    free = np.ones((len(points), DIRECTIONS), dtype=np.float32)
    lit = skin_light.light_skin(
        points, normals, triangles, sky=sky, open_sky=free, sun=np.zeros(len(points))
    )
    np.testing.assert_allclose(lit.diffuse, 0.5, rtol=1e-3)
    np.testing.assert_allclose(lit.ambient, 1.0, rtol=1e-6)
    lit = skin_light.light_skin(
        points, normals, triangles, sky=sky, open_sky=free, sun=np.ones(len(points))
    )
    np.testing.assert_allclose(lit.diffuse, 0.5 + 2.0 / np.pi, rtol=1e-3)


def test_depth_maps_cover_what_lies_behind_and_free_what_lies_outside() -> None:
    matrix = orthographic(np.array([0.0, 0, 1]), (0.0, 0.0, 0.0), half_mm=10.0, depth_mm=100.0)
    depth = np.full((32, 32), 0.5, dtype=np.float32)  # a wall through the origin
    points = np.array([[0.0, 0, 5], [0.0, 0, -5], [50.0, 0, -5]])
    np.testing.assert_allclose(look_up(depth, matrix, points), [1.0, 0.0, 1.0])


def test_subdivision_rounds_a_cube_and_keeps_it_closed() -> None:
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    faces = np.array(
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    )
    points, quads = subdivide(corners, faces, levels=3)
    assert len(quads) == 6 * 4**3
    assert len(points) - len(quads) == 2  # Euler: V - E + F = 2 with E = 2 F
    radius = np.linalg.norm(points, axis=1)
    assert radius.max() / radius.min() < 1.25
