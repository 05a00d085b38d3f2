"""What the craft machine makes of a restart of the server."""

from __future__ import annotations

from dataclasses import replace

import pytest
from craft_walk import VEHICLE, CraftWalk, craft_in, moves, refusal, sent
from facts import (
    FAILSAFE,
    GIVEN_BACK,
    LANDED_BY_FAILSAFE,
    LINK_LOST,
    NAMED_FAILSAFE,
    OURS,
    PERHAPS_PILOT,
    PILOT,
)

from backend import commands
from backend.craft import effects, inputs
from backend.craft.state import AUTOMATIC, HOMEWARD
from backend.events import AlertRaised, Phase, ServerRestarted
from backend.reasons.flight import FailsafeFlies, FailsafeStopped, Landed, Ordered, PilotFlies
from hardware.authority import Authority

IN_FLIGHT: tuple[Phase, ...] = tuple(AUTOMATIC | HOMEWARD)


def test_a_restart_in_flight_holds_until_an_operator_resumes() -> None:
    for phase in IN_FLIGHT:
        walk = craft_in(phase)
        asked = walk.give(inputs.Restarted(OURS))
        assert sent(asked) == [effects.HoldVehicle()]
        assert walk.craft.phase == "hold"
        walk.believe()
        assert walk.craft.phase == "hold"
        assert moves(walk.order(commands.Resume())) or walk.craft.phase in ("planning", "waiting")


def test_a_restart_does_not_touch_a_vehicle_that_a_pilot_flies() -> None:
    for walk, heard in ((CraftWalk().to("flying"), PILOT), (CraftWalk().to("manual"), GIVEN_BACK)):
        assert not sent(walk.give(inputs.Restarted(heard)))
        assert walk.craft.phase == "manual"
        assert walk.craft.authority == heard


def test_a_restart_does_not_interrupt_the_failsafe_that_brings_the_vehicle_home() -> None:
    walk = CraftWalk().to("flying")
    assert not sent(walk.give(inputs.Restarted(FAILSAFE)))
    assert walk.craft.phase == "hold"
    homeward = CraftWalk().to("returning")
    homeward.give(inputs.Restarted(FAILSAFE))
    (why,), (why_homeward,) = (w.of_kind(AlertRaised) for w in (walk, homeward))
    assert (why.reason, why_homeward.reason) == (FailsafeFlies("server_away"), FailsafeFlies("ordered_before"))
    assert effects.TakeControl() in walk.order(commands.Resume())
    assert not walk.topics


@pytest.mark.parametrize("order", [commands.Return(), commands.Land()])
@pytest.mark.parametrize("heard", [OURS, FAILSAFE, LANDED_BY_FAILSAFE])
def test_a_craft_that_came_down_as_ordered_while_no_server_ran_is_down(order: object, heard: object) -> None:
    """Held instead, its mission would fly for ever, and no other could begin."""
    walk = CraftWalk().to("taking_off")
    walk.order(order)  # type: ignore[arg-type]
    asked = walk.give(inputs.Restarted(heard, on_ground=True))  # type: ignore[arg-type]
    assert not sent(asked)
    assert (walk.craft.phase, walk.craft.engaged) == ("ground", False)


def test_a_landing_that_was_ordered_ends_the_mission_after_any_number_of_restarts() -> None:
    walk = CraftWalk().to("flying")
    walk.order(commands.Land())
    walk.give(inputs.Restarted(FAILSAFE))
    walk.fold(ServerRestarted())
    walk.give(inputs.Restarted(FAILSAFE))
    assert walk.craft.phase == "hold"
    assert walk.of_kind(AlertRaised)[-1].reason == FailsafeFlies("ordered_before")
    walk.give(inputs.Landed())
    assert (walk.craft.phase, walk.craft.engaged) == ("ground", False)


