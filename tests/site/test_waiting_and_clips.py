"""Waiting for clips, serving them, and what happens when one is missing."""

from __future__ import annotations

import hashlib
import re
from dataclasses import replace
from typing import Any

import pytest

from renderer.manifest import read_manifest, write_manifest
from study.data import events, jobs, trials
from study.data.quality import quality
from study.site.media import ClipShelf, public_name

STATE = "/preparing/state?screen_width_px=1920&screen_height_px=1080"


def first_clip(guest: Any) -> dict[str, Any]:
    found: dict[str, Any] = guest.client.get(STATE).json()["clips"][0]
    return found


@pytest.mark.parametrize("are_clips_ready", [False])
def test_someone_who_comes_too_early_waits_calmly_and_goes_on(
    site: Any, guest: Any, put_clips: Any
) -> None:
    assert "The clips are still being made" in guest.walk_to_preparing().text
    news = guest.client.get(STATE).json()
    assert news == {
        "fits": True,
        "is_ready": False,
        "progress": 0.0,
        "wait": "We cannot say yet how long it takes.",
        "clips": [],
    }
    guest.post("/preparing", screen_width_px="1920", screen_height_px="1080")
    assert guest.at == "/preparing"
    put_clips(site)
    assert guest.client.get(STATE).json()["is_ready"] is True
    guest.post("/preparing", screen_width_px="1920", screen_height_px="1080")
    assert guest.at == "/trial/1"


@pytest.mark.parametrize("are_clips_ready", [False])
def test_a_clip_that_fails_is_told_without_jargon(site: Any, guest: Any) -> None:
    guest.walk_to_preparing()
    for _ in range(jobs.MAX_ATTEMPTS):
        job = jobs.claim(site.db, worker="w")
        assert job is not None
        jobs.fail(site.db, job, worker="w", error="GL went away")
    assert guest.client.get(STATE).json()["wait"].endswith("Code: CLIPS-STUCK")


def test_a_screen_too_small_for_every_size_is_told(guest: Any) -> None:
    guest.walk_to_preparing()
    small = "/preparing/state?screen_width_px=300&screen_height_px=1080"
    assert guest.client.get(small).json()["fits"] is False


def test_screens_that_cannot_be_are_refused(guest: Any) -> None:
    guest.walk_to_preparing()
    answer = guest.client.get("/preparing/state?screen_width_px=-1&screen_height_px=x")
    assert answer.status_code == 422
    assert answer.json() == {"code": "NOT-READABLE"}


def test_clips_are_served_whole_and_by_ranges(guest: Any) -> None:
    guest.walk_to_preparing()
    clip = first_clip(guest)
    whole = guest.client.get(clip["url"])
    assert whole.status_code == 200
    assert len(whole.content) == clip["bytes"]
    assert whole.headers["content-type"] == "video/mp4"
    assert whole.headers["cache-control"] == "public, max-age=31536000, immutable"
    part = guest.client.get(clip["url"], headers={"Range": "bytes=0-1"})
    assert part.status_code == 206
    assert part.content == whole.content[:2]
    assert part.headers["content-range"] == f"bytes 0-1/{clip['bytes']}"
    resumed = {"Range": "bytes=2-3", "If-Range": whole.headers["etag"]}
    assert guest.client.get(clip["url"], headers=resumed).content == whole.content[2:4]
    assert (
        guest.client.get(clip["url"], headers={**resumed, "If-Range": '"old"'}).status_code == 200
    )


def test_a_clip_is_named_by_its_contents_and_tells_no_time(guest: Any) -> None:
    guest.walk_to_preparing()
    clips = guest.client.get(STATE).json()["clips"]
    answers = [guest.client.get(clip["url"]) for clip in clips]
    for clip, answer in zip(clips, answers, strict=True):
        name = hashlib.sha256(answer.content).hexdigest()
        assert clip["url"] == f"/clips/{name}.mp4"
        assert answer.headers["etag"] == f'"{name}"'
        # Neither the path on the disk nor the order in which files were written is to be seen.
        assert "content-disposition" not in answer.headers
    assert {answer.headers["last-modified"] for answer in answers} == {
        "Thu, 01 Jan 1970 00:00:00 GMT"
    }


def test_nothing_but_clips_is_served_as_a_clip(guest: Any) -> None:
    for name in ("unknown", "..%2Fmanifest", "manifest"):
        assert guest.client.get(f"/clips/{name}.mp4").status_code == 404
    assert guest.client.get("/clips/manifest.json").status_code == 404


