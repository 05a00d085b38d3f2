"""What one craft does for a mission at one moment: a fold of the mission's facts, and nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from backend.craft.ladder import Ladder
from backend.events import (
    AbortOrdered,
    AlertCleared,
    AlertRaised,
    AntennaFact,
    AreaChanged,
    AuthorityChanged,
    AutomaticChanged,
    BatteryCountdownStarted,
    BatteryCountdownStopped,
    BearingExcluded,
    BearingIncluded,
    BearingMeasured,
    CraftSource,
    Event,
    FlightStarted,
    HoldOrdered,
    Link,
    LinkLost,
    LinkRestored,
    MissionDrafted,
    MissionEdited,
    MissionStarted,
    NetsHung,
    OrderDone,
    OrderNotDone,
    OrderTried,
    Phase,
    PhaseChanged,
    PlacePassed,
    PlaceReached,
    PlaceRefused,
    PlanChosen,
    PlanVetoed,
    PrioritiesChanged,
    ServerRestarted,
    SourceMuteChanged,
    SweepRejected,
    SweepStarted,
    TookOff,
)
from backend.reasons import Reason
from backend.reasons.flight import FailsafeFlies, Ordered
from backend.search.state import OpenAlert, SearchState
from backend.spec import Place
from hardware.authority import NOBODY, Authority
from hardware.reasons.sweep import UnlikeAntenna

AUTOMATIC: frozenset[Phase] = frozenset({"taking_off", "planning", "waiting", "flying", "measuring"})
ORDERED_BEFORE = FailsafeFlies("ordered_before")
HOMEWARD: frozenset[Phase] = frozenset({"returning", "landing"})


@dataclass(frozen=True, slots=True)
class CraftState:
    """engaged: it was started for this mission and is not down since. searching: nor was it aborted.

    chosen: the place proposed, flown to or measured at, None when the next is still to be planned. reached: the craft
    is there, and whether it turns there is not decided. attempt: turns begun at the place. in_vain: those of them that
    ended without a bearing; one that a hold or a pilot broke off is none of them. maximum_retakes: of one sweep, from
    the specification (see `retakes`). taken: its bearings, each with its place, left_out: those of them that do not
    count. avoid: places vetoed or without a usable sweep since the last bearing, or since the search area changed.
    refused: places that the autopilot would not fly to, since the search area changed; refused_in_a_row: how many of
    the last ones were refused. return_reason: why it is on its way home. taken_from: the phase in which a
    pilot, or who seemed one, took it, while it is flown by hand; taken_reason: why it was in that phase. ladder: of
    the hold, return or landing that was ordered last; None once something else has come of it. counting_down: it
    returns soon because its battery runs low; countdown_stopped: somebody has stopped that, which they may once a
    flight. antenna: that it has flown with; None: nobody kept it. nets_wait: the autopilot's own fence is not known to
    be that of the search area.
    """

    craft_id: str
    phase: Phase = "ground"
    phase_reason: Reason | None = None
    engaged: bool = False
    searching: bool = False
    automatic: bool = True
    maximum_retakes: int = 2
    taken: tuple[tuple[str, Place], ...] = ()
    left_out: frozenset[str] = frozenset()
    took_off: bool = False
    chosen: PlanChosen | None = None
    accepted: bool = False
    reached: bool = False
    attempt: int = 0
    in_vain: frozenset[int] = frozenset()
    place_number: int = 0
    avoid: tuple[Place, ...] = ()
    refused: tuple[Place, ...] = ()
    refused_in_a_row: int = 0
    return_reason: Reason | None = None
    taken_from: Phase | None = None
    taken_reason: Reason | None = None
    ladder: Ladder | None = None
    counting_down: bool = False
    countdown_stopped: bool = False
    nets_wait: bool = False
    antenna: AntennaFact | None = None
    authority: Authority = NOBODY
    links_down: frozenset[Link] = frozenset()
    open_alerts: tuple[OpenAlert, ...] = ()
    alerts_raised: int = 0

    @property
    def taken_over(self) -> bool:
        """A pilot flies, or did last and nobody has taken control back."""
        return pilot_has(self.authority)

    @property
    def has_bearing(self) -> bool:
        """One that counts."""
        return any(bearing_id not in self.left_out for bearing_id, _ in self.taken)

    @property
    def shunned(self) -> tuple[Place, ...]:
        """Places that are not chosen next."""
        return (*self.avoid, *self.refused)

    @property
    def comes_down_as_ordered(self) -> bool:
        """Also when a server was away meanwhile, unless it has been ordered to hold since."""
        return self.phase in HOMEWARD or (self.phase == "hold" and self.phase_reason == ORDERED_BEFORE)


def failsafe_has(authority: Authority) -> bool:
    """The autopilot's failsafe has control, and no operator has taken it back since; after its landing, too."""
    return authority.who == "failsafe" or authority.failsafe_landed


