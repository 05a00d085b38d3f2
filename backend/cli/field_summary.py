"""What the missions of a row of the field world say together."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from backend.cli.field_missions import HOVER_W, LATE_S, OUTLIER_DEG, FieldMission, FieldOptions
from planner.shares import wilson


@dataclass(frozen=True, slots=True)
class FieldSummary:
    """Of all missions of a row; *_ci95: half the 95 % interval. seed: of the first. localized_in_time: within LATE_S.
    in_c95 and what follows: of those that claimed."""

    options: FieldOptions
    seed: int
    missions: int
    localized: float
    localized_in_time: float
    time_s: float
    time_ci95_s: float
    time_90_s: float
    in_c95: float
    in_c95_low: float
    in_c95_high: float
    false_claims: float
    bearings: float
    turned_deg: float
    energy_kj: float
    bearing_sd_deg: float
    outliers: int
    bearings_far: int

    def as_json(self) -> dict[str, Any]:
        """One flat object; None: no mission told."""
        fields = dataclasses.asdict(self)
        options = fields.pop("options")
        return {name: _rounded(value) for name, value in {**options, **fields}.items()}


def summary(options: FieldOptions, flown: Sequence[FieldMission]) -> FieldSummary:
    """Of at least one mission."""
    nothing = math.nan
    claims = [m for m in flown if m.localized]
    inside = sum(m.in_c95 for m in claims)
    low, high = wilson(inside, len(claims)) if claims else (nothing, nothing)
    times = np.array([m.time_s for m in flown])
    off = np.array([value for m in flown for value in m.off_deg])
    honest = off[np.abs(off) <= OUTLIER_DEG]
    return FieldSummary(
        options=options,
        seed=flown[0].seed,
        missions=len(flown),
        localized=len(claims) / len(flown),
        localized_in_time=sum(m.time_s <= LATE_S for m in claims) / len(flown),
        time_s=float(times.mean()),
        time_ci95_s=float(1.96 * times.std(ddof=1) / math.sqrt(len(times))) if len(times) > 1 else nothing,
        time_90_s=float(np.quantile(times, 0.9)),
        in_c95=inside / len(claims) if claims else nothing,
        in_c95_low=low,
        in_c95_high=high,
        false_claims=float(np.mean([m.false_claim for m in claims])) if claims else nothing,
        bearings=float(np.mean([m.bearings for m in flown])),
        turned_deg=float(np.mean([m.turned_deg for m in flown])),
        energy_kj=float(HOVER_W * times.mean() / 1e3),
        bearing_sd_deg=float(honest.std()) if len(honest) else nothing,
        outliers=int((np.abs(off) > OUTLIER_DEG).sum()),
        bearings_far=len(off),
    )


def _rounded(value: Any) -> Any:
    if not isinstance(value, float):
        return value
    return round(value, 4) if math.isfinite(value) else None
