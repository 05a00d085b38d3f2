"""Samples that a receiver took and that never arrived, while it goes on."""

from __future__ import annotations

from dataclasses import dataclass

from backend.craft import inputs
from backend.reasons import Reason
from hardware.ports import LOST_PERCENT
from hardware.reasons.receiver import SamplesLost

ALARMING_PERCENT = 5.0
"""A loss above this raises an alert in flight, which stays until the loss is down to LOST_PERCENT."""
CALM_S = 10.0
"""And has been for so long: a receiver that is opened again, for other channels say, counts from nothing."""


@dataclass(slots=True)
class LossWatch:
    """Of one craft's receiver."""

    _losing: bool = False
    _calm_since_s: float | None = None

    def look(self, lost_percent: float, trouble: Reason | None, now_s: float) -> list[inputs.CraftInput]:
        """One input when it begins to lose samples, and one when it stops. None while the receiver is in trouble: the
        trouble has an alert of its own, and a loss that goes on afterwards is reported again."""
        if trouble is not None:
            self._losing, self._calm_since_s = False, None
            return []
        if not self._losing:
            self._losing = lost_percent > ALARMING_PERCENT
            return [inputs.ReceiverLoses(SamplesLost(lost_percent))] if self._losing else []
        if lost_percent > LOST_PERCENT:
            self._calm_since_s = None
            return []
        self._calm_since_s = now_s if self._calm_since_s is None else self._calm_since_s
        if now_s - self._calm_since_s < CALM_S:
            return []
        self._losing, self._calm_since_s = False, None
        return [inputs.ReceiverKeepsUp()]
