"""Samples that a receiver took and that never arrived, while it goes on."""

from __future__ import annotations

from dataclasses import dataclass

from backend.craft import inputs
from backend.reasons import Reason
from hardware.ports import LOST_PERCENT
from hardware.reasons.receiver import SamplesLost

ALARMING_PERCENT = 5.0
"""From here on an operator is told in flight, until it is LOST_PERCENT or less."""


@dataclass(slots=True)
class LossWatch:
    """Of one craft's receiver."""

    _losing: bool = False

    def look(self, lost_percent: float, trouble: Reason | None) -> list[inputs.CraftInput]:
        """That it loses samples, and that it does so no longer, each once. Of one in trouble that alone is told; what
        it loses is told again after it."""
        if trouble is not None:
            self._losing = False
            return []
        losing = lost_percent > (LOST_PERCENT if self._losing else ALARMING_PERCENT)
        if losing == self._losing:
            return []
        self._losing = losing
        return [inputs.ReceiverLoses(SamplesLost(lost_percent)) if losing else inputs.ReceiverKeepsUp()]
