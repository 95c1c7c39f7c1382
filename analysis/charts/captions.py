"""What the charts' captions say: what is drawn, what lines and symbols mean, by chart."""

from __future__ import annotations

from typing import Final

CAPTIONS: Final = {
    "decision-chart": (
        "Which LoD is enough at each distance. Percentage and shade: how likely it is, by what "
        "the answers leave open, that this LoD is the cheapest one that is enough there (a column "
        "adds up to 100 %). Word: the verdict by the margins: equivalent (shown to be enough), "
        "different (shown not to be), not shown (open: more people would tell); LoDs are tested "
        "from the highest down until one fails. Frame: the answer, the cheapest LoD that was "
        "shown to be enough. Milliseconds, where given, are per frame. Below: which verdicts hang "
        "on a single person."
    ),
    "contrasts": (
        "Each LoD against the highest one at its distance, in the order of testing. Left: "
        "loss of realism after the ordinal model. Right: share of people who notice the "
        "difference, beyond false alarms. Lines are 90 % intervals, so that each end is a "
        "one-sided 95 % bound; dashes are the margins. Equivalent: the whole line lies left "
        "of the margin on both sides; different: right of it on one. Not shown is neither."
    ),
    "latent-realism": (
        "Realism by the ordinal mixed model, with 95 % intervals: left on its latent scale, "
        "right as the mean rating of the population that follows. Grey dots and lines: plain "
        "means of ratings with t intervals. Where grey and coloured disagree, trust the model"
        " with care."
    ),
    "joint-scale": (
        "Ratings and comparisons fitted together: of a pair's two eyes the comparison says the "
        "same difference as the ratings, in units of its own (the axis on top). Coloured: both "
        "together; grey: the ratings alone; lines are 95 % intervals. Where both agree and the "
        "coloured interval is shorter, comparisons have told more than ratings alone. Drawn only "
        "where ratings and comparisons link everything that was shown."
    ),
    "realism-against-cost": (
        "Realism (mean rating of the population by the model) against what a frame costs, "
        "with 95 % intervals of both, one panel per distance. The line joins LoDs that no "
        "other dominates in most draws; grey ones are dominated: another looks as real or "
        "more and costs no more."
    ),
    "noticed-by-size": (
        "Share of people who notice a difference beside the best LoD. Red: false alarms, yes "
        "to equal LoDs. Over pixels of the clip and, where the study measured it, over "
        "degrees at the observer's eye (both axes logarithmic). Lines: the fitted law with "
        "its 95 % band; symbols: what was observed at about that size, with 95 % intervals; "
        "upright strokes: where the margin is reached, beside the names with 95 % intervals where "
        "there is room. Nothing is drawn beyond the sizes shown."
    ),
    "preferred-by-size": (
        "Share of people who call the best LoD more realistic than a lesser one. Over pixels "
        "of the clip and, where the study measured it, over degrees at the observer's eye "
        "(both axes logarithmic). Lines: the fitted law with its 95 % band; symbols: what was"
        " observed at about that size, with 95 % intervals; upright strokes: where the lesser "
        "LoD lies 1 JOD below the best, beside the names with 95 % intervals where there is room. "
        "Nothing is drawn beyond the sizes shown."
    ),
    "rated-by-size": (
        "How far below the best LoD a lesser one is rated. Over pixels of the clip and, where"
        " the study measured it, over degrees at the observer's eye (both axes logarithmic). "
        "Lines: the fitted law with its 95 % band; symbols: what was observed at about that "
        "size, with 95 % intervals; upright strokes: where the margin is reached, beside the "
        "names with 95 % intervals where there is room. Nothing is drawn beyond the sizes shown."
    ),
    "realism-per-clip": (
        "Perceived realism of each eye in each clip, grouped by viewing distance and coloured"
        " by level of detail (LoD). The scale runs from completely unrealistic to almost or "
        "completely photorealistic. Symbols are means over people, vertical lines 95 % t "
        "intervals. Dots are single people (in larger studies the area of a dot is their "
        "share), n is their number. Left and right are the viewer's. More than 24 clips are "
        "taken together by pairing of LoDs, left and right. (The thesis's Figure 5.2, with "
        "its uncertainty.)"
    ),
    "realism-matrix": (
        "What was shown: mean realism of each combination of LoD and distance, its 95 % "
        "t interval, and the number of people (n) and of ratings. Nothing is known about "
        "hatched combinations."
    ),
    "rating-distribution": (
        "How often each rating was given, by distance and LoD; bars are centred on the middle"
        " of the scale, n counts ratings."
    ),
    "perceived-against-actual": (
        "Perceived realism against the actual LoD at each distance. The scale runs from "
        "completely unrealistic to almost or completely photorealistic. Symbols are means "
        "over people, vertical lines 95 % t intervals. Grey lines are single people (where "
        "they are at most 100). τ is Kendall's tau-b within people, averaged on Fisher's z "
        "scale, with its 95 % interval; people whose ratings are all alike have none."
    ),
    "perceived-by-model": (
        "Perceived against actual LoD after the ordinal mixed model. Above: places on its latent "
        "scale with 95 % intervals, a line per distance; beside each line its slope per level of "
        "the LoD and Kendall's τ within people, both with 95 % intervals. A flat line says that "
        "people do not see what the LoD adds. Below: the share of each rating that the population "
        "would give, in per cent; black strokes are the shares that were given, added up from "
        "below."
    ),
    "realism-by-distance": (
        "Perceived realism by viewing distance for each LoD. The scale runs from completely "
        "unrealistic to almost or completely photorealistic. Symbols are means over people, "
        "vertical lines 95 % t intervals. Lines join neighbouring distances at which a LoD "
        "was shown."
    ),
    "comparisons-per-pair": (
        "Which LoD of a pair was called more realistic, whichever side it stood on. The share"
        " next to a name preferred it. Lines are 95 % Wilson intervals: above the bar for the"
        " LoD on the left, below it for the LoD on the right. Black strokes are where the "
        "preference scale expects the parts to meet. Side bias is what standing on the right adds."
    ),
    "preference": (
        "The LoDs on a scale of preference, with 95 % intervals: 1 JOD is 75 % preference "
        "where nobody may say “no difference”. Each scale starts at its highest LoD; no "
        "comparison links different scales, so they cannot be compared. Solid lines join LoDs"
        " whose difference is clear (its 95 % interval leaves 0 out), dashes those whose is "
        "not."
    ),
    "noticed-per-pair": (
        "Whether anything missing or different was noticed between the eyes, by pair of LoDs."
        " Lines are 95 % Wilson intervals of yes. For equal LoDs, yes is a false alarm."
    ),
    "detection": (
        "How well the difference of each pair is detected, with 95 % intervals: left the "
        "sensitivity d′ of yes, not sure and no against pairs of equal LoDs, right the share "
        "of people who say yes. Red: yes to equal LoDs, which is a false alarm, with its "
        "interval."
    ),
    "comparisons-per-clip": (
        "Which eye was called more realistic in each clip, as the viewer saw it. Lines are 95"
        " % Wilson intervals: above the bar for the left eye, below it for the right. Black "
        "strokes are where the preference scale expects the parts to meet, side bias included. "
        "More than 24 clips are taken together by pairing of LoDs, left and right."
    ),
    "noticed-per-clip": (
        "Whether anything missing or different was noticed between the eyes, clip by clip. "
        "Lines are 95 % Wilson intervals of yes. More than 24 clips are taken together by "
        "pairing of LoDs, left and right."
    ),
    "observers": (
        "Above: everyone's leniency and inconsistency by their own ratings (ITU-T P.910 Annex E); "
        "n counts people. Who is flagged, inconsistent, or answers as if without looking weighs "
        "less in the models; nobody was excluded. Below: leniency, and with 30 ratings per person "
        "or more inconsistency and style, by the model of ratings, with 95 % intervals. These "
        "estimates are shrunken: the less a person answered, the nearer they lie to the population."
    ),
    "ratings-per-person": (
        "What each person gave: a row per person, severe ones on top, a column per eye as it was "
        "shown. Of more than 40 such eyes those of one LoD at one distance are taken together "
        "(mean rating). Flagged people stand in red."
    ),
    "verdict-stability": (
        "Every verdict with everyone, with and without flagged people, and without each single "
        "person; of those without a flag only who moves a verdict has a row. A frame marks a "
        "verdict that differs from the first row's. The last row says without how many of all "
        "people, left out one at a time, the verdict stays. Verdicts on LoDs without a rank, such "
        "as single effects left out, are tried without each single person alone."
    ),
    "session-course": (
        "How ratings drift and how long answers take while a session lasts. Left: rating "
        "minus the mean of the same eye in the same clip, within people, with 95 % t "
        "intervals. Right: median over people. A flat line is what one hopes for; the first "
        "positions show warming up."
    ),
    "rating-spread": (
        "Variance between people against the mean rating, one symbol per eye and clip. The "
        "curve is a (m − lowest) (highest − m), fitted to all: the SOS hypothesis (Hoßfeld, "
        "Schatz and Egger 2011). Far above it are eyes that split people."
    ),
    "model-residuals": (
        "Randomised quantile residuals of all ratings (Dunn and Smyth 1996), in order, against "
        "those of a normal law; grey is where each of them lies in 95 % of normal samples. Right: "
        "the same, the expected taken away. On the line the model of ratings fits; orange "
        "diamonds lie outside the grey band, of which one in twenty may."
    ),
    "predicted-shares": (
        "How often the lowest and the highest rating were given (symbols), and in which range "
        "they would lie in 95 % of studies like this one drawn from the model (bars). Above: per "
        "LoD and distance, n counts ratings. Below: every person, in the order of their share. "
        "People who avoid the ends lie below their bars, and a few who like them above."
    ),
}
