"""Who flies the vehicle: we, the pilot, the autopilot's failsafe, or nobody. One pure reducer, no clock, no mode names.

A mode that we did not command, shown in flight, is somebody else's; only an operator takes control back. The
autopilot's dialect classifies modes; here a mode is a token to compare and a kind. `Authority` holds all that is needed
to go on after a restart of the server.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, assert_never

Who = Literal["ours", "pilot", "failsafe", "nobody"]
ModeKind = Literal["waiting", "return", "land", "other"]
"""waiting: the vehicle hovers until it is commanded. return, land: a failsafe may enter it by itself, a pilot too."""
FailsafeCause = Literal["battery", "transmitter", "position", "fence", "silence", "other"]
"""Why a failsafe acts, by the autopilot's own word. transmitter: the pilot's is not heard; silence: nothing of ours."""

HOMEWARD: frozenset[ModeKind] = frozenset({"return", "land"})
GIVEN_BACK_S = 1.5
"""A mode is the pilot's way to give the vehicle back only when heard this much later than the takeover: PX4 reports the
sticks before it reports the mode."""
NAMED_S = 1.0
"""A way home that begins so shortly before or after the autopilot names a failsafe is that failsafe's. It says both in
one turn of its loop; a mode that got lost on the link comes again within half a second."""
ACTS_S = 2.5
"""So long after a way home has begun its state may still tell whose that is: it comes once a second, or gets lost."""


@dataclass(frozen=True, slots=True)
class Authority:
    """Who flies, and what is needed to judge the next mode.

    taken_by: how somebody else took control; not None: no command passes until an operator takes control. It outlasts
    the landing, where `who` is nobody. mode: the name of the mode in which they took it, to be shown only.
    given_back: the vehicle that somebody else took waits for commands again, or stands disarmed.
    perhaps_failsafe: the pilot has control, but every mode since may be the autopilot's failsafe just as well.
    failsafe_landed: nobody has it since it stands disarmed, and no pilot had it before: the failsafe landed it.
    cause: of the failsafe that flies, where the autopilot said it; before it flies: what it named last. named_at_s:
    when it named one last.
    under_way: tokens of the modes of a command whose mode had not shown yet when they took control. undone: right after
    that the vehicle showed one of these: the command crossed their switch. They have control all the same, and have
    given nothing back.

    commanded: tokens of the modes that follow from our last command; empty: nothing is commanded. tolerated: tokens of
    modes that may still show because of what was before that command. shown_before: the mode when the command was sent;
    until the acknowledgement it proves nothing. heard, kind, armed: of the last mode. restarted: none was heard since
    the server came back.
    """

    who: Who = "nobody"
    taken_by: Literal["mode", "sticks"] | None = None
    taken_at_s: float | None = None
    mode: str | None = None
    given_back: bool = False
    perhaps_failsafe: bool = False
    failsafe_landed: bool = False
    cause: FailsafeCause | None = None
    named_at_s: float | None = None
    under_way: tuple[int, ...] = ()
    undone: bool = False
    commanded: tuple[int, ...] = ()
    tolerated: tuple[int, ...] = ()
    shown_before: int | None = None
    heard: int | None = None
    kind: ModeKind | None = None
    armed: bool = False
    restarted: bool = False

    @property
    def homeward(self) -> bool:
        """The vehicle returns or lands, whoever began that."""
        return self.kind in HOMEWARD


NOBODY = Authority()
"""Before anything was commanded or heard."""


@dataclass(frozen=True, slots=True)
class CommandSent:
    """We are about to send a flight command. modes: tokens of the modes that follow from it."""

    modes: frozenset[int]


@dataclass(frozen=True, slots=True)
class CommandAcknowledged:
    """The autopilot accepted our last command: what it shows from now on follows from it."""


@dataclass(frozen=True, slots=True)
class ModeHeard:
    """The autopilot reported its mode.

    mode: the token; name: for people. armed: None while it is not known since a silence. after_silence: the vehicle, or
    this server, was silent until a moment ago, so a failsafe may be acting on that. at_s: UTC. acts: whether this mode
    is a failsafe's choice, by the autopilot's own word; None: it does not say. waits_again: this autopilot goes on
    waiting by itself once it knows its place again.
    """

    mode: int
    kind: ModeKind
    name: str
    armed: bool | None
    in_air: bool
    after_silence: bool
    at_s: float
    acts: bool | None = None
    waits_again: bool = True


@dataclass(frozen=True, slots=True)
class SticksTookOver:
    """The autopilot says that the pilot took over with the sticks. at_s: UTC."""

    at_s: float


@dataclass(frozen=True, slots=True)
class SwitchMoved:
    """The pilot has moved their mode switch, and a moment later the mode is `mode`. at_s: UTC."""

    mode: str
    at_s: float


@dataclass(frozen=True, slots=True)
class FailsafeNamed:
    """The autopilot says that a failsafe of its own acts, and why; it may only warn all the same. at_s: UTC."""

    cause: FailsafeCause
    at_s: float


@dataclass(frozen=True, slots=True)
class FlightEnded:
    """What was commanded is over, and the vehicle stands on the ground."""


@dataclass(frozen=True, slots=True)
class OperatorTookControl:
    """An operator's explicit deed: the mode of this moment is accepted, and commands pass again."""