def test_a_hold_that_is_ordered_after_the_restart_keeps_the_mission_whatever_lands_it() -> None:
    walk = CraftWalk().to("flying")
    walk.order(commands.Land())
    walk.give(inputs.Restarted(FAILSAFE))
    walk.order(commands.Hold())
    walk.give(inputs.AuthorityHeard(OURS))
    walk.give(inputs.AuthorityHeard(FAILSAFE))
    walk.fold(ServerRestarted())
    walk.give(inputs.Restarted(LANDED_BY_FAILSAFE, on_ground=True))
    walk.give(inputs.Landed())
    assert (walk.craft.phase, walk.last_alert.reason) == ("hold", Landed("hold"))


@pytest.mark.parametrize("phase", ["taking_off", "flying"])
def test_a_vehicle_that_the_failsafe_landed_while_the_server_started_is_no_pilots(phase: str) -> None:
    """On a busy machine a server needs a minute, and the autopilot is home before that."""
    walk = CraftWalk().to(phase)  # type: ignore[arg-type]
    assert not sent(walk.give(inputs.Restarted(LANDED_BY_FAILSAFE)))
    assert (walk.craft.phase, walk.craft.phase_reason) == ("hold", FailsafeFlies("server_away"))
    walk.give(inputs.Landed())
    assert (walk.craft.phase, walk.last_alert.reason) == ("hold", Landed("hold"))
    assert not any(isinstance(alert.reason, PilotFlies) for alert in walk.of_kind(AlertRaised))
    asked = walk.order(commands.Resume())
    first = next(k for k, effect in enumerate(asked) if isinstance(effect, VEHICLE))
    assert effects.TakeControl() in asked[:first]
    assert walk.craft.authority.taken_by is None


def test_the_failsafes_landing_is_no_takeover_by_a_pilot() -> None:
    walk = CraftWalk().to("flying")
    walk.give(inputs.AuthorityHeard(FAILSAFE))
    walk.give(inputs.AuthorityHeard(LANDED_BY_FAILSAFE))
    assert (walk.craft.phase, walk.craft.taken_over) == ("hold", False)
    assert not any(isinstance(alert.reason, PilotFlies) for alert in walk.of_kind(AlertRaised))


@pytest.mark.parametrize("heard", [OURS, FAILSAFE])
def test_after_an_abort_and_a_restart_hold_and_return_still_work_until_the_vehicle_is_down(heard: object) -> None:
    walk = CraftWalk().to("flying")
    walk.order(commands.Abort())
    assert walk.search.stage == "ended"
    walk.give(inputs.Restarted(heard))  # type: ignore[arg-type]
    assert walk.craft.phase == "hold"
    assert effects.HoldVehicle() in walk.order(commands.Hold())
    assert effects.ReturnHome() in walk.order(commands.Return())
    walk.give(inputs.HomeReached())
    walk.give(inputs.Landed())
    assert not walk.craft.engaged
    assert refusal(walk.order(commands.Hold())) is not None


STOPPED = replace(NAMED_FAILSAFE, mode="HOLD", given_back=True, heard=1, kind="waiting")


def test_a_failsafe_that_had_stopped_and_flies_again_is_told_anew() -> None:
    walk = CraftWalk().to("flying")
    walk.give(inputs.AuthorityHeard(NAMED_FAILSAFE))
    walk.give(inputs.AuthorityHeard(STOPPED))
    walk.give(inputs.FailsafeEnded("HOLD"))
    assert walk.last_alert.reason == FailsafeStopped("HOLD")
    assert not sent(walk.give(inputs.AuthorityHeard(NAMED_FAILSAFE)))
    assert (walk.topics, walk.last_alert.reason) == (["vehicle"], FailsafeFlies("battery"))


def test_after_a_restart_or_a_lost_link_it_says_what_the_failsafe_does_then_and_why() -> None:
    for heard, reason in ((NAMED_FAILSAFE, FailsafeFlies("battery")), (STOPPED, FailsafeStopped("HOLD"))):
        walk = CraftWalk().to("flying")
        walk.give(inputs.AuthorityHeard(NAMED_FAILSAFE))
        walk.give(inputs.LinkDown("vehicle", LINK_LOST))
        walk.give(inputs.AuthorityHeard(heard))
        walk.give(inputs.LinkUp("vehicle", 5.0))
        assert (walk.topics, walk.last_alert.reason) == (["vehicle"], reason)
        walk.give(inputs.Restarted(heard))
        assert (walk.topics, walk.last_alert.reason) == (["vehicle"], reason)


