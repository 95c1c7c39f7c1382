"""The whole way: tables in; charts, tables and one self-contained report out."""

import json
import operator
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import analysis
from analysis.charts import CHARTS
from analysis.report.summary import Summary
from analysis.simulation.observers import Stimulus
from analysis.simulation.simulated import simulate_tables
from analysis.tables.reading import Tables, tables_from
from renderer.lod.policy import read_policy


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Path:
    rows = [
        {
            "renderer": "llvmpipe",
            "size": "1920x1080",
            "distance": distance,
            "iris_px": 100,
            "eyes": 2,
            "lod": lod,
            "ms_median": ms,
            "ms_mad": 1,
            "n": 9,
        }
        for distance in ("macroscopic", "near", "far")
        for lod, ms in (("low", 61.5), ("medium", 70), ("high", 150), ("ultra", 310))
    ]
    path = tmp_path_factory.mktemp("bench") / "bench.json"
    path.write_text(json.dumps(rows))
    return path


@pytest.fixture(scope="module")
def published(
    thesis_tables: Tables, bench: Path, tmp_path_factory: pytest.TempPathFactory
) -> Summary:
    return analysis.analyse(thesis_tables, tmp_path_factory.mktemp("out"), bench=bench)


def test_every_chart_is_written_as_svg_png_and_csv(published: Summary) -> None:
    names = {path.name for path in published.files}
    for chart in CHARTS:
        assert {f"{chart.name}.{kind}" for kind in ("svg", "png", "csv")} <= names
    assert all(path.is_file() for path in published.files)


def test_every_table_is_labelled_simulated(published: Summary) -> None:
    tables = [path for path in published.files if path.suffix == ".csv"]
    assert len(tables) > 15
    # The thesis showed no equal pairs, and nobody is flagged here: these charts say so.
    empty = {"detection.csv", "noticed-by-size.csv", "verdict-stability.csv"}
    for path in tables:
        frame = pd.read_csv(path)
        assert frame["simulated"].all(), path.name
        assert len(frame) or path.name in empty, path.name


def test_the_policy_is_written_for_the_renderer_to_read(published: Summary) -> None:
    (path,) = (path for path in published.files if path.name == "lod_policy.json")
    file = read_policy(path)
    assert file.policy.steps[-1].lod == "ultra"  # without equal pairs nothing less is shown
    assert file.provenance["simulated"] is True
    assert file.provenance["people"] == 10
    assert file.evidence[-1].ms == 155.0  # a frame's 310 ms for two eyes


