"""The dashboard: who gets in, what is seen at a glance, what is hidden, what can be taken away."""

from __future__ import annotations

import base64
import io
import json
import re
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pandas as pd
import pytest

from study.data import figures, figures_shown, jobs, logbook, researchers
from study.data.schema import FigureSetRow
from study.figures import draw_claimed
from study.simulate import simulate


@pytest.fixture
def ada(site: Any) -> Iterator[Any]:
    """A researcher who has signed in."""
    one = site.guest()
    one.sign_in()
    yield one
    one.client.close()


PAGES = ("", "/people", "/clips", "/results", "/data")


def test_every_page_asks_a_stranger_to_sign_in(guest: Any) -> None:
    for page in (*PAGES, "/data/ratings.csv", "/results/people/x.svg"):
        guest.get(f"/researcher{page}")
        assert guest.at == "/researcher/sign-in", page


def test_every_page_opens_with_nobody_there(ada: Any) -> None:
    for page in PAGES:
        assert ada.get(f"/researcher{page}").status_code == 200, page


def test_signing_in_sets_a_cookie_that_scripts_and_other_sites_cannot_use(guest: Any) -> None:
    guest.get("/researcher/sign-in")
    answer = guest.client.post(
        "/researcher/sign-in",
        data={"name": "ada", "password": "correct horse battery"},
        follow_redirects=False,
    )
    assert answer.headers["location"] == "/researcher"
    assert "HttpOnly" in answer.headers["set-cookie"]
    assert "SameSite=lax" in answer.headers["set-cookie"]


def test_a_wrong_password_is_told_and_guessers_have_to_wait(guest: Any) -> None:
    for _ in range(researchers.FREE_ATTEMPTS_PER_NAME):
        page = guest.sign_in(password="wrong wrong wrong")
        assert page.status_code == 401
        assert "Name or password is not right." in page.text
    page = guest.sign_in()
    assert page.status_code == 429
    assert "Too many attempts; try again in 15 minutes." in page.text
    assert 0 < int(page.headers["retry-after"]) <= 900


def test_a_made_up_cookie_opens_nothing(guest: Any) -> None:
    guest.client.cookies.set("ocularist_researcher", "MQ.aaaa.bbbb")
    guest.get("/researcher")
    assert guest.at == "/researcher/sign-in"


def test_signing_out_needs_the_forms_token(ada: Any) -> None:
    assert ada.client.post("/researcher/sign-out", data={}).status_code == 403
    ada.get("/researcher")
    ada.post("/researcher/sign-out")
    ada.get("/researcher")
    assert ada.at == "/researcher/sign-in"


def tile(page: str, name: str) -> list[str]:
    return re.findall(rf"<dt>{name}</dt><dd>([^<]*)", page)


def test_the_overview_counts_real_and_simulated_people_apart(site: Any, ada: Any) -> None:
    simulate(site.db, site.study.definition, participants=3, seed=1)
    person = site.guest()
    person.walk_to_trial()
    person.watch()
    person.finish(rating_left="3")
    person.watch(dropped_frames=2, presented_frames=10)
    person.finish(rating_left="3", rating_right="2", comparison="1")
    person.client.close()
    page = ada.get("/researcher").text
    assert tile(page, "Came") == ["1", "3"]
    assert tile(page, "At work now") == ["1", "0"]
    assert tile(page, "Completed") == ["0", "3"]
    assert tile(page, "Trials") == ["1", "6"]
    assert tile(page, "Answers missing")[0] == "25.0 %"
    assert tile(page, "Certified") == ["0 %", "100 %"]
    assert "0 of 1 trials" in page
    reasons = re.findall(r'<td class="mono">([\w-]+)</td><td>([^<]*)</td>', page)
    assert reasons == [
        ("frames-missing", "not every frame is known to have been presented"),
        ("frames-dropped", "the browser dropped frames"),
    ]
    assert tile(page, "Dropped frames") == ["1", "0"]
    assert 'class="simulated">SIMULATED' in page


def test_trials_whose_frames_nobody_could_count_are_told_apart(ada: Any, guest: Any) -> None:
    guest.walk_to_trial()
    guest.watch()
    guest.finish()
    guest.watch(counted_by="callbacks", presented_frames=10)  # as Firefox on a slow computer
    guest.finish()
    page = ada.get("/researcher").text
    assert tile(page, "Certified")[0] == "–"
    assert "0 of 0 trials, of 1 unknown" in page