def test_a_page_tells_nothing_of_the_condition(site: Any, guest: Any) -> None:
    words = re.compile(
        r"\b(ultra|low|macroscopic|lod|texture|refraction|caustics|tessellation|sclera|rightward)\b",
        re.IGNORECASE,
    )
    guest.walk_to_trial()
    for position in (1, 2, 3):
        assert guest.at == f"/trial/{position}"
        told = guest.page.text + str(guest.page.headers)
        clip = guest.client.get(guest.data("clip"))
        told += str(clip.headers) + clip.content.decode("latin-1")
        assert words.findall(told) == []
        clip_ids = [wanted.spec.clip_id for wanted in site.study.definition.wanted_specs()]
        assert not any(clip_id in told for clip_id in clip_ids)
        guest.watch()
        guest.finish()


def test_a_missing_clip_stops_visibly_and_the_dashboard_knows(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    for path in site.settings.media_folder.glob("*.mp4"):
        path.unlink()
    page = guest.get("/trial/1")
    assert page.status_code == 503
    assert "This clip is not ready" in page.text
    assert "Please wait a minute and try again." in page.text
    assert "CLIP-MISSING P-" in page.text
    [problem] = quality(site.db, site.study).real.problems
    assert (problem.code, problem.position) == ("CLIP-MISSING", 1)
    person = site.people()[0]
    clip = trials.all_trials(site.db, person)[0].clip_id
    job = jobs.by_clip(site.db, clip)
    assert job is not None
    assert job.state == jobs.QUEUED


def test_clips_that_were_lost_are_made_again(site: Any, guest: Any) -> None:
    guest.walk_to_preparing()
    for path in site.settings.media_folder.glob("*.mp4"):
        path.unlink()
    assert guest.client.get(STATE).json()["is_ready"] is False
    assert jobs.summary(site.db).queued == 3


def test_a_file_of_another_length_is_no_clip(site: Any) -> None:
    shelf = ClipShelf(site.settings.media_folder)
    clip_id = site.study.definition.wanted_specs()[0].spec.clip_id
    record = shelf.record(clip_id)
    assert record is not None
    (site.settings.media_folder / record.file).write_bytes(b"cut off")
    assert shelf.record(clip_id) is None


def test_a_master_is_never_served(site: Any, guest: Any) -> None:
    folder = site.settings.media_folder
    manifest = read_manifest(folder)
    record = next(iter(manifest.clips.values()))
    (folder / "a.master.mkv").write_bytes(b"lossless")
    sha256 = hashlib.sha256(b"lossless").hexdigest()
    manifest.add(replace(record, master={"file": "a.master.mkv", "sha256": sha256, "bytes": 8}))
    write_manifest(manifest, folder)
    guest.walk_to_preparing()
    shelf = ClipShelf(folder)
    assert shelf.file(public_name(record)) is not None
    for name in (sha256, "a.master", "a.master.mkv", f"{record.clip_id}.master"):
        assert shelf.file(name) is None
        for suffix in (".mp4", ".mkv", ""):
            assert guest.client.get(f"/clips/{name}{suffix}").status_code == 404


def test_a_play_that_was_interrupted_is_kept_and_does_not_unlock(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    guest.watch(is_complete=False, was_hidden=True)
    assert guest.finish(rating_left="2").status_code == 422
    [person] = site.people()
    plays = [e for e in events.history(site.db, person) if e.kind == "played"]
    assert [play.payload["was_hidden"] for play in plays] == [True]


def test_a_record_that_cannot_be_is_refused(guest: Any) -> None:
    guest.walk_to_trial()
    headers = {"X-CSRF-Token": guest.data("csrf"), "Content-Type": "application/json"}
    long = '"' + 301 * "x" + '"'
    for fact in ("1e999", "NaN", "-Infinity", "1" + 400 * "0", long, "[[0, 1e999]]", "[[1]]"):
        entry = '{"kind": "play", "key": "k", "position": 1, "play": {"gap": ' + fact + "}}"
        answer = guest.client.post("/events", content=entry, headers=headers)
        assert (answer.status_code, answer.json()) == (422, {"code": "NOT-READABLE"}), fact[:20]


def test_the_site_judges_a_play_by_its_own_knowledge_of_the_clip(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    told = guest.watch().json()
    assert told == {"ok": True, "new": True, "key": "play-1-1", "certified": True, "reasons": []}
    # A browser that tells of fewer frames, or plays another file, is not believed.
    told = guest.watch(key="few", expected_frames=5, presented_frames=5).json()
    assert (told["certified"], told["reasons"]) == (False, ["frames-missing"])
    told = guest.watch(key="other", clip_sha256="ab").json()
    assert told["reasons"] == ["other-clip"]
    again = guest.watch(key="other", clip_sha256="ab").json()
    assert (again["new"], again["key"]) == (False, "other-1")
    [person] = site.people()
    plays = [e.payload for e in events.history(site.db, person) if e.kind == "played"]
    assert [play["expected_frames"] for play in plays] == [15, 15, 15]
