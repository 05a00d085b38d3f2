"""What a mission's stored sweeps say of the antenna that took them. Nothing is recorded, and nothing flies by it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from backend.events import BearingMeasured, BeliefUpdated, MissionDrafted, MissionEdited, Recorded
from backend.reasons import Reason
from backend.search.antenna import antenna_flown, antennas, corrected, correction_flown, same_pattern
from backend.search.counted import counted
from backend.search.machine import bearings_corrected, turned
from backend.wire.resources import AntennaReview, PatternUpload
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.pattern_file import pattern_json
from hardware.direction_finding.residuals import KeptSweep, refined_pattern, repeating
from hardware.readings import Place
from hardware.reasons.antenna import NotTheMeasuredAntenna

PROPOSED_FILENAME = "refined_in_flight.json"


def antenna_review(recorded: Sequence[Recorded], emitter_id: str | None, ours: AntennaPattern) -> AntennaReview | None:
    """None when the mission has no such emitter. Of the antenna that was flown or imported with last: what others took
    says nothing of it. ours: the pattern of missions that kept none.

    recorded: the what-if's kinds, in order. Heavy (some tenths of a second): call it off the event loop.
    """
    chosen = _emitter(recorded, emitter_id)
    if chosen is None:
        return None
    known = antennas(recorded)
    pattern = antenna_flown(recorded) or ours
    in_file = corrected(pattern, -correction_flown(recorded))
    heard = [fact for fact in _counted(recorded, chosen) if fact.source.kind != "person" and fact.binned_db]
    kept = [_kept(fact) for fact in heard if same_pattern(known.get(fact.source, pattern), pattern)]
    found = repeating(kept, pattern)
    belief = _last_belief(recorded, chosen)
    doubt: Reason | None = None if belief is None else _turned_together(belief)
    if found is not None and found.significant:
        doubt = NotTheMeasuredAntenna(pattern.name, max(found.repeats_db, found.uneven_db), found.sweeps)
    place = None if belief is None else _localized_at(belief)
    refined = None if place is None or doubt is None else refined_pattern(kept, place, in_file)
    return AntennaReview(
        sweeps=len(kept),
        repeats_db=None if found is None else found.repeats_db,
        doubt=doubt,
        proposed=None if refined is None else PatternUpload(text=pattern_json(refined), filename=PROPOSED_FILENAME),
    )


def _emitter(recorded: Sequence[Recorded], emitter_id: str | None) -> str | None:
    drafts = [r.event.spec for r in recorded if isinstance(r.event, MissionDrafted | MissionEdited)]
    known = [emitter.emitter_id for emitter in drafts[-1].emitters] if drafts else []
    if emitter_id is None:
        return known[0] if known else None
    return emitter_id if emitter_id in known else None


def _counted(recorded: Sequence[Recorded], emitter_id: str) -> list[BearingMeasured]:
    return [fact for fact in counted(r.event for r in recorded) if fact.emitter_id == emitter_id]


def _kept(fact: BearingMeasured) -> KeptSweep:
    binned = np.array([math.nan if value is None else value for value in fact.binned_db])
    fitted = [value for value in fact.fitted_db if value is not None]
    noise = max(fitted) - fact.snr_db if fitted and fact.snr_db is not None else None
    return KeptSweep(fact.place, fact.bearing_deg, binned, noise)


def _last_belief(recorded: Sequence[Recorded], emitter_id: str) -> BeliefUpdated | None:
    beliefs = [r.event for r in recorded if isinstance(r.event, BeliefUpdated) and r.event.emitter_id == emitter_id]
    return beliefs[-1] if beliefs else None


def _localized_at(belief: BeliefUpdated) -> Place | None:
    """Where the belief has the emitter, when it claims that."""
    if not belief.localized or belief.estimate is None:
        return None
    return Place(belief.estimate.lat, belief.estimate.lon)


def _turned_together(belief: BeliefUpdated) -> Reason | None:
    """An antenna that points beside deviates from its pattern nowhere: what it is off by stands in the belief alone."""
    own = (one for one in belief.sources if one.source.kind != "person")
    return next((bearings_corrected(one) for one in own if turned(one)), None)
