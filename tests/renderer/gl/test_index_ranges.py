from renderer.gl.index_ranges import adjoined


def test_only_ranges_side_by_side_become_one() -> None:
    assert adjoined([(0, 3), (3, 6), (12, 3), (15, 9), (24, 0), (24, 3)]) == [(0, 9), (12, 15)]
    assert adjoined([(3, 3), (0, 3), (0, 3)]) == [(3, 3), (0, 3), (0, 3)]
    assert adjoined([]) == []
