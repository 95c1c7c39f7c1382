"""The methods paragraph: what was computed, by which formula, with which versions."""

from __future__ import annotations

import hashlib
import platform
from importlib.metadata import version

import pandas as pd

from analysis.costs.cost import Costs
from analysis.descriptive.means import answered
from analysis.inference.deciding import SEED
from analysis.tables.reading import Tables
from analysis.words.versions import own_version

_PACKAGES = ("numpy", "scipy", "pandas", "matplotlib")


def methods(tables: Tables, costs: Costs | None = None) -> list[str]:
    """Return the paragraphs of the methods section."""
    paragraphs = [
        _questions(tables),
        "Means are over people: repeated ratings of the same thing by one person were averaged "
        "first. Intervals of means and of differences within people are Student's t, "
        "m ± t(n−1; .975) s / √n; they are not given for fewer than two people or for values that "
        "are all alike. Differences compare, within people, the highest LoD shown at a distance "
        "with each other LoD there. Shares carry Wilson's score interval; where one person saw a "
        "pair in several clips each answer counts.",
        "Perceived and actual LoD were related by Kendall's τ-b within each person and distance, "
        "averaged as Fisher's z with weights equal to the person's untied pairs, with a t interval "
        "over people; a perfect τ of m untied pairs counts as m / (m + 1). Beside it stand Somers' "
        "d of rating given LoD, in which equal ratings count as no preference and everyone "
        "counts, and the repeated-measures correlation (Bland and Altman 1995; one line per person "
        "and distance, r = sign(b) √(SSx / (SSx + SSe)), N − n − 1 degrees of freedom, interval by "
        "Fisher's z). Ratings at different distances were never ordered against each other.",
    ]
    paragraphs += [*_models(), *_observers()]
    if costs is not None:
        paragraphs.append(
            f"Costs are median times per finished frame for {costs.condition}, from bench.json."
        )
    paragraphs.append(f"{_versions()} The draws' seed is {SEED}. {_data(tables)}")
    return paragraphs


def _models() -> list[str]:
    return [
        "Verdicts rest on ordinal models. Ratings: a cumulative probit mixed model with a term for "
        "every LoD at every distance, the side, the orbit's direction and expertise where they "
        "vary, a contrast from the eye beside it where some eye had different partners, and each "
        "person's leniency; where people gave 30 ratings or more each, also their scatter and "
        "their avoidance of the scale's ends. People are integrated out on a fixed grid, refined "
        "until the log-likelihood no longer changes. Comparisons: Thurstone's model with a band of "
        "“no difference” and a side effect. Noticing: yes, not sure and no as grades of one "
        "detection, with pairs of equal LoDs as its zero. All are fitted with weak normal priors "
        "(maximum of the posterior). Intervals are quantiles of 4000 draws from Student's t about "
        "the fit, with one degree of freedom less than there are people.",
        "The ratings' model is checked by randomised quantile residuals (Dunn and Smyth 1996), by "
        "posterior-predictive shares of the scale's ends and by likelihood-ratio tests of "
        "proportional odds, and compared with others by AIC and by leaving people out. Groups of "
        "people are compared by Welch's t on one number per person, adjusted after Holm.",
    ]


def _observers() -> list[str]:
    return [
        "In the models a person counts for less than one where they were flagged (0.1) or where "
        "their inconsistency exceeds 1.5 times the median, v (then (1.5 v / v_i)²). Bias and "
        "inconsistency are those of ITU-T P.910 Annex E by alternating projection, with a floor of "
        "0.15 points; so that no small set of ratings fits by chance, four answers of the common "
        "scatter are added to each person's own, and their share in the estimated qualities is "
        "allowed for. ICC(2,1) and ICC(2,k) follow Shrout and Fleiss 1979 with McGraw and Wong's "
        "intervals; alpha takes Krippendorff's ordinal metric, with a jackknife over people and a "
        "bootstrap over stimuli. What people wrote was coded by words; a person counts once per "
        "pair of LoDs.",
    ]


def _questions(tables: Tables) -> str:
    low, high = tables.scale
    text = (
        f"Participants rated realism from {low} (completely unrealistic) to {high} (almost or "
        "completely photorealistic)."
    )
    if len(tables.comparisons):
        text += (
            " They rated the left and the right eye of each clip, said which of the two was more "
            "realistic, and whether they noticed anything missing or different. Left and right are "
            "the viewer's."
        )
    return (
        f"{text} Missing answers were left out, never replaced; practice trials were not analysed; "
        "nobody was excluded."
    )


def _versions() -> str:
    others = ", ".join(f"{name} {version(name)}" for name in _PACKAGES)
    python = platform.python_version()
    return f"Computed by Ocularist {own_version()} with Python {python}, {others}."


def _data(tables: Tables) -> str:
    rows = tables.ratings.to_csv(index=False) + tables.comparisons.to_csv(index=False)
    digest = hashlib.sha256(rows.encode()).hexdigest()[:16]
    rated = answered(tables.ratings)
    text = (
        f"Data: {len(rated)} ratings by {rated['participant'].nunique()} people; as read, the "
        f"tables' SHA-256 begins {digest}"
    )
    latest = tables.ratings["started_at"].max()
    return f"{text}; until {latest:%Y-%m-%d %H:%M} UTC." if pd.notna(latest) else f"{text}."
