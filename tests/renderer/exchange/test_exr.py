"""OpenEXR and Radiance files: what is written is read back, what is broken is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from renderer.exchange.exr import REC_709, read_attributes, read_exr, write_exr
from renderer.exchange.radiance import read_radiance


def picture(height: int = 6, width: int = 12) -> np.ndarray:
    rng = np.random.Generator(np.random.PCG64(3))
    return (rng.uniform(size=(height, width, 3)) * 50).astype(np.float32)


def test_floats_come_back_bit_for_bit_with_their_words(tmp_path: Path) -> None:
    path = tmp_path / "new" / "x.exr"
    write_exr(path, picture(), attributes={"spec": '{"a": 1}', "exposure": 0.8})
    np.testing.assert_array_equal(read_exr(path), picture())
    found = read_attributes(path)
    assert found["spec"] == '{"a": 1}'
    assert found["exposure"] == pytest.approx(0.8)
    assert found["compression"] == OpenEXR.ZIP_COMPRESSION
    np.testing.assert_allclose(found["chromaticities"], REC_709)
    assert [entry.name for entry in path.parent.iterdir()] == ["x.exr"]


def test_halves_are_cut_where_halves_end(tmp_path: Path) -> None:
    pixels = picture()
    pixels[0, 0] = 1e6
    write_exr(tmp_path / "x.exr", pixels, half=True)
    back = read_exr(tmp_path / "x.exr")
    np.testing.assert_array_equal(back[0, 0], 65504.0)
    np.testing.assert_allclose(back[1:], pixels[1:], rtol=1e-3)


def test_data_is_no_colour(tmp_path: Path) -> None:
    write_exr(tmp_path / "z.exr", picture()[..., :2], channels=("x_mm", "y_mm"))
    assert "chromaticities" not in read_attributes(tmp_path / "z.exr")
    with pytest.raises(ValueError, match=r"z\.exr: no colours; it has x_mm, y_mm, needed are R, G"):
        read_exr(tmp_path / "z.exr")
    with pytest.raises(ValueError, match="2 channels of pixels for 3 names"):
        write_exr(tmp_path / "z.exr", picture()[..., :2])


def test_luminance_alone_is_grey(tmp_path: Path) -> None:
    write_exr(tmp_path / "y.exr", picture()[..., 0], channels="Y")
    np.testing.assert_array_equal(read_exr(tmp_path / "y.exr"), picture()[..., [0, 0, 0]])


def test_other_primaries_are_converted_and_white_stays_white(tmp_path: Path) -> None:
    # ACEScg (SMPTE ST 2065-4 white): its red lies outside Rec. 709, green and blue go below zero.
    acescg = (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767)
    pixels = np.array([[[1, 1, 1], [1, 0, 0]]], np.float32)
    header = {"type": OpenEXR.scanlineimage, "chromaticities": acescg}
    OpenEXR.File(header, {"RGB": pixels}).write(str(tmp_path / "ap1.exr"))
    white, red = read_exr(tmp_path / "ap1.exr")[0]
    np.testing.assert_allclose(white, 1.0, atol=1e-4)
    np.testing.assert_allclose(
        red, [1.7051, -0.1302, -0.0240], atol=2e-3
    )  # colour-science's matrix


@pytest.mark.parametrize("content", [b"", b"hello", b"\x76\x2f\x31\x01nonsense"])
def test_what_is_no_exr_is_refused_in_one_line(
    tmp_path: Path, content: bytes, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "x.exr"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=r"x\.exr: (not an|a damaged) OpenEXR file") as caught:
        read_exr(path)
    assert "\n" not in str(caught.value)
    assert capfd.readouterr() == ("", "")


def test_a_cut_file_is_refused_without_the_librarys_own_prints(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    write_exr(tmp_path / "x.exr", picture(64, 128))
    whole = (tmp_path / "x.exr").read_bytes()
    (tmp_path / "x.exr").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(ValueError, match=r"x\.exr: a damaged OpenEXR file; get it anew"):
        read_exr(tmp_path / "x.exr")
    assert capfd.readouterr() == ("", "")


HEAD = b"#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\n"


def rgbe(mantissas: list[int], exponent: int) -> bytes:
    return bytes([*mantissas, exponent])


def test_radiance_pixels_have_wards_values(tmp_path: Path) -> None:
    path = tmp_path / "x.hdr"
    one, dark = rgbe([128, 64, 0], 129), rgbe([9, 9, 9], 0)
    path.write_bytes(HEAD + b"\n-Y 1 +X 2\n" + one + dark)
    first, second = read_radiance(path)[0]
    np.testing.assert_allclose(first, np.array([128.5, 64.5, 0.5]) / 128)
    np.testing.assert_array_equal(second, 0.0)


def test_radiance_runs_are_unpacked_and_exposure_divided(tmp_path: Path) -> None:
    width = 10
    row = bytes([2, 2, 0, width])
    row += bytes([128 + width, 100])  # red: one run
    row += bytes([4, 1, 2, 3, 4, 128 + 6, 7])  # green: four values, then a run
    row += bytes([width, *range(width)])  # blue: values
    row += bytes([128 + width, 136])
    path = tmp_path / "x.hdr"
    path.write_bytes(HEAD + b"EXPOSURE=2\n\n-Y 2 +X 10\n" + row + row)
    pixels = read_radiance(path)
    expected = np.stack([[100] * 10, [1, 2, 3, 4, 7, 7, 7, 7, 7, 7], range(10)], axis=-1) + 0.5
    np.testing.assert_allclose(pixels, np.stack([expected, expected]) / 2)


def test_old_radiance_runs_repeat_the_last_pixel(tmp_path: Path) -> None:
    path = tmp_path / "x.hdr"
    path.write_bytes(HEAD + b"\n-Y 1 +X 4\n" + rgbe([10, 20, 30], 136) + rgbe([1, 1, 1], 3))
    np.testing.assert_allclose(read_radiance(path)[0], [[10.5, 20.5, 30.5]] * 4)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"P6 nonsense", "not a Radiance file, whatever its name says"),
        (HEAD + b"\n+Y 1 +X 1\n", "a Radiance file of another kind; needed are FORMAT=32-bit"),
        (HEAD.replace(b"rgbe", b"xyze") + b"\n-Y 1 +X 1\n....", "of another kind"),
        (HEAD + b"\n-Y 4 +X 4\nshort", "a damaged Radiance file; get it anew"),
        (HEAD + b"\n-Y 0 +X 4\n", "a picture without pixels"),
        (HEAD + b"\n-Y 1 +X 8\n" + bytes([2, 2, 0, 8, 0, 0]), "a damaged Radiance file"),
    ],
)
def test_broken_radiance_files_are_refused(tmp_path: Path, content: bytes, message: str) -> None:
    path = tmp_path / "x.hdr"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=message):
        read_radiance(path)
