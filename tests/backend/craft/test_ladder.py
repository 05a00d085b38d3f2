"""An order is a ladder: refused, it is tried again, then the next rung; each told, none given up."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import pytest
from craft_walk import CraftWalk, craft_in, sent
from facts import FAILSAFE, LINK_LOST, NO_ANSWER, OURS, PILOT

from backend import commands
from backend.commands import ForCraft
from backend.craft import effects, inputs
from backend.craft.ladder import BEGINS_AGAIN_S, LADDERS, Ladder
from backend.events import OrderDone, OrderNotDone, OrderTried
from backend.reasons import Instead, NotDone
from backend.reasons.flight import OrderName

ORDERS: dict[OrderName, ForCraft] = {
    "hold": commands.Hold(),
    "return": commands.Return(),
    "land": commands.Land(),
    "abort": commands.Abort(),
}
WAY = {effects.HoldVehicle(): "hold", effects.ReturnHome(): "return", effects.Land(): "land"}


def refuse(walk: CraftWalk) -> float | None:
    """The vehicle refuses what it was told last; seconds until the next rung, None when it waits for the link."""
    ladder = walk.craft.ladder
    assert ladder is not None
    asked = walk.give(inputs.WorkFailed(ladder.way, NO_ANSWER, in_air=True))
    return next((e.seconds for e in asked if isinstance(e, effects.StartTimer) and e.name == "order"), None)


def climb(walk: CraftWalk, order: OrderName, rungs: int) -> list[tuple[str, float]]:
    """(what was commanded, seconds after the refusal before), while every rung is refused."""
    (first,) = sent(walk.order(ORDERS[order]))
    tried = [(WAY[first], 0.0)]  # type: ignore[index]
    for _ in range(rungs):
        pause = refuse(walk)
        assert pause is not None
        (command,) = sent(walk.give(inputs.TimerExpired("order")))
        tried.append((WAY[command], pause))  # type: ignore[index]
    return tried


@pytest.mark.parametrize("order", ORDERS)
def test_a_refused_order_is_tried_again_then_the_next_rung_and_after_the_last_the_first(order: OrderName) -> None:
    rungs = LADDERS[order]
    walk = CraftWalk().to("flying")
    tried = climb(walk, order, 2 * len(rungs))
    expected = [(rung.way, rung.after_s) for rung in rungs]
    again = [(rungs[0].way, BEGINS_AGAIN_S), *expected[1:]]
    assert tried == [*expected, *again, again[0]]
    assert len(walk.of_kind(OrderTried)) == len(tried)
    assert len(walk.of_kind(OrderNotDone)) == len(tried) - 1
    assert walk.topics == ["order"]
    assert not walk.of_kind(OrderDone)


@pytest.mark.parametrize("order", ["hold", "return", "abort"])
def test_landing_where_it_is_comes_last_with_time_for_another_order(order: OrderName) -> None:
    rungs = LADDERS[order]
    first = next(k for k, rung in enumerate(rungs) if rung.way == "land")
    assert {rung.way for rung in rungs[:first]} == {"hold", "return"}
    assert all(rung.way == "land" for rung in rungs[first:])
    assert rungs[first].after_s >= 10.0


def test_a_refusal_is_told_with_its_reason_and_what_comes_next() -> None:
    walk = CraftWalk().to("flying")
    walk.order(commands.Return())
    refuse(walk)
    (told,) = walk.of_kind(OrderNotDone)
    assert (told.order, told.way, told.reason, told.next_way, told.next_in_s) == (
        "return", "return", NO_ANSWER, "return", 1.0,
    )  # fmt: skip
    assert walk.last_alert.reason == NotDone("return", "return", NO_ANSWER, "return", 1.0)


def test_an_abort_holds_and_when_the_vehicle_hovers_it_returns() -> None:
    walk = CraftWalk().to("flying")
    assert sent(walk.order(commands.Abort())) == [effects.HoldVehicle()]
    assert walk.craft.ladder == Ladder("abort")
    assert sent(walk.give(inputs.CarriedOut("hold"))) == [effects.ReturnHome()]
    assert not walk.of_kind(OrderDone)
    walk.give(inputs.CarriedOut("return"))
    assert [(done.order, done.way) for done in walk.of_kind(OrderDone)] == [("abort", "return")]
    assert not walk.topics


def test_an_abort_whose_hold_is_refused_returns_at_once() -> None:
    walk = CraftWalk().to("flying")
    walk.order(commands.Abort())
    assert refuse(walk) == 0.0
    assert sent(walk.give(inputs.TimerExpired("order"))) == [effects.ReturnHome()]


@pytest.mark.parametrize(
    ("order", "refused", "way", "phase"), [("hold", 3, "return", "returning"), ("return", 5, "land", "landing")]
)
def test_the_phase_says_what_the_vehicle_does_instead(order: OrderName, refused: int, way: str, phase: str) -> None:
    walk = CraftWalk().to("flying")
    climb(walk, order, refused)
    walk.give(inputs.CarriedOut(way))  # type: ignore[arg-type]
    assert walk.craft.phase == phase
    assert walk.craft.phase_reason == Instead(order, way, NO_ANSWER)  # type: ignore[arg-type]
    assert walk.topics == ["order"]


def test_a_refused_return_that_hovers_meanwhile_is_tried_again_after_a_while() -> None:
    walk = CraftWalk().to("flying")
    climb(walk, "return", 3)
    asked = walk.give(inputs.CarriedOut("hold"))
    assert effects.StartTimer("order", 10.0) in asked
    assert walk.topics == ["order"]
    assert sent(walk.give(inputs.TimerExpired("order"))) == [effects.ReturnHome()]


def test_an_unheard_order_waits_for_the_link_and_no_rung_is_skipped() -> None:
    walk = CraftWalk().to("flying")
    walk.order(commands.Hold())
    walk.give(inputs.LinkDown("vehicle", LINK_LOST))
    for _ in range(3):
        assert refuse(walk) is None
        assert sent(walk.give(inputs.LinkUp("vehicle", 9.0))) == [effects.HoldVehicle()]
        walk.give(inputs.LinkDown("vehicle", LINK_LOST))


@pytest.mark.parametrize("authority", [PILOT, FAILSAFE])
def test_whoever_takes_over_ends_it_at_once(authority: object) -> None:
    for refused in (False, True):
        walk = CraftWalk().to("flying")
        walk.order(commands.Return())
        if refused:
            refuse(walk)
        walk.give(inputs.AuthorityHeard(authority))  # type: ignore[arg-type]
        assert walk.craft.ladder is None
        assert "order" not in walk.topics
        for late in (inputs.TimerExpired("order"), inputs.WorkFailed("return", NO_ANSWER, True)):
            assert not sent(walk.give(late))


def test_crossing_orders_leave_the_newest_alone_under_way() -> None:
    for first, second in pairwise((*ORDERS, *reversed(ORDERS))):
        walk = CraftWalk().to("flying")
        walk.order(ORDERS[first])
        refuse(walk)
        walk.order(ORDERS[second])
        if second != "abort" or first != "abort":
            assert walk.craft.ladder == Ladder(second)
        late = "land" if LADDERS[second][0].way != "land" else "hold"
        assert not sent(walk.give(inputs.CarriedOut(late)))  # type: ignore[arg-type]
        assert not walk.of_kind(OrderDone)


@pytest.mark.parametrize(
    "play",
    [
        lambda walk: walk.order(commands.Resume()),
        lambda walk: walk.give(inputs.Landed()),
        lambda walk: walk.give(inputs.Restarted(OURS)),
    ],
)
def test_what_comes_after_an_order_leaves_no_alert_of_it(play: Callable[[CraftWalk], object]) -> None:
    walk = craft_in("hold")
    walk.order(commands.Hold())
    refuse(walk)
    play(walk)
    assert "order" not in walk.topics


def test_a_landing_where_it_is_may_be_turned_into_a_return_and_the_one_at_home_goes_on() -> None:
    walk = CraftWalk().to("flying")
    walk.order(commands.Land())
    walk.give(inputs.CarriedOut("land"))
    assert sent(walk.order(commands.Return())) == [effects.ReturnHome()]


def test_a_return_that_is_done_at_the_second_try_is_a_return() -> None:
    walk = CraftWalk().to("flying")
    climb(walk, "return", 1)
    walk.give(inputs.HomeReached())
    walk.give(inputs.CarriedOut("return"))
    assert walk.craft.phase == "landing"
    assert not walk.topics