def test_after_a_restart_a_vehicle_that_its_failsafe_had_landed_before_is_said_to_stand() -> None:
    walk = CraftWalk().to("flying")
    walk.give(inputs.AuthorityHeard(FAILSAFE))
    walk.give(inputs.AuthorityHeard(LANDED_BY_FAILSAFE))
    walk.give(inputs.Landed())
    assert walk.topics == ["ground"]
    walk.give(inputs.Restarted(LANDED_BY_FAILSAFE, on_ground=True))
    walk.give(inputs.Landed())
    assert walk.topics == ["ground"]


@pytest.mark.parametrize("heard", [(NAMED_FAILSAFE,), (PERHAPS_PILOT, NAMED_FAILSAFE)])
@pytest.mark.parametrize("phase", sorted(HOMEWARD))
def test_a_way_home_from_before_a_restart_ends_as_ordered_whichever_word_of_a_failsafe_is_first(
    phase: Phase, heard: tuple[Authority, ...]
) -> None:
    walk = craft_in(phase)
    walk.give(inputs.Restarted(FAILSAFE))
    for authority in heard:
        walk.give(inputs.AuthorityHeard(authority))
    assert (walk.topics, walk.last_alert.reason) == (["vehicle"], FailsafeFlies("battery"))
    walk.give(inputs.Landed())
    assert (walk.craft.phase, walk.craft.engaged, walk.search.stage) == ("ground", False, "ended")


def test_a_landing_that_a_failsafe_takes_over_keeps_its_own_reason() -> None:
    walk = CraftWalk().to("returning")
    walk.order(commands.Hold())
    walk.order(commands.Land())
    for authority in (PERHAPS_PILOT, NAMED_FAILSAFE):
        walk.give(inputs.AuthorityHeard(authority))
    assert (walk.craft.phase, walk.craft.phase_reason) == ("landing", Ordered("land", "anna"))


def test_a_way_home_ordered_before_a_restart_ends_the_mission_though_a_named_failsafe_flies_it() -> None:
    walk = CraftWalk().to("flying")
    walk.order(commands.Return())
    walk.give(inputs.AuthorityHeard(NAMED_FAILSAFE))
    walk.fold(ServerRestarted())
    assert not sent(walk.give(inputs.Restarted(NAMED_FAILSAFE)))
    assert (walk.topics, walk.last_alert.reason) == (["vehicle"], FailsafeFlies("battery"))
    walk.give(inputs.Landed())
    assert (walk.craft.phase, walk.craft.engaged) == ("ground", False)


@pytest.mark.parametrize("heard", [NAMED_FAILSAFE, STOPPED])
def test_on_the_way_home_too_it_says_what_the_failsafe_does_after_a_lost_link(heard: Authority) -> None:
    walk = CraftWalk().to("flying")
    walk.order(commands.Return())
    walk.give(inputs.AuthorityHeard(heard))
    walk.give(inputs.LinkDown("vehicle", LINK_LOST))
    assert not sent(walk.give(inputs.LinkUp("vehicle", 5.0)))
    reason = FailsafeStopped("HOLD") if heard.given_back else FailsafeFlies("battery")
    assert (walk.topics, walk.last_alert.reason) == (["vehicle"], reason)


@pytest.mark.parametrize("again", ["link", "server"])
def test_of_a_vehicle_that_stands_armed_no_failsafe_is_said_to_fly_it_for_good(again: str) -> None:
    walk = CraftWalk().to("flying")
    walk.give(inputs.AuthorityHeard(FAILSAFE))
    walk.give(inputs.Landed())
    if again == "link":
        walk.give(inputs.LinkDown("vehicle", LINK_LOST))
        walk.give(inputs.LinkUp("vehicle", 5.0))
    else:
        walk.fold(ServerRestarted())
        walk.give(inputs.Restarted(FAILSAFE))
    walk.give(inputs.Landed())
    assert walk.topics == ["ground"]