@dataclass(frozen=True, slots=True)
class ServerRestarted:
    """Nobody commanded or listened for a while."""


Seen = (
    CommandSent
    | CommandAcknowledged
    | ModeHeard
    | SticksTookOver
    | SwitchMoved
    | FailsafeNamed
    | FlightEnded
    | OperatorTookControl
    | ServerRestarted
)


def authority_after(authority: Authority, seen: Seen) -> Authority:
    """Who flies after `seen`. A command may be sent while `who` is "ours", and at no other time."""
    match seen:
        case CommandSent(modes=modes):
            return _commanded(authority, modes)
        case CommandAcknowledged():
            return replace(authority, shown_before=None)
        case ModeHeard():
            return _mode_heard(authority, seen)
        case SticksTookOver(at_s=at_s):
            return _taken(authority, "pilot", "sticks", at_s, None) if authority.armed else authority
        case SwitchMoved():
            return _switch_moved(authority, seen)
        case FailsafeNamed():
            return _failsafe_named(authority, seen)
        case FlightEnded():
            return _nothing_commanded(authority)
        case OperatorTookControl():
            return _taken_back(authority)
        case ServerRestarted():
            # what was before the last command shows no longer; a pilot may have selected just that
            return replace(authority, tolerated=(), shown_before=None, restarted=True)
        case _:
            assert_never(seen)


def _commanded(authority: Authority, modes: frozenset[int]) -> Authority:
    if authority.taken_by is not None:
        return authority
    shown = set[int]() if authority.heard is None else {authority.heard}
    tolerated = _tokens(({*authority.tolerated, *authority.commanded} | shown) - modes)
    return replace(
        authority,
        who="ours",
        commanded=_tokens(modes),
        tolerated=tolerated,
        shown_before=authority.heard if tolerated else None,
    )


def _tokens(modes: set[int] | frozenset[int]) -> tuple[int, ...]:
    return tuple(sorted(modes))


def _nothing_commanded(authority: Authority) -> Authority:
    who = "nobody" if authority.taken_by is None else authority.who
    return replace(authority, who=who, commanded=(), tolerated=(), shown_before=None)


def _taken_back(authority: Authority) -> Authority:
    if authority.taken_by is None:
        return authority
    commanded = (authority.heard,) if authority.armed and authority.heard is not None else ()
    return Authority(
        who="ours" if commanded else "nobody",
        commanded=commanded,
        heard=authority.heard,
        kind=authority.kind,
        armed=authority.armed,
        restarted=authority.restarted,
    )


def _mode_heard(before: Authority, seen: ModeHeard) -> Authority:
    if seen.armed is None and seen.kind == "waiting":
        return before  # an autopilot goes there by itself once it has landed, as it may have done unheard
    armed = before.armed if seen.armed is None else seen.armed
    now = replace(before, heard=seen.mode, kind=seen.kind, armed=armed, restarted=False)
    if before.armed and not armed:
        now = _nothing_commanded(now)  # the flight has ended; a new one starts with a command
    if now.taken_by is not None:
        return _while_taken(before, now, seen)
    if not armed and not now.commanded:
        return now  # on the ground anybody may select modes
    return _judged(before, now, seen)


def _judged(before: Authority, now: Authority, seen: ModeHeard) -> Authority:
    """Nobody had taken control so far: is this mode somebody else's?"""
    waiting = seen.kind == "waiting"
    if waiting and not seen.in_air and not now.tolerated:
        return now  # an autopilot goes to its waiting mode by itself once it has landed
    if not now.commanded and (waiting or not seen.in_air):
        return now
    if seen.mode in now.commanded:
        confirmed = seen.mode != now.shown_before
        return replace(now, tolerated=(), shown_before=None) if confirmed else now
    if seen.mode in now.tolerated:
        return now
    if waiting and before.restarted:
        return _nothing_commanded(now)  # the last command of the server before may not have been recorded
    return _taken(now, "failsafe" if _is_failsafes(now, seen) else "pilot", "mode", seen.at_s, seen)


def _is_failsafes(now: Authority, seen: ModeHeard) -> bool:
    """Is this way home, which nobody commanded, the autopilot's own?"""
    if seen.kind not in HOMEWARD:
        return False
    return seen.after_silence or bool(seen.acts) or (seen.acts is None and _named_lately(now, seen.at_s))


def _named_lately(authority: Authority, at_s: float) -> bool:
    return authority.named_at_s is not None and 0.0 <= at_s - authority.named_at_s <= NAMED_S