def test_people_are_listed_with_their_place_and_label(site: Any, ada: Any, guest: Any) -> None:
    simulate(site.db, site.study.definition, participants=1, seed=1)
    guest.walk_to_trial()
    guest.watch()
    guest.finish()
    page = ada.get("/researcher/people").text
    assert page.count('class="simulated"') == 1
    assert "clip 1 of 2" in page
    assert "completed" in page


def test_who_ended_early_is_told_apart_from_who_is_at_work(ada: Any, guest: Any) -> None:
    guest.walk_to_trial()
    guest.get("/stop")
    guest.post("/stop", choice="keep")
    assert "<td>ended early</td>" in ada.get("/researcher/people").text
    page = ada.get("/researcher").text
    assert (tile(page, "At work now"), tile(page, "Ended early")) == (["0"], ["1"])


@pytest.mark.parametrize("are_clips_ready", [False])
def test_a_failed_clip_shows_its_error_and_can_be_tried_again(site: Any, ada: Any) -> None:
    for _ in range(jobs.MAX_ATTEMPTS):
        job = jobs.claim(site.db, worker="w")
        assert job is not None
        jobs.fail(site.db, job, worker="w", error="Traceback\nRuntimeError: GL went <away>")
    assert job is not None
    page = ada.get("/researcher").text
    assert "1 clip could not be rendered." in page
    assert "RuntimeError: GL went &lt;away&gt;" in page
    assert "RuntimeError" in ada.get(f"/researcher/clips/{job.clip_id}").text
    ada.get("/researcher")
    ada.post(f"/researcher/jobs/{job.clip_id}/again")
    found = jobs.by_clip(site.db, job.clip_id)
    assert found is not None
    assert found.state == jobs.QUEUED


def test_every_clip_can_be_looked_at_with_what_is_known_of_it(ada: Any) -> None:
    page = ada.get("/researcher/clips").text
    assert page.count("<video") == 3
    link = re.findall(r'href="(/researcher/clips/[0-9a-f]+)"', page)[0]
    clip = ada.get(link).text
    assert "58.0 to 58.5 px, median 58.2" in clip
    assert "41.0 dB, 42.0 dB" in clip
    assert "<td>texture</td><td>low</td><td><strong>ultra</strong></td>" in clip
    assert ada.get("/researcher/clips/0000").status_code == 404


def draw_results(db: Any) -> None:
    """Do what a worker has done in a process of its own."""
    while figures.claim(db, worker="worker") is not None:
        assert draw_claimed(db, worker="worker")


def test_results_are_hidden_until_asked_for_and_the_asking_is_recorded(site: Any, ada: Any) -> None:
    simulate(site.db, site.study.definition, participants=2, seed=1)
    page = ada.get("/researcher/results").text
    assert "The results are hidden" in page
    assert "Answer so far" not in page
    assert figures.due(site.db) == []  # and nobody computes what nobody may see
    figure = "/researcher/results/simulated/realism-matrix.svg"
    assert ada.client.get(figure).status_code == 403
    assert "Please tick the sentence first." in ada.post("/researcher/results", show="yes").text
    page = ada.post("/researcher/results", show="yes", sure="yes").text
    assert "No participant has answered yet" in page
    assert "showed the results" in page
    draw_results(site.db)
    page = ada.get("/researcher/results?data=simulated").text
    assert "Answer so far" in page
    assert "SIMULATED</span> These answers come from simulated observers" in page
    drawn = ada.client.get(figure)
    assert drawn.headers["content-type"] == "image/svg+xml"
    assert drawn.text.count("<svg") == 1
    for name in ("nothing.svg", "realism-matrix.py", "realism-matrix"):
        assert ada.client.get(f"/researcher/results/simulated/{name}").status_code == 404
    ada.post("/researcher/results", show="no")
    assert "The results are hidden" in ada.page.text
    assert ada.client.get(figure).status_code == 403
    kinds = [entry.kind for entry in logbook.logged(site.db, site.study)]
    assert kinds == ["results-hidden", "results-shown"]


