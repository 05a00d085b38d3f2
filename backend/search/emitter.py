"""What a search knows of one emitter at one moment."""

from __future__ import annotations

from dataclasses import dataclass

from backend.events import (
    BearingMeasured,
    BearingSource,
    BeliefUpdated,
    HeardOnTheWay,
    SweepRejected,
    TruthNoted,
)
from backend.reasons import Reason
from planner.reasons import BearingsNotInBelief


@dataclass(frozen=True, slots=True)
class EmitterState:
    """What is known of one emitter.

    claim: the last belief that said localized; of an emitter that moves it stands for its moment, whatever is believed
    later.

    muted: sources whose bearings do not count, as those in `excluded` do not.

    belief_current: this server computed `belief`; no bearing came or went since, of this emitter or of one that tells
    of its source's errors, and the area is the same. folded_again: a server before a restart did, and the same bearings
    are being folded again. localized_at_s: UTC epoch seconds at which the belief was first good enough, None when it is
    not. truth: what was told last of where it really was; no belief about it depends on that. silences: turns that
    heard nothing of it and tell something by that. ways: legs on which it was listened to, those that told nothing too.
    """

    emitter_id: str
    measured: tuple[BearingMeasured, ...] = ()
    excluded: frozenset[str] = frozenset()
    muted: frozenset[BearingSource] = frozenset()
    belief: BeliefUpdated | None = None
    belief_current: bool = False
    folded_again: bool = False
    localized_at_s: float | None = None
    claim: BeliefUpdated | None = None
    truth: TruthNoted | None = None
    silences: tuple[SweepRejected, ...] = ()
    ways: tuple[HeardOnTheWay, ...] = ()

    @property
    def bearings(self) -> tuple[BearingMeasured, ...]:
        """The bearings that count, in the order they were taken."""
        return tuple(b for b in self.measured if self.counts(b))

    def counts(self, bearing: BearingMeasured) -> bool:
        """Neither it nor its source was left out."""
        return bearing.bearing_id not in self.excluded and bearing.source not in self.muted

    @property
    def bearing_ids(self) -> tuple[str, ...]:
        """Of those that count, in the order in which they are folded, of the turns that heard nothing, and of legs."""
        beside = (*(one.sweep_id for one in self.unheard), *(leg.leg_id for leg in self.legs))
        return (*(b.bearing_id for b in self.bearings), *beside)

    @property
    def unheard(self) -> tuple[SweepRejected, ...]:
        """The turns that heard nothing of it and count, in their order."""
        return tuple(one for one in self.silences if one.sweep_id not in self.excluded)

    @property
    def legs(self) -> tuple[HeardOnTheWay, ...]:
        """Those that tell something and count, in their order."""
        return tuple(
            leg for leg in self.ways if leg.tells and leg.leg_id not in self.excluded and leg.source not in self.muted
        )

    @property
    def localized(self) -> bool:
        """Never by a belief that bearings or the area have outrun."""
        return self.belief_current and self.belief is not None and self.belief.localized

    @property
    def found(self) -> bool:
        """Localized; a restart of the server takes nothing from what its bearings say."""
        return (self.belief_current or self.folded_again) and self.belief is not None and self.belief.localized

    @property
    def not_yet(self) -> tuple[Reason, ...]:
        """What is missing for "localized"; nothing before the first belief or bearing."""
        if self.bearings and (self.belief is None or self.belief.bearings == 0):
            return (BearingsNotInBelief(len(self.bearings)),)
        return () if self.belief is None else tuple(self.belief.not_yet)
