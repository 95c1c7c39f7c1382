"""The code book of what people write: which words, in English and Arabic, mention what.

A code says what was mentioned, not whether it was there: "no reflection" mentions reflection.
Patterns are regular expressions on text in lower case; Arabic ones are written without marks, with
plain alef, and stand for any word that contains them, whatever is joined to it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import Final

_MARKS: Final = re.compile("[\u064b-\u0652\u0670\u0640]")  # short vowels, dagger alef, tatweel
_PLAIN: Final = str.maketrans("أإآىة", "اااية")


@dataclass(frozen=True)
class Code:
    """One thing that people mention, and the words that do."""

    name: str
    meaning: str
    english: str
    arabic: str

    @cached_property
    def pattern(self) -> re.Pattern[str]:
        """The words of both languages; English ones start at a word's start."""
        return re.compile(rf"\b(?:{self.english})|(?:{plain(self.arabic)})")

    def is_in(self, text: str) -> bool:
        """Say whether a text mentions it."""
        return self.pattern.search(plain(text)) is not None


def plain(text: str) -> str:
    """Fold case, drop Arabic marks and unite the letters that people write in different ways."""
    return _MARKS.sub("", text.casefold()).translate(_PLAIN)


_MOVING: Final = r"mov(?:e|es|ing)\b|walking|waving|animated|dynamic"
_MIRRORED: Final = r"reflect\w*|mirror\w*"

CODES: Final = (
    Code(
        "reflection",
        "reflections and highlights",
        r"reflect|mirror|highlight|specular|shin[ey]|glint|gloss|glisten|glare|sparkl|wet\b|dry\b",
        r"انعكاس|تعكس|يعكس|عاكس|لمعان|لامع|يلمع|تلمع|لمعة|بريق|براق",
    ),
    Code(
        "dynamic reflection",
        "something that moves in the reflection",
        rf"(?:{_MIRRORED}).{{0,40}}\b(?:{_MOVING})|(?:{_MOVING}).{{0,40}}\b(?:{_MIRRORED})"
        r"|(?:see|people|person|someone|character).{0,15}\bmov(?:e|es|ing)\b",
        r"انعكاس.{0,40}(?:يتحرك|تتحرك|متحرك)|(?:يتحرك|تتحرك|متحرك).{0,40}انعكاس"
        r"|(?:اشخاص|ناس).{0,20}(?:يتحرك|تتحرك)",
    ),
    Code(
        "refraction",
        "the pupil's size, depth, the cornea's bulge",
        r"refract|pupil|depth|deep(?:er)?\b|bulg|cornea|lens|magnif|concave|convex|3[- ]?d\b",
        r"انكسار|بؤبؤ|حدقة|عمق|اعمق|قرنية|عدسة|مجسم|ثلاثي",
    ),
    Code(
        "caustics",
        "light gathered on the iris",
        r"caustic|light (?:pattern|pool|patch|spot)|(?:pattern|pool|patch|spot)s? of light"
        r"|(?:glow|lit|lighter|brighter).{0,12}\biris",
        r"تجمع الضوء|بقعة ضوء|بقع ضوء|بقع الضوء|كاوستيك|توهج",
    ),
    Code(
        "sclera",
        "the white of the eye and its veins",
        r"scler|whites?\b(?! noise)|vein|blood|capillar|bump",
        r"بياض|صلبة|عروق|اوردة|شرايين|وريد",
    ),
    Code(
        "texture",
        "sharpness and detail of the iris's picture",
        r"textur|blur|fuzz|sharp|crisp|pixel|resolution|detail|grain|smudg|soft(?:er)?\b",
        r"ملمس|نسيج|ضبابي|مشوش|مموه|\b(?:ال)?حادة?\b|\b(?:ال|ب)?دقة\b|تفاصيل|تفصيل|بكسل"
        r"|(?:غير|ليست?|اقل|اكثر) واضح|وضوح",
    ),
    Code(
        "tessellation",
        "the mesh: edges, corners, polygons",
        r"tess?ell?at|polygon|mesh|facet|angular|jagg|edges?\b|corners?\b|blocky|low[- ]?poly"
        r"|not (?:perfectly )?round",
        r"مضلع|شبكة|زوايا|مسنن|حواف|حافة|تكتل",
    ),
    Code(
        "subsurface",
        "light within the iris; fibres and folds",
        r"subsurface|sub-surface|scatter|translucen|fibre|fiber|folds?\b|layers?\b",
        r"تشتت|تحت السطح|الياف|طيات|طبقات",
    ),
    Code(
        "see-through",
        "looks transparent",
        r"see[- ]?through|seethrough|transparent|glass(?:y)?\b|hollow|ghost",
        r"شفاف|زجاج|مجوف",
    ),
    Code(
        "colour",
        "colour and brightness",
        r"colou?r|hue|tint|dark|bright|pale|saturat|light(?:er)\b|brown|blue|green|grey|gray",
        r"\b[وف]?(?:ال|بال|لل|ب|ل)?لون|الوان|اغمق|افتح|داكن|غامق|فاتح|سطوع|باهت",
    ),
    Code(
        "flatness",
        "looks flat, dull or artificial",
        r"flat\b|flatter|dull|dead|lifeless|fake|plastic|artificial|cartoon|painted",
        r"مسطح|\b(?:ال)?ميتة?\b|مزيف|بلاستيك|صناعي|اصطناعي|كرتون|مرسوم",
    ),
    Code(
        "the pair",
        "being asked to compare two different eyes",
        r"(?:strange|odd|weird|off-?putting|distract|confus|hard|difficult).{0,30}\b(?:compar|two)"
        r"|compar.{0,40}\b(?:strange|odd|weird|off-?putting|distract|confus|hard|difficult)",
        r"(?:غريب|صعب|مربك|مشتت).{0,30}(?:مقارن|قارن|عينين)|مقارن.{0,40}(?:غريب|صعب|مربك)",
    ),
)
CODE_NAMES: Final = tuple(code.name for code in CODES)


def codes_in(text: str) -> tuple[str, ...]:
    """Return the names of the codes that a text mentions, in the book's order."""
    return tuple(code.name for code in CODES if code.is_in(text))
