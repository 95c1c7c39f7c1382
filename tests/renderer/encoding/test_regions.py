"""Stretches with boxes: every frame comes out once, and each has the boxes of its stretch."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from renderer.encoding.decode import decode
from renderer.encoding.encode import open_encoder
from renderer.encoding.regions import Box, Stretch, filter_graph

SIZE = (128, 64)
LEFT, RIGHT = Box(0, 0, 64, 64, 30.0), Box(64, 0, 64, 64, 30.0)


def test_without_boxes_there_is_nothing_to_cut() -> None:
    assert filter_graph("scale=1", [], fps=30, out="clip") == "scale=1[clip]"


def test_a_graph_cuts_and_joins_what_it_is_given() -> None:
    graph = filter_graph("null", [Stretch(0, [LEFT]), Stretch(4, [RIGHT])], fps=30, out="clip")
    assert graph.split(";") == [
        "null,split=2[i0][i1]",
        "[i0]trim=start_frame=0:end_frame=4,setpts=PTS-STARTPTS,"
        "addroi=x=0:y=0:w=64:h=64:qoffset=-0.5882[o0]",
        "[i1]trim=start_frame=4,setpts=PTS-STARTPTS,addroi=x=64:y=0:w=64:h=64:qoffset=-0.5882[o1]",
        "[o0][o1]concat=n=2,setpts=N/30/TB[clip]",
    ]


def test_every_frame_comes_out_once_and_is_finer_where_its_boxes_are(tmp_path: Path) -> None:
    path, rng = tmp_path / "clip.mp4", np.random.default_rng(4)
    frames = [np.repeat(rng.integers(0, 256, (64, 128, 1), np.uint8), 3, axis=2) for _ in range(8)]
    last = [RIGHT, Box(0, 0, 128, 64, 1.0)]
    stretches = [Stretch(0, [LEFT]), Stretch(3, [LEFT]), Stretch(4, last)]  # one of them 1 frame
    with open_encoder(path, fps=30, size=SIZE, stretches=stretches, quality=40.0) as encoder:
        for frame in frames:
            encoder.write(frame)
    decoded = decode(path, range(8), size=SIZE)
    for number, frame in enumerate(frames):
        error = np.abs(decoded[number].astype(int) - frame).mean(axis=(0, 2))
        left, right = error[8:56].mean(), error[72:120].mean()
        finer, coarser = (left, right) if number < 4 else (right, left)
        assert 4 * finer < coarser, number
