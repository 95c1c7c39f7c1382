"""eyes.glb, read by a parser of its own against the rules of glTF 2.0."""

from __future__ import annotations

import io
import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from renderer.clip import ClipSpec
from renderer.detail import STANDARD_LODS, TABLE, Detail
from renderer.exchange.gltf import gaze_quaternion, screen_share, write_eyes
from renderer.eye.model import gaze_rotation
from renderer.eye.place import eye_centre_mm

SPEC = ClipSpec(
    left=Detail(), right=Detail(), gaze_yaw_deg=12.0, gaze_pitch_deg=-7.0, vergence_deg=4.0
)
COMPONENTS = {5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


@dataclass
class Glb:
    """A parsed file: its document and its binary chunk."""

    json: dict[str, Any]
    data: bytes

    def accessor(self, number: int) -> np.ndarray:
        entry = self.json["accessors"][number]
        view = self.json["bufferViews"][entry["bufferView"]]
        kind, width = COMPONENTS[entry["componentType"]], WIDTHS[entry["type"]]
        start = view.get("byteOffset", 0) + entry.get("byteOffset", 0)
        values = np.frombuffer(self.data, kind, entry["count"] * width, start)
        return values.reshape(-1, width)

    def node(self, name: str) -> dict[str, Any]:
        return next(node for node in self.json["nodes"] if node["name"] == name)

    def primitives(self, lod_node: str) -> dict[str, dict[str, Any]]:
        """Return a LoD's primitives by their material's first word."""
        meshes = [
            self.json["meshes"][self.json["nodes"][child]["mesh"]]
            for child in self.node(lod_node)["children"]
        ]
        return {
            self.json["materials"][primitive["material"]]["name"].split("_")[0]: primitive
            for mesh in meshes
            for primitive in mesh["primitives"]
        }


def parse(path: Path) -> Glb:
    """Read a .glb as glTF 2.0, 4.4 has it."""
    content = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", content)
    assert (magic, version, length) == (b"glTF", 2, len(content))
    size, kind = struct.unpack_from("<I4s", content, 12)
    assert kind == b"JSON"
    assert size % 4 == 0
    document = json.loads(content[20 : 20 + size])
    binary_size, kind = struct.unpack_from("<I4s", content, 20 + size)
    assert kind == b"BIN\0"
    assert binary_size % 4 == 0
    binary = content[28 + size :]
    assert len(binary) == binary_size
    return Glb(document, binary)


@pytest.fixture(scope="module")
def glb(tmp_path_factory: pytest.TempPathFactory) -> Glb:
    return parse(write_eyes(tmp_path_factory.mktemp("gltf") / "new" / "eyes.glb", SPEC))


def test_every_reference_leads_somewhere_and_every_view_is_aligned(glb: Glb) -> None:
    document = glb.json
    assert document["asset"]["version"] == "2.0"
    [buffer] = document["buffers"]
    assert 0 <= len(glb.data) - buffer["byteLength"] < 4
    assert "uri" not in buffer
    end = 0
    for view in document["bufferViews"]:
        assert view["byteOffset"] % 4 == 0
        assert view["byteOffset"] >= end
        end = view["byteOffset"] + view["byteLength"]
    assert end <= buffer["byteLength"]
    for texture in document["textures"]:
        assert document["images"][texture["source"]]["bufferView"] < len(document["bufferViews"])
        assert document["samplers"][texture["sampler"]]
    used = set(document["extensionsUsed"])
    found = {
        name
        for part in ("nodes", "materials")
        for entry in document[part]
        for name in entry.get("extensions", {})
    }
    assert found == used
    assert "extensionsRequired" not in document


def test_accessors_have_their_own_bounds_and_finite_values(glb: Glb) -> None:
    for number, entry in enumerate(glb.json["accessors"]):
        values = glb.accessor(number)
        assert np.isfinite(values).all()
        np.testing.assert_array_equal(values.min(axis=0), np.array(entry["min"], values.dtype))
        np.testing.assert_array_equal(values.max(axis=0), np.array(entry["max"], values.dtype))


def test_vertices_are_whole_unit_and_all_indices_in_range(glb: Glb) -> None:
    for mesh in glb.json["meshes"]:
        for primitive in mesh["primitives"]:
            attributes = {name: glb.accessor(n) for name, n in primitive["attributes"].items()}
            count = len(attributes["POSITION"])
            assert {len(values) for values in attributes.values()} == {count}
            np.testing.assert_allclose(np.linalg.norm(attributes["NORMAL"], axis=1), 1.0, atol=1e-5)
            indices = glb.accessor(primitive["indices"])
            assert indices.max() == count - 1
            assert len(indices) % 3 == 0
            corners = attributes["POSITION"][indices.reshape(-1, 3)]
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            mean = attributes["NORMAL"][indices.reshape(-1, 3)].sum(axis=1)
            assert ((normals * mean).sum(axis=1) >= 0).all()
            if "TANGENT" in attributes:
                tangent = attributes["TANGENT"]
                np.testing.assert_allclose(np.linalg.norm(tangent[:, :3], axis=1), 1, atol=1e-5)
                across = (tangent[:, :3] * attributes["NORMAL"]).sum(axis=1)
                np.testing.assert_allclose(across, 0, atol=1e-4)
                assert set(np.unique(tangent[:, 3])) <= {-1.0, 1.0}


def test_each_lod_has_the_meshes_and_map_sizes_of_the_table(glb: Glb) -> None:
    document = glb.json
    for lod in STANDARD_LODS:
        parts = glb.primitives(f"eye_left_{lod}")
        assert set(parts) == ({"sclera", "iris"} if lod == "low" else {"sclera", "cornea", "iris"})
        if lod != "low":
            count = sum(len(glb.accessor(parts[p]["indices"])) for p in ("sclera", "cornea")) // 3
            settings = TABLE["tessellation"][lod].settings
            assert count == pytest.approx(int(settings["triangles"]), rel=0.1)
        sizes = {}
        for part in ("iris", "sclera"):
            material = document["materials"][parts[part]["material"]]
            textures = {
                "colour": material["pbrMetallicRoughness"]["baseColorTexture"],
                "normal": material.get("normalTexture"),
            }
            for what, texture in textures.items():
                if texture is not None:
                    image = document["images"][document["textures"][texture["index"]]["source"]]
                    assert image["mimeType"] == "image/png"
                    view = document["bufferViews"][image["bufferView"]]
                    start = view["byteOffset"]
                    png = Image.open(io.BytesIO(glb.data[start : start + view["byteLength"]]))
                    assert png.format == "PNG"
                    sizes[part, what] = png.size[0]
        expected = {
            ("iris", "colour"): TABLE["texture"][lod].settings["iris_map_px"],
            ("sclera", "colour"): TABLE["sclera"][lod].settings["diffuse_map_px"],
        }
        if lod in ("high", "ultra"):
            expected["iris", "normal"] = expected["iris", "colour"]
            expected["sclera", "normal"] = TABLE["sclera"][lod].settings["normal_map_px"]
        assert sizes == expected


def test_refraction_and_reflection_become_the_corneas_extensions(glb: Glb) -> None:
    corneas = {m["name"]: m for m in glb.json["materials"] if m["name"].startswith("cornea")}
    for lod, bends in (("medium", False), ("high", True), ("ultra", True)):
        extensions = corneas[f"cornea_{lod}"]["extensions"]
        assert extensions["KHR_materials_transmission"] == {"transmissionFactor": 1.0}
        assert extensions["KHR_materials_ior"]["ior"] == pytest.approx(1.336)
        assert ("KHR_materials_volume" in extensions) == bends
    clear = [
        m["name"]
        for m in glb.json["materials"]
        if "KHR_materials_clearcoat" in m.get("extensions", {})
    ]
    assert clear == ["sclera_medium", "sclera_high", "sclera_ultra"]


def test_the_highest_lod_names_the_others_and_stands_in_the_scene(glb: Glb) -> None:
    document = glb.json
    assert document["scenes"][document["scene"]]["nodes"] == [
        document["nodes"].index(glb.node(f"eye_{side}")) for side in ("left", "right")
    ]
    for side in ("left", "right"):
        highest = glb.node(f"eye_{side}_ultra")
        names = [document["nodes"][n]["name"] for n in highest["extensions"]["MSFT_lod"]["ids"]]
        assert names == [f"eye_{side}_{lod}" for lod in ("high", "medium", "low")]
        coverage = highest["extras"]["MSFT_screencoverage"]
        assert len(coverage) == 4
        assert coverage == sorted(coverage, reverse=True)
        assert glb.node(f"eye_{side}")["children"] == [document["nodes"].index(highest)]
    assert screen_share(200) == pytest.approx(np.pi * 200**2 / (1920 * 1080))


def test_eyes_stand_in_metres_and_look_where_the_clip_does(glb: Glb) -> None:
    for eye, side in enumerate(("left", "right")):
        node = glb.node(f"eye_{side}")
        np.testing.assert_allclose(node["translation"], eye_centre_mm(eye) / 1000)
        yaw = SPEC.gaze_yaw_deg + (0.5 - eye) * SPEC.vergence_deg
        x, y, z, w = node["rotation"]
        turned = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
        np.testing.assert_allclose(turned, gaze_rotation(yaw, SPEC.gaze_pitch_deg)[:, 2], atol=1e-9)
    assert np.linalg.norm(gaze_quaternion(30.0, 20.0)) == pytest.approx(1.0)
    globe = glb.accessor(glb.primitives("eye_left_ultra")["sclera"]["attributes"]["POSITION"])
    assert np.linalg.norm(globe, axis=1).max() == pytest.approx(0.01175, rel=0.01)


@pytest.mark.parametrize("lod", STANDARD_LODS)
def test_morph_targets_reach_both_ends_of_the_pupils_range(glb: Glb, lod: str) -> None:
    primitive = glb.primitives(f"eye_right_{lod}")["iris"]
    mesh = next(m for m in glb.json["meshes"] if m["name"] == f"eye_right_{lod}_iris")
    assert mesh["extras"]["targetNames"] == ["pupil 1.5 mm", "pupil 8 mm"]
    assert mesh["weights"] == [0.0, 0.0]
    rest = glb.accessor(primitive["attributes"]["POSITION"])
    tissue = rest[:, 2] > rest[:, 2].min() + 1e-4  # all but the black behind the pupil
    radius = np.hypot(*rest[tissue, :2].T)
    assert radius.min() == pytest.approx(0.5e-3 * SPEC.pupil_mm, rel=1e-4)
    for target, pupil_mm in zip(primitive["targets"], (1.5, 8.0), strict=True):
        moved = rest + glb.accessor(target["POSITION"])
        radius = np.hypot(*moved[tissue, :2].T)
        assert radius.min() == pytest.approx(0.5e-3 * pupil_mm, rel=1e-4)
        assert radius.max() == pytest.approx(5.85e-3, rel=1e-4)
        np.testing.assert_array_equal(moved[:, 2], rest[:, 2])
        np.testing.assert_array_equal(moved[~tissue], rest[~tissue])


def test_texture_coordinates_run_down_and_are_mirrored_for_the_right_eye(glb: Glb) -> None:
    left, right = (
        glb.primitives(f"eye_{s}_ultra")["iris"]["attributes"] for s in ("left", "right")
    )
    p, uv = glb.accessor(left["POSITION"]), glb.accessor(left["TEXCOORD_0"])
    off_axis = (np.abs(p[:, :2]) > 1e-4) & (p[:, 2:] > p[:, 2].min() + 1e-4)
    assert (np.sign(uv[:, 0] - 0.5) == np.sign(p[:, 0]))[off_axis[:, 0]].all()
    assert (np.sign(uv[:, 1] - 0.5) == -np.sign(p[:, 1]))[off_axis[:, 1]].all()
    mirrored = glb.accessor(right["TEXCOORD_0"])
    np.testing.assert_allclose(mirrored, [1, 0] + uv * [-1, 1], atol=1e-6)
    # Bitangent: cross(normal, tangent) * w points to where the picture's rows go up.
    for attributes in (left, right):
        tangent, normal = (glb.accessor(attributes[name]) for name in ("TANGENT", "NORMAL"))
        flat = normal[:, 2] > 0.999
        up = np.cross(normal, tangent[:, :3]) * tangent[:, 3:]
        np.testing.assert_allclose(up[flat], np.tile([0.0, 1.0, 0.0], (flat.sum(), 1)), atol=1e-3)