def _failsafe_named(authority: Authority, seen: FailsafeNamed) -> Authority:
    """Only a way home that began in the same moment becomes the failsafe's; a pilot keeps what they had before."""
    if not authority.armed:
        return authority
    if authority.who == "pilot":
        begun = authority.perhaps_failsafe and authority.homeward and _began_lately(authority, seen.at_s, NAMED_S)
        named = replace(authority, named_at_s=seen.at_s)
        return _failsafes(named, seen.cause) if begun and not authority.undone else authority
    if authority.who == "failsafe":
        known = seen.cause == "other" and authority.cause is not None
        return replace(authority, cause=authority.cause if known else seen.cause, named_at_s=seen.at_s)
    return replace(authority, cause=seen.cause, named_at_s=seen.at_s)


def _began_lately(authority: Authority, at_s: float, within_s: float) -> bool:
    return 0.0 <= at_s - (authority.taken_at_s or 0.0) <= within_s


def _failsafes(authority: Authority, cause: FailsafeCause) -> Authority:
    """What counted as a pilot's until now."""
    return replace(authority, who="failsafe", perhaps_failsafe=False, given_back=False, cause=cause)


def _taken(
    authority: Authority, who: Who, by: Literal["mode", "sticks"], at_s: float, heard: ModeHeard | None
) -> Authority:
    cause = None
    if who == "failsafe" and heard is not None:
        named = _named_lately(authority, at_s)
        acts = "silence" if heard.after_silence else "other"
        cause = authority.cause if named else acts if heard.acts else None
    return replace(
        _nothing_commanded(authority),
        who=who,
        taken_by=by,
        taken_at_s=at_s,
        mode=None if heard is None else heard.name,
        given_back=not authority.armed,
        under_way=authority.commanded if authority.tolerated else (),
        undone=False,
        failsafe_landed=False,
        cause=cause,
        named_at_s=None,
        perhaps_failsafe=who == "pilot" and heard is not None and heard.kind in HOMEWARD and heard.acts is None,
    )


def _switch_moved(authority: Authority, seen: SwitchMoved) -> Authority:
    """Whoever moves the switch wants the vehicle; a mode of ours that still shows has undone it. Of a transmitter that
    is lost it moves by itself."""
    if not authority.armed:
        return authority
    if authority.who == "pilot":
        return replace(authority, perhaps_failsafe=False)
    named = authority.who == "failsafe" and authority.cause not in (None, "silence", "transmitter")
    if authority.who != "ours" and not named:
        return authority
    taken = _taken(authority, "pilot", "mode", seen.at_s, None)
    return replace(taken, mode=seen.mode, undone=authority.heard in authority.commanded)


def _while_taken(before: Authority, now: Authority, seen: ModeHeard) -> Authority:
    """Somebody else has control, or had it before the vehicle landed."""
    if not now.armed:
        who = "nobody" if before.armed else before.who
        by_failsafe = before.failsafe_landed or (who == "nobody" and before.who == "failsafe")
        return replace(now, who=who, failsafe_landed=by_failsafe, given_back=True, undone=False)
    if before.who == "nobody":
        return _taken(now, "pilot", "mode", seen.at_s, seen)  # armed again by hand
    waiting, homeward = seen.kind == "waiting", seen.kind in HOMEWARD
    if before.who == "failsafe":
        if not seen.in_air or (waiting and seen.mode == before.heard and not seen.after_silence):
            return now
        told = before.cause is not None or before.given_back  # else it may be our own return, of before a restart
        if homeward and told and not seen.after_silence and _selected_by_hand(before, seen):
            return _taken(now, "pilot", "mode", seen.at_s, seen)
        waits_again = before.cause == "position" and seen.waits_again
        if homeward or (waiting and (seen.after_silence or waits_again)):
            # on the way home it changes its mode by itself; what stopped it so early may have been our earlier command
            cause = before.cause or ("silence" if homeward and seen.acts else None)
            return replace(now, mode=seen.name, given_back=waiting, cause=cause)
        return _taken(now, "pilot", "mode", seen.at_s, seen)
    late = seen.at_s >= (now.taken_at_s or 0.0) + GIVEN_BACK_S
    again = seen.mode == before.heard
    undone = before.undone if again else seen.mode in before.under_way and not late
    if seen.acts and homeward and now.perhaps_failsafe and not undone and _began_lately(now, seen.at_s, ACTS_S):
        return replace(_failsafes(now, "other"), mode=seen.name, undone=False)
    return replace(
        now,
        undone=undone,
        given_back=waiting and late and not undone,
        perhaps_failsafe=before.perhaps_failsafe and _doubt_stays(seen),
    )


def _selected_by_hand(before: Authority, seen: ModeHeard) -> bool:
    """A way home heard while a named failsafe flies one: the pilot may have selected the same, or another."""
    return seen.acts is False or (seen.mode != before.heard and not _is_failsafes(before, seen))


def _doubt_stays(seen: ModeHeard) -> bool:
    """Whether a mode may still be the failsafe's doing."""
    if not seen.in_air or seen.kind == "waiting":
        return True
    return seen.kind in HOMEWARD and seen.acts is not False
