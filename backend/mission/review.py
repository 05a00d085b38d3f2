"""After the flight: the ground truth of an emitter, a mission's labels, its deletion. Facts like all others."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from backend.events import (
    Event,
    MissionDeleted,
    MissionEnded,
    MissionLabelled,
    MissionRestored,
    PhaseChanged,
    Recorded,
    ReviewFact,
    Supposition,
    TruthNoted,
    VariantDropped,
    VariantKept,
)
from backend.events.review import TruthWay
from backend.mission.flights import Flights
from backend.mission.learning import learn_from_truth
from backend.mission.records import Records
from backend.ports import JournalDamaged
from backend.reasons import Interrupted, refusals
from backend.reasons.search import WhichEmitter
from backend.search.errors import MissionConflict, MissionInputError
from backend.search.inputs import Reviewed
from backend.search.reported import must_be_near
from backend.spec import Place

MOST_VARIANTS = 12
"""Of one mission: each is computed again whenever they are compared."""
VARIANTS = ("variant_kept", "variant_dropped")


def variants_of(recorded: Iterable[Recorded]) -> dict[str, Supposition]:
    """By name, the one kept first before the others."""
    kept: dict[str, Supposition] = {}
    for record in recorded:
        match record.event:
            case VariantKept(name=name, wanted=wanted):
                kept[name] = wanted
            case VariantDropped(name=name):
                kept.pop(name, None)
            case _:
                pass
    return kept


@dataclass(slots=True)
class Review:
    """All methods raise MissionNotFound."""

    records: Records
    flights: Flights

    async def tell_truth(
        self,
        mission_id: str,
        emitter_id: str | None,
        place: Place | None,
        accuracy_m: float | None,
        how: TruthWay,
        by: str,
    ) -> None:
        """place None: looked for and not found. What the flight taught of its compass is judged again by it.

        Raises MissionInputError for an emitter that is not looked for, and for a place far off.
        """
        known = await self.records.load(mission_id)
        emitters = tuple(known[0].search.emitters)
        if emitter_id is None and len(emitters) != 1:
            raise MissionInputError(WhichEmitter(len(emitters)), "emitter_id")
        about = emitters[0] if emitter_id is None else emitter_id
        if about not in emitters:
            raise MissionInputError(refusals.NoSuchEmitter(about), "emitter_id")
        if place is not None:
            must_be_near(known[0].search.mission, place)
        await self._record(mission_id, TruthNoted(emitter_id=about, place=place, accuracy_m=accuracy_m, how=how, by=by))
        state, _ = await self.records.load(mission_id, known)
        started = await self.records.of_kinds(mission_id, ("mission_started",))
        await learn_from_truth(self.flights.equipment, mission_id, state.search, started)

    async def label(self, mission_id: str, name: str, tags: list[str], notes: str, by: str) -> None:
        """In the place of what was said before."""
        await self._record(mission_id, MissionLabelled(name=name, tags=tags, notes=notes, by=by))

    async def keep_variant(self, mission_id: str, name: str, wanted: Supposition, by: str) -> None:
        """Beside the mission, in the place of one of the same name. Raises MissionConflict when there are too many."""
        kept = variants_of(await self.records.of_kinds(mission_id, VARIANTS))
        if name not in kept and len(kept) >= MOST_VARIANTS:
            raise MissionConflict(refusals.TooManyVariants(MOST_VARIANTS))
        await self._record(mission_id, VariantKept(name=name, wanted=wanted, by=by))

    async def drop_variant(self, mission_id: str, name: str, by: str) -> None:
        """Nothing happens to a name that is not there."""
        if name in variants_of(await self.records.of_kinds(mission_id, VARIANTS)):
            await self._record(mission_id, VariantDropped(name=name, by=by))

    async def delete(self, mission_id: str, by: str) -> None:
        """Out of the list, to be restored for some days. Raises MissionConflict while it is under way."""
        async with self.records.lock(mission_id):  # no start comes in between
            if self.flights.running(mission_id) is not None:  # whether its facts can be read or not
                raise MissionConflict(refusals.StillUnderWay())
            try:
                state, _ = await self.records.load(mission_id)
            except JournalDamaged:
                await self._delete_unread(mission_id, by)
                return
            if state.search.stage == "open":
                raise MissionConflict(refusals.StillUnderWay())
            await self.records.give(mission_id, state, Reviewed(MissionDeleted(by=by)))

    async def restore(self, mission_id: str, by: str) -> None:
        """Into the list again. Nothing happens to one that is there."""
        try:
            if (await self.records.load(mission_id))[0].search.deleted:
                await self._record(mission_id, MissionRestored(by=by))
        except JournalDamaged:
            async with self.records.lock(mission_id):
                if (await self.records.listed(mission_id)).deleted:
                    await self.records.append_unread(mission_id, [MissionRestored(by=by)])

    async def _delete_unread(self, mission_id: str, by: str) -> None:
        """One whose facts are damaged. No craft flies for it, whatever it did last: none came back with it."""
        listed, why = await self.records.listed(mission_id), Interrupted("unreadable")
        facts: list[Event] = [
            PhaseChanged(craft_id=craft_id, before=phase, after="ground", reason=why)
            for craft_id, phase in listed.crafts.items()
        ]
        if listed.started_at_s is not None and not listed.ended:
            flown_s = self.flights.equipment.clock.now() - listed.started_at_s
            facts.append(MissionEnded(outcome="failed", reason=why, mission_time_s=flown_s))
        if not listed.deleted:
            await self.records.append_unread(mission_id, [*facts, MissionDeleted(by=by)])

    async def _record(self, mission_id: str, fact: ReviewFact) -> None:
        if self.flights.running(mission_id) is not None:
            await self.flights.give(mission_id, Reviewed(fact))
            return
        async with self.records.lock(mission_id):
            await self.flights.give(mission_id, Reviewed(fact))
