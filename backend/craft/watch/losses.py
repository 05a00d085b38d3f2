"""Samples that a receiver took and that never arrived, while it goes on."""

from __future__ import annotations

from dataclasses import dataclass

from backend.craft import inputs
from backend.reasons import Reason
from hardware.ports import LOST_PERCENT
from hardware.reasons.receiver import SamplesLost

ALARMING_PERCENT = 5.0
"""A loss above this raises an alert in flight, which stays until the loss is down to LOST_PERCENT."""


@dataclass(slots=True)
class LossWatch:
    """Of one craft's receiver."""

    _losing: bool = False

    def look(self, lost_percent: float, trouble: Reason | None) -> list[inputs.CraftInput]:
        """One input when it begins to lose samples, and one when it stops. None while the receiver is in trouble: the
        trouble has an alert of its own, and a loss that goes on afterwards is reported anew."""
        if trouble is not None:
            self._losing = False
            return []
        losing = lost_percent > (LOST_PERCENT if self._losing else ALARMING_PERCENT)
        if losing == self._losing:
            return []
        self._losing = losing
        return [inputs.ReceiverLoses(SamplesLost(lost_percent)) if losing else inputs.ReceiverKeepsUp()]
