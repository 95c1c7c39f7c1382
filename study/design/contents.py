"""What a study file may say: its tables and keys, as one model whose values are checked one by one.

Pure. ``study.design.definition`` reads files and checks what lies between the values,
``study.design.model`` says what follows from them.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field

from study.design.approach import Approach, PolicyData
from study.design.attention import Attention
from study.design.calibration import Calibration
from study.design.certificate import Certificate
from study.design.completion import Completion
from study.design.decision import DecisionRule
from study.design.device_check import DeviceCheck
from study.design.eyesight import Eyesight
from study.design.gold import Gold
from study.design.irises import Iris
from study.design.order import Order
from study.design.pairings import CatchClip, Clip, Factors, LodRow
from study.design.parts import (
    Distance,
    Eye,
    Name,
    Orbit,
    Part,
    Scene,
    SizeText,
    Text,
    clip_value,
)
from study.design.pauses import Breaks
from study.design.per_person import PerPerson
from study.design.questions import Question
from study.design.recruiting import Recruiting
from study.design.texts import Consent, Contact, Page, Thanks


class Contents(Part):
    """Everything that makes one study: what is shown, to whom, in which order, with which words."""

    key: Name
    version: Name
    title: Text
    language: Name = "en"
    translations: Annotated[dict[Name, dict[str, Any]], Field(default_factory=dict)]
    contact: Contact
    preset: Annotated[str, clip_value("preset")] = "thesis"
    sizes: Annotated[tuple[SizeText, ...], Field(min_length=1)]
    distances: Annotated[tuple[Distance, ...], Field(min_length=1)]
    orbit: Orbit = Orbit()
    approach: Approach = Approach()
    lod_policy: PolicyData | None = None
    eye: Eye = Eye()
    irises: dict[Name, Iris] = Field(default_factory=dict)
    scene: Scene = Scene()
    lods: Annotated[dict[Name, LodRow], Field(min_length=1)]
    practice: tuple[Clip, ...] = ()
    clips: tuple[Clip, ...] = ()
    factors: tuple[Factors, ...] = ()
    catch: tuple[CatchClip, ...] = ()
    gold: tuple[Gold, ...] = ()
    per_person: PerPerson | None = None
    order: Order = Order()
    breaks: Breaks | None = None
    attention: tuple[Attention, ...] = ()
    certificate: Certificate = Certificate()
    decision: DecisionRule | None = None
    consent: Consent
    about: tuple[Question, ...] = ()
    about_page: Page
    device_check: DeviceCheck | None = None
    calibration: Calibration | None = None
    eyesight: Eyesight | None = None
    instructions: Page
    questions: Annotated[tuple[Question, ...], Field(min_length=1)]
    thanks: Thanks
    completion: Completion | None = None
    recruiting: Recruiting | None = None
