import numpy as np

from renderer.body.decimate import decimate


def grid(n: int) -> tuple[np.ndarray, np.ndarray]:
    y, x = np.mgrid[0:n, 0:n]
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(n * n)], axis=1).astype(float)
    a = (y[:-1, :-1] * n + x[:-1, :-1]).ravel()
    triangles = np.concatenate(
        [np.stack([a, a + 1, a + n + 1], 1), np.stack([a, a + n + 1, a + n], 1)]
    )
    return vertices, triangles


def area(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a)[:, 2] / 2


def test_a_flat_sheet_keeps_its_outline_and_never_folds() -> None:
    vertices, triangles = grid(13)
    fewer = decimate(vertices, triangles, target=20)
    assert len(fewer) <= 20
    assert area(vertices, fewer).min() > 0
    np.testing.assert_allclose(area(vertices, fewer).sum(), 144.0)


def test_a_sphere_keeps_its_radius() -> None:
    vertices, triangles = grid(25)
    polar, around = vertices[:, 0] / 24 * 2.6 + 0.2, vertices[:, 1] / 24 * 2.6
    ball = np.stack(
        [np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)], axis=1
    )
    fewer = decimate(ball, triangles, target=300)
    assert 250 < len(fewer) <= 300
    middles = ball[fewer].mean(axis=1)
    assert np.linalg.norm(middles, axis=1).min() > 0.97


def test_important_parts_keep_more_vertices() -> None:
    vertices, triangles = grid(21)
    vertices[:, 2] = np.sin(vertices[:, 0] * 1.7) + np.cos(vertices[:, 1] * 1.9)
    is_left = vertices[:, 0] < 10
    importance = np.where(is_left, 50.0, 1.0)
    kept = np.unique(decimate(vertices, triangles, target=300, importance=importance))
    assert is_left[kept].sum() > 1.5 * (~is_left[kept]).sum()


def test_the_same_mesh_gives_the_same_triangles() -> None:
    vertices, triangles = grid(15)
    vertices[:, 2] = np.sin(vertices[:, 0])
    first, second = (decimate(vertices, triangles, target=100) for _ in range(2))
    np.testing.assert_array_equal(first, second)
