"""Every kind of trouble meets every kind of request, however few there are of one."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np

from study.load.proxy import Proxy
from study.load.site import LoadedSite
from study.load.trouble import MISCHIEF, Killer, Trouble


def test_every_trouble_comes_once_before_any_comes_twice(tmp_path: Path) -> None:
    seen: Counter[tuple[str, str]] = Counter()
    site = LoadedSite(tmp_path, "sqlite://")
    crowd = [
        Trouble(Proxy(0), Killer(site, []), np.random.default_rng(number), 1.0, seen)
        for number in range(len(MISCHIEF))
    ]
    drawn = [one.draw("consent") for one in crowd]
    assert sorted(drawn) == sorted(MISCHIEF)
    assert drawn != list(MISCHIEF)
    crowd[0].draw("answer")
    assert seen.total() == len(MISCHIEF) + 1