def pilot_has(authority: Authority) -> bool:
    """A pilot has control, and no operator has taken it back since; after their landing, too."""
    return authority.taken_by is not None and not failsafe_has(authority)


def ours_to_order(authority: Authority) -> bool:
    """Neither a pilot nor the autopilot's failsafe has the vehicle."""
    return not failsafe_has(authority) and not pilot_has(authority)


def evolve(state: CraftState, event: Event) -> CraftState:
    """The state after one fact of the mission."""
    owner = getattr(event, "craft_id", None)
    if owner is not None and owner != state.craft_id:
        return state
    match event:
        case MissionDrafted(spec=spec) | MissionEdited(spec=spec):
            return replace(state, automatic=spec.flight.automatic, maximum_retakes=spec.sensor.maximum_retakes)
        case AreaChanged():
            cleared = replace(
                state, chosen=None, accepted=False, reached=False, avoid=(), refused=(), refused_in_a_row=0
            )
            return replace(cleared, nets_wait=state.engaged)
        case NetsHung():
            return replace(state, nets_wait=False)
        case MissionStarted(antenna=antenna):
            return replace(state, engaged=True, searching=True, nets_wait=False, antenna=antenna)
        case PhaseChanged(before=before, after=after, reason=reason):
            back = reason if after == "returning" else state.return_reason
            up = after != "ground"
            ordered = after in HOMEWARD or after == "hold"
            return replace(
                state,
                phase=after,
                phase_reason=reason,
                reached=state.reached and after in ("planning", "measuring"),
                return_reason=back,
                taken_from=before if after == "manual" else None,
                taken_reason=state.phase_reason if after == "manual" else None,
                ladder=state.ladder if ordered else None,
                engaged=state.engaged and up,
                searching=state.searching and up,
                counting_down=False,
                countdown_stopped=state.countdown_stopped and up,
            )
        case HoldOrdered(by=by, reason=reason) if state.phase == "hold" and state.phase_reason == ORDERED_BEFORE:
            return replace(state, phase_reason=reason if by is None else Ordered("hold", by))
        case TookOff():
            return replace(state, took_off=True)
        case BatteryCountdownStarted():
            return replace(state, counting_down=True)
        case BatteryCountdownStopped(by=by):
            return replace(state, counting_down=False, countdown_stopped=state.countdown_stopped or by is not None)
        case AutomaticChanged(automatic=automatic):
            return replace(state, automatic=automatic)
        case AbortOrdered():
            return replace(state, searching=False)
        case AuthorityChanged(authority=authority):
            return replace(state, authority=authority, ladder=state.ladder if ours_to_order(authority) else None)
        case OrderTried(order=order, rung=rung, because=because):
            return replace(state, ladder=Ladder(order, rung, "tried", because))
        case OrderNotDone(order=order, rung=rung, reason=reason):
            return replace(state, ladder=Ladder(order, rung, "waits", reason))
        case OrderDone() if state.ladder is not None:
            return replace(state, ladder=replace(state.ladder, stage="done"))
        case LinkLost(link=link):
            return replace(state, links_down=state.links_down | {link})
        case LinkRestored(link=link):
            return replace(state, links_down=state.links_down - {link})
        case ServerRestarted():
            return replace(state, links_down=frozenset(), ladder=None, counting_down=False)
        case AlertRaised(alert_id=alert_id, topic=topic, reason=reason, craft_id=str()):
            alerts = (*state.open_alerts, OpenAlert(alert_id, topic, reason))
            return replace(state, open_alerts=alerts, alerts_raised=state.alerts_raised + 1)
        case AlertCleared(alert_id=alert_id):
            return replace(state, open_alerts=tuple(a for a in state.open_alerts if a.alert_id != alert_id))
        case _:
            return _evolve_place(state, event)


