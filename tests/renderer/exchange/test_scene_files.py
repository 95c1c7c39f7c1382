"""An exported scene, read back by others: Mitsuba, OpenEXR, Pillow; drawn where it was drawn."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import mitsuba as mi
import moderngl
import numpy as np
import OpenEXR
import pytest
from PIL import Image

from renderer.camera import iris_px, views
from renderer.clip import ClipSpec
from renderer.colour import linear_to_srgb
from renderer.detail import Detail
from renderer.exchange.camera_file import cameras, project
from renderer.exchange.environment_file import lat_long_of
from renderer.exchange.exr import read_exr, write_exr
from renderer.exchange.scene_files import write_scene
from renderer.frame.frame import FrameRenderer
from renderer.iris.source import iris_of
from renderer.park.cube_faces import FACE_AXES
from renderer.park.cube_target import CubeTarget
from renderer.park.lat_long import sh_of_lat_long
from renderer.scene import Scene

SPEC = ClipSpec(
    left=Detail.uniform("medium"),
    right=Detail.uniform("high"),
    distance="near",
    width=240,
    height=136,
    gaze_yaw_deg=6.0,
)
AZIMUTH_DEG = 15.0
COLOURS = [(1, 0, 0), (0, 1, 1), (0, 1, 0), (1, 0, 1), (0, 0, 1), (1, 1, 0)]


@pytest.fixture(scope="module")
def renderer(gl: moderngl.Context, standard_scene: Scene) -> FrameRenderer:
    return FrameRenderer(gl, SPEC, scene=standard_scene)


@pytest.fixture(scope="module")
def folder(renderer: FrameRenderer, tmp_path_factory: pytest.TempPathFactory) -> Path:
    mi.set_variant("scalar_rgb")
    mi.set_log_level(mi.LogLevel.Error)
    folder = tmp_path_factory.mktemp("scene")
    write_scene(folder, renderer, azimuth_deg=AZIMUTH_DEG)
    return folder


@pytest.fixture(scope="module")
def index(folder: Path) -> dict[str, Any]:
    return json.loads((folder / "scene.json").read_text())


def load(folder: Path, entry: dict[str, Any]) -> Any:
    return mi.load_dict({"type": "ply", "filename": str(folder / entry["file"])})


def test_the_index_names_every_file_and_no_other(folder: Path, index: dict[str, Any]) -> None:
    named = {entry["file"] for part in ("meshes", "textures") for entry in index[part]}
    named |= {"scene.json", "README.txt", index["camera"], index["environment"]["file"]}
    found = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert found == named
    assert ClipSpec.from_dict(index["clip"]) == SPEC
    names = [entry["name"] for entry in index["meshes"]]
    wanted = {
        *(
            f"{part}_{side}"
            for side in ("left", "right")
            for part in (
                "cornea",
                "sclera",
                "iris",
                "iris_relief",
                "lids",
                "corners",
                "lashes",
                "brow",
            )
        ),
        *("face", "head", "sweater", "hair"),
    }
    assert wanted <= set(names)
    assert sum(name.startswith("crowd") for name in names) == 5
    assert {entry["material"] for entry in index["meshes"]} <= set(index["materials"])
    assert index["materials"]["cornea"]["interior_ior"] == pytest.approx(1.336)


def test_mitsuba_reads_every_mesh_as_the_index_describes_it(
    folder: Path, index: dict[str, Any]
) -> None:
    for entry in index["meshes"]:
        mesh = load(folder, entry)
        assert (mesh.vertex_count(), mesh.face_count()) == (entry["vertices"], entry["triangles"])
        box = mesh.bbox()
        np.testing.assert_allclose([list(box.min), list(box.max)], entry["bounds"], atol=2e-3)
        values = mi.traverse(mesh)
        normals = np.array(values["vertex_normals"]).reshape(-1, 3)
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-3)
        has_map = entry["name"].split("_")[0] in ("sclera", "iris")
        assert mesh.has_vertex_texcoords() == has_map
        if not has_map and not entry["name"].startswith("cornea"):
            colours = np.array(values["vertex_color"])
            assert 0.0 <= colours.min() <= colours.max() <= 1.0


def test_meshes_lie_where_the_renderer_draws_them(
    folder: Path, index: dict[str, Any], renderer: FrameRenderer, gl: moderngl.Context
) -> None:
    """The head's depth in our picture is how far Mitsuba's rays go from the same camera."""
    [camera] = json.loads((folder / "camera.json").read_text())["views"]
    [view] = views(SPEC, AZIMUTH_DEG)
    width, height = SPEC.width, SPEC.height
    depth = gl.depth_texture((width, height))
    depth.compare_func = ""
    target = gl.framebuffer(depth_attachment=depth)
    target.use()
    target.clear(depth=1.0)
    gl.enable_only(moderngl.DEPTH_TEST)
    matrix = view.projection.astype(float) @ view.view_matrix.astype(float)
    renderer.scene.head.draw_depth(matrix)
    drawn = np.frombuffer(depth.read(), np.float32).reshape(height, width)[::-1]
    parts = ("face", "head", "lids_left", "lids_right", "corners_left", "corners_right")
    scene = mi.load_dict(
        {"type": "scene"}
        | {
            e["name"]: {"type": "ply", "filename": str(folder / e["file"])}
            for e in index["meshes"]
            if e["name"] in parts
        }
    )
    inverse = np.linalg.inv(np.array(camera["projection"]) @ np.array(camera["world_to_camera"]))
    origin = np.array(camera["position"])
    compared, close = 0, 0
    for row in range(4, height, 9):
        for column in range(4, width, 9):
            ndc = [(column + 0.5) / width * 2 - 1, 1 - (row + 0.5) / height * 2]
            far = inverse @ [*ndc, 1.0, 1.0]
            direction = far[:3] / far[3] - origin
            ray = mi.Ray3f(origin.tolist(), (direction / np.linalg.norm(direction)).tolist())
            hit = scene.ray_intersect(ray)
            if hit.is_valid() and drawn[row, column] < 1.0:
                ours = inverse @ [*ndc, 2 * drawn[row, column] - 1, 1.0]
                compared += 1
                close += np.linalg.norm(ours[:3] / ours[3] - np.array(hit.p).ravel()) < 0.5
    assert compared > 150
    assert close > 0.95 * compared


def test_the_limbus_projects_to_the_pixels_that_the_manifest_promises(
    folder: Path, index: dict[str, Any]
) -> None:
    [camera] = json.loads((folder / "camera.json").read_text())["views"]
    for eye, side in enumerate(("left", "right")):
        entry = next(e for e in index["meshes"] if e["name"] == f"cornea_{side}")
        points = np.array(mi.traverse(load(folder, entry))["vertex_positions"]).reshape(-1, 3)
        pixels = project(camera, points)
        assert (pixels > 0).all()
        assert (pixels < [SPEC.width, SPEC.height]).all()
        # The widest extent is across the direction in which the limbus is foreshortened.
        assert np.ptp(pixels[:, 1]) == pytest.approx(iris_px(SPEC, AZIMUTH_DEG)[eye], rel=0.03)
    assert camera["rectangle_px"] == [0, 0, SPEC.width, SPEC.height]


def test_a_macroscopic_picture_has_a_camera_for_each_half() -> None:
    spec = ClipSpec(left=Detail(), right=Detail(), width=400, height=200)
    left, right = cameras(spec, 0.0, 10.0)["views"]
    assert (left["eyes"], left["rectangle_px"]) == (["left"], [0, 0, 200, 200])
    assert (right["eyes"], right["rectangle_px"]) == (["right"], [200, 0, 200, 200])
    np.testing.assert_allclose(project(right, np.array([[31.0, 0.0, 0.0]])), [[300.0, 100.0]])
    identity = np.array(left["world_to_camera"]) @ np.array(left["camera_to_world"])
    np.testing.assert_allclose(identity, np.eye(4), atol=1e-5)
    assert left["forward"][1] < 0  # it looks down from above


def test_maps_are_the_renderers_own_first_row_on_top(folder: Path, index: dict[str, Any]) -> None:
    for eye, side in ((0, "left"), (1, "right")):
        size = int((SPEC.left, SPEC.right)[eye].setting("texture", "iris_map_px"))
        maps = iris_of(SPEC).maps(size)
        entries = {e["file"]: e for e in index["textures"] if e["eye"] == side}
        with Image.open(folder / f"textures/iris_albedo_{side}.png") as picture:
            colour = np.asarray(picture)
        assert entries[f"textures/iris_albedo_{side}.png"]["encoding"] == "sRGB"
        expected = np.clip(linear_to_srgb(maps.albedo[::-1]), 0, 1) * 255
        assert np.abs(colour - expected).max() <= 0.51
        for file, entry in entries.items():
            if file.endswith(".png"):
                with Image.open(folder / file) as picture:
                    assert list(picture.size) == entry["size_px"]
    with OpenEXR.File(
        str(folder / "textures/iris_height_right.exr"), separate_channels=True
    ) as file:
        height = file.channels()["height_mm"].pixels
    np.testing.assert_allclose(height, maps.height_mm[::-1])
    with OpenEXR.File(str(folder / "textures/caustic_right.exr"), separate_channels=True) as file:
        channels = {name: channel.pixels for name, channel in file.channels().items()}
    assert set(channels) == {"direction_x", "direction_y", "irradiance"}
    assert 0.3 < channels["irradiance"].mean() < 1.2


def test_six_coloured_directions_are_where_mitsuba_looks_for_them(
    gl: moderngl.Context, tmp_path: Path
) -> None:
    mi.set_variant("scalar_rgb")
    cube = CubeTarget(gl, 32)
    for face, colour in enumerate(COLOURS):
        cube.attach(face).clear(*colour, 1.0)
    path = tmp_path / "six.exr"
    write_exr(path, lat_long_of(gl, cube.texture, width_px=256), half=True)
    emitter = mi.load_dict({"type": "envmap", "filename": str(path)})
    scene = mi.load_dict({"type": "scene", "e": {"type": "envmap", "filename": str(path)}})
    del emitter
    for axes, colour in zip(FACE_AXES, COLOURS, strict=True):
        ray = mi.Ray3f([0.0, 0.0, 0.0], axes[:, 2].tolist())
        hit = scene.ray_intersect(ray)
        seen = np.array(hit.emitter(scene).eval(hit)).ravel()
        np.testing.assert_allclose(seen, colour, atol=0.01)


def test_the_environments_file_holds_the_light_without_the_sun(
    folder: Path, index: dict[str, Any], renderer: FrameRenderer
) -> None:
    found = sh_of_lat_long(read_exr(folder / index["environment"]["file"]))
    ambient = renderer.scene.light.sky.ambient_sh
    np.testing.assert_allclose(found[0], ambient[0], rtol=0.02)
    np.testing.assert_allclose(found, ambient, atol=0.05 * np.abs(ambient[0]).max())
    direction = np.array(index["sun"]["direction_to_sun"])
    np.testing.assert_allclose(direction, renderer.scene.light.sky.sun_direction)


def test_the_readme_and_the_index_are_plain_text(folder: Path, index: dict[str, Any]) -> None:
    words = (folder / "README.txt").read_text(encoding="ascii")
    assert max(map(len, words.splitlines())) <= 100
    assert "millimetres" in words
    assert index["unit"] == "mm"
