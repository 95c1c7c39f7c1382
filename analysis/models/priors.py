"""Priors of the models' parameters, by kind, on the latent scale.

They keep what a small study cannot say finite: on 40 simulated studies of the thesis's size plain
maximum likelihood put a person effect's spread at zero in up to 55 %, with these in none.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from analysis.models.ordinal import INCONSISTENCY, LENIENCY, STYLE

Priors = Mapping[str, tuple[float, float]]
PRIORS: Final[Priors] = {
    "threshold": (-1.0, 3.0),
    "log_step": (0.0, 1.0),
    "location": (0.0, 4.0),
    "contrast": (0.0, 0.25),
    "scale": (0.0, 0.5),
    "nominal": (0.0, 0.5),
    "log_height": (float(np.log(1.5)), 1.0),
    "middle": (6.5, 2.0),  # log2 of 90 pixels, two doublings either way
    "log_width": (0.0, 0.5),
    f"log_sd:{LENIENCY}": (float(np.log(0.5)), 0.5),
    f"log_sd:{INCONSISTENCY}": (float(np.log(0.2)), 0.5),
    f"log_sd:{STYLE}": (float(np.log(0.2)), 0.5),
}
"""Normal priors (mean, sd) by kind of parameter, weak beside the noise of one rating, 1.

All cells are measured from the first one, most often the least real: at a sd of 2 they were drawn
to it together, the contrast made up for it, and of 10 people's intervals of the greatest loss of
realism only 80 % held the truth (docs/power.md).
"""

LOOSE: Final[Priors] = {
    **dict.fromkeys(PRIORS, (0.0, 10.0)),
    "threshold": (0.0, 100.0),
    "location": (0.0, 100.0),
    "log_step": (0.0, 20.0),
    "nominal": (0.0, 20.0),
    f"log_sd:{LENIENCY}": (float(np.log(0.5)), 10.0),
    f"log_sd:{INCONSISTENCY}": (float(np.log(0.2)), 10.0),
    f"log_sd:{STYLE}": (float(np.log(0.2)), 10.0),
}
"""So wide that they only keep from running away what answers leave without a bound: the greatest
likelihood to some thousandths, for log-likelihoods that models are compared by.
"""
