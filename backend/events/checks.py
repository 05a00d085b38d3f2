"""What was looked at before a start."""

from __future__ import annotations

from typing import Literal

from backend.events.fact import Fact
from backend.reasons import Reason
from backend.spec import Place
from hardware.readings import CheckName


class CheckFact(Fact):
    """One line of the checklist. blocking: refuses the start unless it is ok."""

    name: CheckName
    ok: bool
    reason: Reason
    blocking: bool


class PreflightChecked(Fact):
    """passed: nothing that blocks has failed."""

    kind: Literal["preflight_checked"] = "preflight_checked"
    passed: bool
    checks: list[CheckFact]


class AntennaChecked(Fact):
    """The antenna was turned before a known emitter. It stands in the checklist until the next one, or an edit."""

    kind: Literal["antenna_checked"] = "antenna_checked"
    check: CheckFact
    emitter: Place
    by: str
