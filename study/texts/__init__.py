"""What participants read: one file of texts per language, and how to say them.

``en.toml`` is the source. Knows languages, plurals and numbers; nothing of studies, pages or data.
"""

from study.texts.catalogue import Catalogue, catalogue, languages
from study.texts.languages import Tongue, first_spoken, tongue, wished_in_header

__all__ = [
    "Catalogue",
    "Tongue",
    "catalogue",
    "first_spoken",
    "languages",
    "tongue",
    "wished_in_header",
]