class _References(HTMLParser):
    """Collects what a page would load from elsewhere, and checks that tags are closed."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []
        self.open: list[str] = []
        self.images = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in ("meta", "img", "link"):
            self.open.append(tag)
        self.images += tag == "img"
        self.found += [
            str(value)
            for name, value in attrs
            if name in ("src", "href", "srcset", "data") and not str(value).startswith("data:")
        ]

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_the_report_stands_on_its_own(published: Summary) -> None:
    text = published.report.read_text(encoding="utf-8")
    page = _References()
    page.feed(text)
    assert page.found == []
    assert page.open == []
    assert page.images == len(CHARTS)
    assert "<script" not in text
    assert "url(" not in text
    assert "@import" not in text


def test_the_report_opens_with_the_answer_and_says_simulated(
    published: Summary,
) -> None:
    text = published.report.read_text(encoding="utf-8")
    headings = re.findall(r"<h2>(.*?)</h2>", text)
    assert headings[:3] == ["Answer", "Design", "What cannot be concluded"]
    assert text.index('<figure id="decision-chart">') < text.index("<h2>Design</h2>")
    assert text.index("SIMULATED DATA: these answers") < text.index("<h2>Answer")
    assert [distance for distance, _ in published.verdicts][:3] == ["macroscopic", "near", "far"]
    for distance, sentence in published.verdicts:
        assert f"<li><b>{distance}</b>: {sentence}</li>" in text
    for finding in published.findings:
        assert f"<li><b>{finding.distance}</b>" in text


def test_the_report_names_costs_versions_and_formulas(published: Summary) -> None:
    text = published.report.read_text(encoding="utf-8")
    assert "2 eyes, 1920x1080 pixels, llvmpipe" in text
    assert "61.5\N{NO-BREAK SPACE}ms" in text
    for wanted in ("scipy 1.", "numpy 2.", "SHA-256", "m ± t(n−1; .975) s / √n", "Wilson"):
        assert wanted in text


def test_short_tables_are_printed_on_one_page(published: Summary) -> None:
    text = published.report.read_text(encoding="utf-8")
    found = re.findall(r'<div class="scroll( short)?".*?<tbody>(.*?)</tbody>', text, re.DOTALL)
    rows = {(bool(short), body.count("<tr>") <= 12) for short, body in found}
    assert rows == {(True, True), (False, False)}
    assert ".short { break-inside: avoid; } thead, tbody tr:nth-child(-n+3) { break-after" in text


def test_the_terminal_gets_one_line_per_distance(published: Summary) -> None:
    lines = published.lines()
    assert lines[0] == "SIMULATED DATA"
    assert [line.partition(":")[0] for line in lines[1:4]] == ["macroscopic", "near", "far"]


def test_the_same_tables_give_the_same_report(
    published: Summary, thesis_tables: Tables, bench: Path, tmp_path: Path
) -> None:
    again = analysis.analyse(thesis_tables, tmp_path, bench=bench)
    assert again.report.read_bytes() == published.report.read_bytes()


def test_what_people_wrote_is_escaped(tmp_path: Path) -> None:
    hostile = "<script>alert(1)</script>"
    frame = pd.DataFrame({"participant": [hostile] * 2, "lod": ["low", hostile], "rating": [1, 2]})
    summary = analysis.analyse(tables_from({"ratings": frame}), tmp_path / "new" / "folder")
    text = summary.report.read_text(encoding="utf-8")
    assert "<script" not in text
    assert "&lt;script&gt;" in text


def degenerate() -> dict[str, dict[str, pd.DataFrame]]:
    rng = np.random.default_rng(5)
    clip = {"1": Stimulus("near", 160.0, "low", "ultra")}
    catch = {"1": Stimulus("near", 160.0, "high", "high")}
    one = simulate_tables(clip, rng, participants=1)
    some = simulate_tables(clip, rng, participants=4)
    missing = {
        "ratings": some["ratings"].assign(rating=None),
        "comparisons": some["comparisons"].assign(comparison=None, noticed=None),
    }
    constant = {"ratings": some["ratings"].assign(rating=3)}
    return {
        "nobody": simulate_tables(clip, rng, participants=0),
        "one person, one clip": one,
        "all missing": missing,
        "ratings all alike": constant,
        "one rating": {"ratings": one["ratings"].head(1)},
        "repeated rows": {name: pd.concat([frame] * 2) for name, frame in some.items()},
        "catch clips only": simulate_tables(catch, rng, participants=3),
        "comparisons only": {
            "ratings": some["ratings"].head(0),
            "comparisons": some["comparisons"],
        },
    }


@pytest.mark.parametrize("name", list(degenerate()))
def test_odd_data_give_an_answer_or_a_statement(name: str, tmp_path: Path) -> None:
    summary = analysis.analyse(tables_from(degenerate()[name]), tmp_path)
    wanted = {
        "nobody": "There are no ratings yet, so nothing can be said about realism.",
        "one person, one clip": "from one person, which says nothing about others",
        "all missing": "All ratings are missing, so nothing can be said about realism.",
        "ratings all alike": "only ultra was shown to be enough: for low it was not shown",
        "one rating": "so nothing can be compared",
        "repeated rows": "Note: ratings.csv: 8 repeated rows were left out.",
        "catch clips only": "so nothing can be compared",
        "comparisons only": "There are no ratings yet, so nothing can be said about realism.",
    }
    assert wanted[name] in "\n".join(summary.lines())
    assert "nan" not in "\n".join([*summary.lines(), *summary.limits, *summary.quality])


def test_bench_faults_stop_before_anything_is_written(
    thesis_tables: Tables, tmp_path: Path
) -> None:
    with pytest.raises(analysis.TableError):
        analysis.analyse(thesis_tables, tmp_path / "out", bench=tmp_path / "no.json")
    assert not (tmp_path / "out").exists()


def test_a_margin_wider_than_the_scale_is_refused(thesis_tables: Tables, tmp_path: Path) -> None:
    wide = analysis.Margins(realism_points=9.0)
    with pytest.raises(ValueError, match="found 9; accepted: above 0 and below 4, as ratings go"):
        analysis.analyse(thesis_tables, tmp_path / "out", margins=wide)
    assert not (tmp_path / "out").exists()


def test_importing_the_package_loads_no_plotting_or_tables() -> None:
    code = (
        "import sys, analysis; analysis.COLUMNS; "
        "print([m for m in ('matplotlib', 'pandas', 'scipy') if m in sys.modules])"
    )
    root = Path(analysis.__file__).parents[1]
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=root
    )
    assert done.stdout.strip() == "[]"


def test_analysing_needs_no_web_framework_database_or_gl() -> None:
    code = (
        "import sys, analysis; analysis.analyse, analysis.read_source, analysis.figures; "
        "bad = ('fastapi', 'starlette', 'sqlalchemy', 'moderngl', 'matplotlib.pyplot', "
        "'renderer', 'study'); print([m for m in bad if m in sys.modules])"
    )
    root = Path(analysis.__file__).parents[1]
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=root
    )
    assert done.stdout.strip() == "[]"


def test_everything_that_is_public_can_be_had() -> None:
    for name in analysis.__all__:
        assert getattr(analysis, name) is not None
    with pytest.raises(AttributeError, match='module "analysis" has no attribute "guess"'):
        operator.attrgetter("guess")(analysis)
