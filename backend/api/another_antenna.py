"""The stored sweeps of a flown mission, heard through another antenna: another pattern, or another mounting."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from backend.api.services import Services
from backend.events import BearingMeasured, MissionDrafted, MissionEdited, Recorded, SweepRejected
from backend.mission.antenna import antenna_flown
from backend.mission.errors import MissionConflict, MissionInputError
from backend.mission.measuring import sweep_fact
from backend.spec import MissionSpec
from backend.store.entries import SweepEntry
from backend.wire.resources import PatternUpload, SweepFact, WhatIfAntenna, WhatIfRequest
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.pattern_file import PatternError, parse_pattern
from hardware.ports import DirectionFinder

A_PATTERN = "take a file that `crossfix calibrate` wrote, or a turntable table of angle_deg, gain_db that ends in .csv"
NO_SAMPLES_NEEDED = "ask with another bearing error, share of wrong bearings or planner: these need no samples"


@dataclass(frozen=True, slots=True)
class AnotherAntenna:
    """sweeps: the stored ones by their id."""

    finder: DirectionFinder
    pattern: AntennaPattern
    sweeps: Mapping[str, SweepEntry]

    @property
    def named(self) -> WhatIfAntenna:
        return WhatIfAntenna(name=self.pattern.name, offset_to_nose_deg=self.pattern.offset_to_nose_deg)

    def heard(self, mission: MissionSpec, flown: SweepFact) -> SweepFact:
        """What the sweep would have told. Raises MissionConflict when a bearing's samples were not stored."""
        entry = self.sweeps.get(flown.sweep_id)
        if entry is None and flown.kind == "sweep_rejected":
            return flown  # of power that could not be made into a sweep
        if entry is None:
            detail = f"the power samples of place {flown.place_number} were not stored, no other antenna can hear them"
            raise MissionConflict(detail, NO_SAMPLES_NEEDED)
        sweep = entry.sweep()
        reading = self.finder.estimate(sweep, self.pattern)
        told = sweep_fact(mission, flown.sweep_id, sweep, reading, flown.place_number, entry.attempt, None)
        if isinstance(told, BearingMeasured) and isinstance(flown, BearingMeasured):
            return told.model_copy(update={"bearing_id": flown.bearing_id})
        return told


async def another_antenna(
    services: Services, mission_id: str, recorded: Sequence[Recorded], wanted: WhatIfRequest
) -> AnotherAntenna | None:
    """None when the antenna is to stay as flown. Another mounting alone: of the antenna that flew.

    Raises MissionInputError for a pattern that cannot be used.
    """
    if wanted.pattern is None and wanted.offset_to_nose_deg is None:
        return None
    if wanted.pattern is None:
        pattern = antenna_flown(recorded) or services.pattern
    else:
        pattern = _pattern(wanted.pattern, _frequency_hz(recorded))
    if wanted.offset_to_nose_deg is not None:
        pattern = replace(pattern, offset_to_nose_deg=wanted.offset_to_nose_deg)
    ids = [r.event.sweep_id for r in recorded if isinstance(r.event, BearingMeasured | SweepRejected)]
    stored = {sweep_id: await services.journal.sweep(mission_id, sweep_id) for sweep_id in ids}
    return AnotherAntenna(services.finder, pattern, {id_: entry for id_, entry in stored.items() if entry is not None})


def _pattern(upload: PatternUpload, frequency_hz: float) -> AntennaPattern:
    try:
        pattern = parse_pattern(upload.filename, upload.text)
    except PatternError as error:
        raise MissionInputError(str(error), A_PATTERN, "pattern") from error
    elsewhere = pattern.other_frequency(frequency_hz)
    if elsewhere:
        raise MissionInputError(elsewhere, "take a pattern that was measured at the emitter's frequency", "pattern")
    return pattern


def _frequency_hz(recorded: Sequence[Recorded]) -> float:
    specs = [r.event.spec for r in recorded if isinstance(r.event, MissionDrafted | MissionEdited)]
    return specs[-1].emitter.frequency_hz