def _evolve_place(state: CraftState, event: Event) -> CraftState:
    """The place in hand: chosen, flown to, measured at, given up."""
    match event:
        case PlanChosen(place_number=number, source=source):
            return replace(
                state,
                chosen=event,
                place_number=number,
                accepted=source == "operator",
                reached=False,
                attempt=0,
                in_vain=frozenset(),
            )
        case PlanVetoed(place=place):
            return replace(state, chosen=None, accepted=False, avoid=(*state.avoid, place))
        case PlaceRefused(place=place):
            refused = (*state.refused, place)
            in_a_row = state.refused_in_a_row + 1
            return replace(state, chosen=None, accepted=False, refused=refused, refused_in_a_row=in_a_row)
        case PlaceReached():
            return replace(state, refused_in_a_row=0, reached=True)
        case PlacePassed():
            return replace(state, chosen=None, accepted=False, reached=False, avoid=())
        case FlightStarted():
            return replace(state, accepted=True, reached=False)
        case SweepStarted(attempt=attempt):
            return replace(state, attempt=attempt, reached=False)
        case SweepRejected(attempt=attempt, place=place) if _ours(state, event):
            if state.chosen is None:  # the same turn heard another emitter: this one is not to be sought here again
                return replace(state, avoid=(*state.avoid, place))
            if attempt in state.in_vain:  # of each turn the first counts (see `most_repeated_first`)
                return state
            in_vain = state.in_vain | {attempt}
            if len(in_vain) <= retakes(state.maximum_retakes, state.has_bearing, event):
                return replace(state, in_vain=in_vain)
            return replace(state, chosen=None, accepted=False, avoid=(*state.avoid, state.chosen.place))
        case BearingMeasured() if _ours(state, event):
            taken = (*state.taken, (event.bearing_id, event.place))
            return replace(state, chosen=None, accepted=False, avoid=(), taken=taken)
        case BearingExcluded() | BearingIncluded():
            return _counted_anew(_planned_anew(state), event)
        case SourceMuteChanged() | PrioritiesChanged():
            return _planned_anew(state)
        case _:
            return state


def _planned_anew(state: CraftState) -> CraftState:
    """A place that is only proposed comes from what was known before."""
    return replace(state, chosen=None) if state.phase == "waiting" else state


def _counted_anew(state: CraftState, event: BearingExcluded | BearingIncluded) -> CraftState:
    """A turn whose bearing is left out was made in vain. Once none is left the place is avoided: nothing else keeps it
    from lying above the emitter, and without a bearing the craft would turn next where it hovers."""
    place = dict(state.taken).get(event.bearing_id)
    if place is None:
        return state
    if isinstance(event, BearingIncluded):
        return replace(state, left_out=state.left_out - {event.bearing_id})
    after = replace(state, left_out=state.left_out | {event.bearing_id})
    return after if after.has_bearing else replace(after, avoid=(*after.avoid, *(place for _, place in after.taken)))


def retakes(most: int, has_bearing: bool, event: SweepRejected) -> int:
    """How often a turn that was rejected so is made again at its place, at most `most` times.

    Not at all where a whole turn heard nothing and says that it listened to all sides: that counts (decision 76), and
    the next place tells more than silence there again. Before the first bearing a place may happen to lie right above
    the emitter. Most sweeps from there do not look like the antenna, and a repeated one that does points away from the
    emitter: the place is left at once (decision 70).
    """
    whole = event.turn is None or not event.turn.partial
    silent = whole and event.silence is not None and min(event.silence.chances) > 0.0
    unlike = isinstance(event.reason, UnlikeAntenna) and not has_bearing
    return 0 if unlike or silent else most


def most_repeated_first(
    state: CraftState, search: SearchState, results: Sequence[BearingMeasured | SweepRejected]
) -> list[SweepRejected]:
    """What was rejected of one turn, one sweep an emitter: the first says whether it is repeated. An emitter that is
    not sought asks for nothing, and one that was silent takes no turn from one whose sweep was bad."""
    sought = {emitter.emitter_id for emitter in search.sought}
    rejected = (result for result in results if isinstance(result, SweepRejected))
    most, has_bearing = state.maximum_retakes, state.has_bearing
    return sorted(rejected, key=lambda one: (one.emitter_id not in sought, -retakes(most, has_bearing, one)))


def _ours(state: CraftState, event: SweepRejected | BearingMeasured) -> bool:
    """Only a craft's own sweep is done with its place: a bearing from elsewhere takes no destination from it."""
    return isinstance(event.source, CraftSource) and event.source.craft_id == state.craft_id