def test_the_figures_are_the_reports_own_and_stamped(site: Any, ada: Any) -> None:
    simulate(site.db, site.study.definition, participants=2, seed=1)
    ada.get("/researcher/results")
    ada.post("/researcher/results", show="yes", sure="yes")
    page = ada.get("/researcher/results?data=simulated").text
    assert "The figures wait for a worker" in page
    assert "<code>ocularist figures</code>" in page
    figures.claim(site.db, worker="worker")
    page = ada.get("/researcher/results?data=simulated").text
    assert "The figures are being drawn for the first time." in page
    draw_claimed(site.db, worker="worker")
    page = ada.get("/researcher/results?data=simulated").text
    found = figures_shown.latest(site.db, site.study.id, "simulated")
    assert f"As of {found.as_of:%Y-%m-%d %H:%M:%S} UTC" in page
    assert "No answer has come since." in page
    names = re.findall(r'<figure id="([a-z-]+)">', page)
    assert names == [chart["name"] for chart in found.summary["charts"]]
    assert names[0] == "decision-chart"
    report = ada.client.get("/researcher/results/simulated/report.html")
    assert report.headers["content-disposition"].startswith("attachment; filename=")
    for name in ("decision.csv", "lod_policy.json"):  # for an engine to load
        assert f'<a href="/researcher/results/simulated/{name}" download>' in page
    policy = ada.client.get("/researcher/results/simulated/lod_policy.json")
    assert policy.headers["content-type"] == "application/json"
    assert policy.json()["provenance"]["simulated"] is True
    for name in names:
        base = f"/researcher/results/simulated/{name}"
        image = base64.b64encode(ada.client.get(f"{base}.svg").content).decode()
        assert image in report.text, name
        numbers = ada.client.get(f"{base}.csv")
        assert numbers.headers["content-type"] == "text/csv; charset=utf-8"
        assert "simulated" in numbers.text.partition("\n")[0]


def test_newer_answers_and_failures_are_told(site: Any, ada: Any) -> None:
    simulate(site.db, site.study.definition, participants=1, seed=1)
    ada.get("/researcher/results")
    ada.post("/researcher/results", show="yes", sure="yes")
    own = figures.claim(site.db, worker="worker")
    figures.fail(site.db, own, worker="worker", error="OSError: <no> room on the disk")
    page = ada.get("/researcher/results?data=simulated").text
    assert "The figures could not be drawn" in page
    assert "OSError: &lt;no&gt; room on the disk" in page
    own = replace(own, seen="")  # as if drawn from answers before these
    with site.db.writing() as session:
        row = session.get(FigureSetRow, own.id)
        row.claimed_by = "worker"
    summary = {"people": 1, "ratings": 2, "verdicts": [], "findings": [["near", "nothing."]]}
    summary |= {"limits": [], "design": [], "quality": [], "charts": []}
    figures.store(site.db, own, worker="worker", summary=summary, files={})
    page = ada.get("/researcher/results?data=simulated").text
    assert "Newer answers have come; figures of them follow, at most once a minute." in page
    assert "<strong>near</strong>: nothing." in page
    assert "could not be drawn" not in page


def test_the_site_loads_no_statistics_and_no_plotting_library() -> None:
    code = (
        "import sys, study.site.app; "
        "bad = ('matplotlib', 'scipy', 'analysis.inference', 'analysis.charts', "
        "'analysis.report.publish')"
        "; print([name for name in bad if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_another_researcher_still_sees_nothing(site: Any, ada: Any) -> None:
    ada.get("/researcher/results")
    ada.post("/researcher/results", show="yes", sure="yes")
    researchers.add(site.db, "grace", "another long password")
    grace = site.guest()
    grace.sign_in("grace", "another long password")
    page = grace.get("/researcher/results").text
    assert "The results are hidden" in page
    assert "<td>ada</td><td>showed the results</td>" in page
    grace.client.close()


def test_the_tables_can_be_taken_away_one_by_one_and_together(site: Any, ada: Any) -> None:
    simulate(site.db, site.study.definition, participants=2, seed=1)
    assert "2 of the participants in these tables are simulated" in ada.get("/researcher/data").text
    answer = ada.client.get("/researcher/data/ratings.csv")
    assert answer.headers["content-disposition"] == 'attachment; filename="small-2-ratings.csv"'
    ratings = pd.read_csv(io.StringIO(answer.text))
    assert len(ratings) == 2 * 3 * 2
    assert ratings["simulated"].all()
    archive = zipfile.ZipFile(io.BytesIO(ada.client.get("/researcher/data/all.zip").content))
    assert sorted(archive.namelist()) == [
        "codebook.json",
        "comparisons.csv",
        "participants.csv",
        "ratings.csv",
        "study.json",
    ]
    assert json.loads(archive.read("study.json"))["key"] == "small"
    assert archive.read("ratings.csv").decode() == answer.text
    assert ada.client.get("/researcher/data/secrets.csv").status_code == 404
    assert [e.payload["file"] for e in logbook.logged(site.db, site.study)] == [
        "all.zip",
        "ratings.csv",
    ]
