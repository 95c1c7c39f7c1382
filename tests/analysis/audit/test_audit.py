"""The design audit: what was shown, what is linked, and what cannot be concluded."""

from analysis.audit import ShownClip, audit_design, shown_clips
from analysis.inference.inferring import infer
from analysis.report.limits import limits
from analysis.tables.reading import Tables, tables_from


def clips(*shown: tuple[str, str, str]) -> list[ShownClip]:
    return [ShownClip(str(i), *clip) for i, clip in enumerate(shown, start=1)]


def test_the_thesis_shows_nine_of_sixteen_combinations(thesis_tables: Tables) -> None:
    audit = audit_design(shown_clips(thesis_tables.ratings, thesis_tables.comparisons))
    assert audit.facts() == [
        "9 of 16 combinations of LoD and distance were shown.",
        "Shown with the eyes exchanged: clips 4 and 6.",
    ]
    assert audit.limits()[0].startswith(
        "Not shown: high at distance=near; any LoD at distance=medium; medium and high at "
        "distance=far. Nothing can be said about these"
    )
    assert any("No comparison links two distances" in text for text in audit.limits())
    assert any("No clip showed the same LoD in both eyes" in text for text in audit.limits())


def test_the_thesiss_comparisons_link_all_lods_within_each_distance(
    thesis_tables: Tables,
) -> None:
    audit = audit_design(shown_clips(thesis_tables.ratings, thesis_tables.comparisons))
    assert {distance: len(groups) for distance, groups in audit.linked.items()} == {
        "macroscopic": 1,
        "near": 1,
        "far": 1,
    }
    assert audit.sides["high"] == (2, 0)


def test_unlinked_lods_are_named() -> None:
    audit = audit_design(clips(("porch", "low", "medium"), ("porch", "high", "ultra")))
    assert audit.linked["porch"] == (("low", "medium"), ("high", "ultra"))
    assert (
        "At distance=porch, comparisons do not link all LoDs (low and medium; high and ultra): "
        "between these groups only the ratings tell." in audit.limits()
    )


def test_a_third_clip_can_link_two_groups() -> None:
    audit = audit_design(
        clips(("near", "low", "medium"), ("near", "high", "ultra"), ("near", "medium", "high"))
    )
    assert audit.linked["near"] == (("low", "medium", "high", "ultra"),)


def test_catch_clips_and_exchanged_eyes_lift_their_limits() -> None:
    audit = audit_design(
        clips(("near", "low", "ultra"), ("near", "ultra", "low"), ("near", "low", "low"))
    )
    assert audit.catch_clips == 1
    assert audit.mirrored == (("1", "2"),)
    assert not any(text.startswith(("No clip", "No pairing")) for text in audit.limits())


def test_a_pairing_with_several_irises_is_exchanged_once() -> None:
    both_ways = [("near", "low", "ultra"), ("near", "ultra", "low")]
    audit = audit_design(clips(*both_ways, *both_ways, *both_ways))
    assert audit.mirrored == (("1", "2"),)


def test_exchanged_eyes_at_another_distance_are_no_mirror() -> None:
    audit = audit_design(clips(("near", "low", "ultra"), ("far", "ultra", "low")))
    assert audit.mirrored == ()


def test_own_distances_do_not_miss_the_standard_ones() -> None:
    audit = audit_design(clips(("porch", "low", "ultra")))
    assert audit.distances == ("porch",)
    assert audit.facts()[0] == "2 of 2 combinations of LoD and distance were shown."


def test_nothing_shown_is_said() -> None:
    audit = audit_design([])
    assert audit.statements() == [
        "No pair of eyes was shown, so nothing is known about comparisons."
    ]


def test_pairings_are_found_from_ratings_alone(thesis_tables: Tables) -> None:
    from_both = shown_clips(thesis_tables.ratings, thesis_tables.comparisons)
    from_ratings = shown_clips(thesis_tables.ratings, thesis_tables.comparisons.iloc[:0])
    assert from_ratings == from_both
    assert [clip.clip for clip in from_ratings] == list("1234567")


def test_limits_tell_simulation_sample_and_side_by_side(thesis_tables: Tables) -> None:
    audit = audit_design(shown_clips(thesis_tables.ratings, thesis_tables.comparisons))
    text = limits(thesis_tables, audit, infer(thesis_tables))
    assert text[0].startswith("The answers come from simulated observers.")
    assert any("no proof that there is none" in sentence for sentence in text)


def test_limits_without_ratings_begin_with_that(thesis_frames: dict[str, object]) -> None:
    ratings = thesis_frames["ratings"]
    empty = tables_from({"ratings": ratings.head(0)})
    assert limits(empty, audit_design([]), infer(empty))[0] == (
        "There are no ratings yet, so nothing can be said about realism."
    )
    missing = tables_from({"ratings": ratings.assign(rating=None)})
    assert limits(missing, audit_design([]), infer(missing))[0] == (
        "All ratings are missing, so nothing can be said about realism."
    )
