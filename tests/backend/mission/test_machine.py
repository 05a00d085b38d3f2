"""The mission machine over its search and its craft: every state against every input, and the rules on any walk."""

from __future__ import annotations

import pytest
from craft_inputs import ORDERS, every_craft_input
from craft_walk import MOVES, VEHICLE
from facts import (
    CHECK,
    FAILED_CHECK,
    GIVEN_BACK,
    HOME,
    IMPORT,
    NOT_YET,
    OTHER_AREA,
    OURS,
    PERSON,
    SECOND,
    SPEC,
    START,
    TWO_SPEC,
    VETO,
    WAITING_SPEC,
    bearing,
    belief,
    plan,
    rejected,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import PHASES, Walk, answer, belief_ready, commanded, of_craft, refusal, sent, walk_in

from backend import commands
from backend.craft import effects, inputs
from backend.events import FIRST_CRAFT, CommandRefused, MissionEnded, MissionStarted
from backend.mission.effects import Effect, OfCraft, Reply
from backend.mission.inputs import Commanded, Context, Input, ServerCameBack, ToCraft
from backend.mission.machine import transition
from backend.mission.state import MissionState, fold
from backend.reasons import refusals
from backend.reasons.flight import Ordered, Proceeds
from backend.reasons.search import Localized
from backend.search.effects import Record, SearchElsewhere, UpdateBelief
from backend.search.inputs import BearingsArrived, BeliefReady, Edited, NotStored, PreflightDone, SearchOver
from backend.spec import FIRST_EMITTER

OTHER_CRAFT = "craft-2"


def every_input(state: MissionState) -> list[Input]:
    """At least one of each kind, to the search and to its craft."""
    craft, search = next(iter(state.crafts.values())), state.search
    known = search.measured[0].bearing_id if search.measured else "unknown"
    alerts = [alert.alert_id for owner in (search, craft) for alert in owner.open_alerts] or ["unknown-1"]
    number = len(search.measured) + 1
    orders: tuple[commands.Command, ...] = (
        *ORDERS,
        commands.Hold(craft_id="nobody"),
        commands.ChangeArea(search=OTHER_AREA),
        commands.ExcludeBearing(bearing_id=known),
        commands.AcknowledgeAlert(alert_id=alerts[0]),
    )
    craft_inputs = [one for one in every_craft_input(craft, search) if not isinstance(one, inputs.CraftOrdered)]
    return [
        *(commanded(order, f"every-{i}") for i, order in enumerate(orders)),
        *(commanded(order, f"objected-{i}", Context((VETO,))) for i, order in enumerate(orders)),
        commanded(commands.Resume(), "on-ground", Context(on_ground=True)),
        Edited(WAITING_SPEC),
        PreflightDone((CHECK,)),
        PreflightDone((FAILED_CHECK,)),
        BearingsArrived((bearing(number, source=PERSON, bearing_id=f"p{number}"),)),
        BearingsArrived((bearing(number, source=IMPORT, bearing_id=f"i{number}"),)),
        belief_ready(search),
        belief_ready(search, localized=True),
        BeliefReady(("stale",), belief(1)),
        NotStored("a number is missing"),
        SearchOver(Localized(), "failed"),
        ServerCameBack(),
        ToCraft("nobody", inputs.Landed()),
        *(ToCraft(craft.craft_id, one) for one in craft_inputs),
    ]


def check_rules(before: MissionState, given_: Input, after: MissionState, asked: tuple[Effect, ...]) -> None:
    command = given_.command if isinstance(given_, Commanded) else None
    craft = next(iter(before.crafts.values()))
    moved = [e.effect for e in asked if isinstance(e, OfCraft) and isinstance(e.effect, VEHICLE)]
    if isinstance(command, commands.ForSearch):
        assert not moved, "what is asked of a search moves nothing"
    if craft.taken_over and not isinstance(command, commands.Resume | commands.Start):
        restarted = isinstance(given_, ToCraft) and isinstance(given_.given, inputs.Restarted)
        assert not moved or restarted, "a command went out while the pilot had control"
    if craft.phase in ("hold", "manual") and any(isinstance(e, MOVES) for e in moved):
        ordered = isinstance(command, commands.Resume | commands.Return | commands.Abort)
        told = given_.given if isinstance(given_, ToCraft) else None
        timer = told == inputs.TimerExpired("console_return")
        counted = told == inputs.TimerExpired("battery_return") and craft.counting_down
        lower = isinstance(told, inputs.BatteryLow) and told.stage != "return"
        assert ordered or timer or counted or lower, f"{given_} moved a held vehicle"
    if before.search.outcome is not None:
        assert after.search.outcome == before.search.outcome
        assert after.phase == before.phase
    if command is not None:
        assert answer(asked).command_id in after.answered
        assert sum(isinstance(e, Reply) for e in asked) == 1
        assert (refusal(asked) is None) == after.answered[answer(asked).command_id].accepted
    if isinstance(given_, BearingsArrived) and craft.chosen is not None:
        assert after.crafts[craft.craft_id].chosen == craft.chosen, "a bearing from elsewhere takes no destination"
        assert not moved
    if before.search.stage == "open" and after.search.stage == "ended" and not isinstance(given_, SearchOver):
        assert not any(craft.searching for craft in after.crafts.values())


@pytest.mark.parametrize("phase", PHASES)
def test_every_input_is_answered_in_every_phase(phase: str) -> None:
    start = walk_in(phase).state
    for given_ in every_input(start):
        after, asked = transition(start, given_, 2_000.0)
        check_rules(start, given_, after, asked)
        for again in every_input(after):
            twice, more = transition(after, again, 2_001.0)
            check_rules(after, again, twice, more)


@settings(max_examples=150, deadline=None)
@given(automatic=st.booleans(), picks=st.lists(st.integers(0, 10_000), min_size=5, max_size=60))
def test_on_any_walk_the_rules_hold_and_the_journal_gives_the_state_back(automatic: bool, picks: list[int]) -> None:
    walk = Walk(SPEC if automatic else WAITING_SPEC)
    if picks[0] % 3:
        walk.to("planning")
    ended = 0
    for number, pick in enumerate(picks):
        choices = every_input(walk.state)
        given_ = choices[pick % len(choices)]
        if isinstance(given_, Commanded):
            given_ = Commanded(f"walk-{number}", given_.by, given_.command, given_.contexts, given_.search)
        before = walk.state
        asked = walk.give(given_)
        check_rules(before, given_, walk.state, asked)
        ended += sum(isinstance(e, Record) and isinstance(e.event, MissionEnded) for e in asked)
        assert ended <= 1
    assert fold(walk.recorded) == walk.state


def test_a_localized_mission_goes_from_draft_to_done() -> None:
    walk = Walk()
    walk.command(commands.Start())
    assert walk.state.phase == "taking_off"
    assert UpdateBelief(FIRST_EMITTER) in walk.asked
    walk.to_craft(inputs.AuthorityHeard(OURS))
    walk.to_craft(inputs.InTheAir(HOME, 40.0))
    for number in (1, 2):
        assert of_craft(walk.give(belief_ready(walk.search)))[-1] == effects.PlanNext(number, ())
        assert of_craft(walk.to_craft(inputs.Planned(plan(number))))[-1] == effects.FlyTo(number, plan(number).place)
        assert of_craft(walk.to_craft(inputs.Arrived(HOME, 0.3, 9.0)))[-1] == effects.Measure(number, 1)
        assert UpdateBelief(FIRST_EMITTER) in walk.to_craft(inputs.SweepTaken((bearing(number),)))
    localized_at = walk.at_s + 1
    assert of_craft(walk.give(belief_ready(walk.search, localized=True)))[-1] == effects.ReturnHome()
    walk.to_craft(inputs.HomeReached())
    assert walk.state.phase == "landing"
    walk.to_craft(inputs.Landed())
    assert (walk.state.phase, walk.search.outcome, walk.state.engaged) == ("done", "localized", ())
    (ended,) = walk.of_kind(MissionEnded)
    started = next(r for r in walk.recorded if isinstance(r.event, MissionStarted)).at_utc.timestamp()
    assert ended.mission_time_s == localized_at - started


def test_a_repeated_command_gets_the_first_answer_and_does_nothing() -> None:
    walk = Walk().to("flying")
    first = walk.give(commanded(commands.Hold(), "same"))
    recorded = len(walk.recorded)
    assert walk.give(commanded(commands.Hold(), "same")) == (answer(first),)
    refused = walk.give(commanded(commands.Accept(), "no"))
    assert refusal(refused) == refusals.NoProposedPlace()
    assert walk.give(commanded(commands.Accept(), "no")) == (answer(refused),)
    assert len(walk.recorded) == recorded + 1
    assert fold(walk.recorded).answered == walk.state.answered


def test_every_refusal_is_a_fact() -> None:
    walk = Walk()
    walk.command(commands.Hold())
    (refused,) = walk.of_kind(CommandRefused)
    assert (refused.reason, refused.by, refused.command) == (refusals.NotStarted(), "anna", "hold")


def test_an_excluded_bearing_is_taken_out_of_the_belief_without_moving_the_vehicle() -> None:
    walk = Walk().to("measuring")
    walk.to_craft(inputs.SweepTaken((bearing(1),)))
    walk.command(commands.Hold())
    walk.believe()
    asked = walk.command(commands.ExcludeBearing(bearing_id="b1"))
    assert UpdateBelief(FIRST_EMITTER) in asked
    assert sent(asked) == []
    assert walk.search.emitters[FIRST_EMITTER].bearing_ids == ()


def test_only_an_open_alert_is_acknowledged_whoever_raised_it() -> None:
    walk = Walk().to("measuring")
    walk.give(NotStored("a number is missing"))
    walk.to_craft(inputs.LinkDown("receiver", NOT_YET))
    for alert in (*walk.search.open_alerts, *walk.craft.open_alerts):
        assert refusal(walk.command(commands.AcknowledgeAlert(alert_id=alert.alert_id))) is None
    assert refusal(walk.command(commands.AcknowledgeAlert(alert_id="battery-9"))) == refusals.NoSuchAlert()


@pytest.mark.parametrize("phase", PHASES)
def test_the_area_changes_in_hold_only_and_moves_nothing(phase: str) -> None:
    walk = walk_in(phase)
    before = walk.search.spec
    asked = walk.command(commands.ChangeArea(search=OTHER_AREA))
    assert sent(asked) == []
    if phase == "hold":
        assert refusal(asked) is None
        assert asked.count(UpdateBelief(FIRST_EMITTER)) == 1
        assert SearchElsewhere() in asked
        assert walk.search.spec == SPEC.searching(OTHER_AREA)
    else:
        assert refusal(asked) is not None
        assert walk.search.spec == before
    assert walk.state.phase == walk_in(phase).state.phase


def test_bearings_count_on_in_another_area_and_what_was_planned_for_the_old_is_void() -> None:
    walk = Walk().to("measuring")
    walk.to_craft(inputs.SweepTaken((bearing(1),)))
    walk.believe()
    walk.to_craft(inputs.Planned(plan(2)))
    walk.command(commands.SetAutomatic(automatic=False))
    walk.command(commands.Hold())
    walk.command(commands.ChangeArea(search=OTHER_AREA))
    assert walk.search.emitters[FIRST_EMITTER].bearing_ids == ("b1",)
    assert (walk.craft.chosen, walk.search.beliefs_current, walk.craft.automatic) == (None, False, False)
    walk.believe()
    assert of_craft(walk.command(commands.Resume()))[-1] == effects.PlanNext(3, ())
    assert fold(walk.recorded) == walk.state


def test_objections_refuse_another_area() -> None:
    walk = Walk().to("hold")
    asked = walk.command(commands.ChangeArea(search=OTHER_AREA), Context((VETO,)))
    assert refusal(asked) == VETO
    assert walk.search.spec == SPEC
    (refused,) = walk.of_kind(CommandRefused)
    assert refused.reason == VETO


@pytest.mark.parametrize("source", [PERSON, IMPORT])
def test_a_bearing_from_elsewhere_changes_the_belief_and_leaves_the_craft_its_place(source: object) -> None:
    for phase in ("flying", "measuring", "waiting"):
        walk = Walk(WAITING_SPEC if phase == "waiting" else SPEC).to(phase)
        if phase == "measuring":
            walk.arrive()
        chosen = walk.craft.chosen
        assert chosen is not None
        asked = walk.give(BearingsArrived((bearing(9, source=source, bearing_id="p"),)))  # type: ignore[arg-type]
        assert [effect for effect in asked if not isinstance(effect, Record)] == [UpdateBelief(FIRST_EMITTER)]
        assert not walk.search.beliefs_current
        assert (walk.craft.phase, walk.craft.chosen) == (phase, chosen)
        assert sent(walk.believe()) == []
        assert (walk.craft.phase, walk.craft.chosen) == (phase, chosen)
        assert walk.search.emitters[FIRST_EMITTER].bearing_ids == ("p",)


def test_a_search_without_a_craft_folds_what_people_and_imports_bring() -> None:
    walk = Walk()
    walk.give(BearingsArrived((bearing(1, source=PERSON),)))
    walk.give(BearingsArrived((bearing(2, source=IMPORT),)))
    walk.believe(localized=True)
    assert walk.search.localized
    assert (walk.state.engaged, walk.state.phase) == ((), "draft")
    assert all(isinstance(effect, Record | UpdateBelief) for effect in walk.asked)
    walk.command(commands.ExcludeBearing(bearing_id="b1"))
    assert not walk.search.localized
    assert fold(walk.recorded) == walk.state
    none = MissionState(search=walk.search, crafts={})
    after, asked = transition(none, BearingsArrived((bearing(3, source=PERSON),)), 2_000.0)
    assert UpdateBelief(FIRST_EMITTER) in asked
    assert len(after.search.measured) == 3
    after, asked = transition(after, commanded(commands.Hold(), "c"), 2_001.0)
    assert isinstance(refusal(asked), refusals.NoSuchCraft)


def test_one_craft_finds_two_emitters_with_the_same_turns_and_comes_home_when_both_are_localized() -> None:
    walk = Walk(TWO_SPEC).to("flying").arrive()
    asked = walk.to_craft(inputs.SweepTaken((bearing(1, bearing_id="a1"), bearing(1, SECOND, bearing_id="b1"))))
    assert {effect for effect in asked if isinstance(effect, UpdateBelief)} == {
        UpdateBelief(FIRST_EMITTER),
        UpdateBelief(SECOND),
    }
    assert of_craft(walk.believe(True, FIRST_EMITTER)) == []
    assert walk.craft.phase == "planning"
    assert of_craft(walk.believe(False, SECOND)) == [effects.PlanNext(2, ())]
    walk.to_craft(inputs.Planned(plan(2)))
    walk.arrive()
    walk.to_craft(inputs.SweepTaken((rejected(1, 2), bearing(2, SECOND, bearing_id="b2"))))
    assert [bearing_.bearing_id for bearing_ in walk.search.measured] == ["a1", "b1", "b2"]
    assert sent(walk.believe(True, SECOND)) == [effects.ReturnHome()]
    walk.to_craft(inputs.Landed())
    assert walk.search.outcome == "localized"
    assert fold(walk.recorded) == walk.state


def test_a_restart_brings_the_same_search_back_with_its_beliefs_to_be_folded_again() -> None:
    walk = Walk(TWO_SPEC).to("flying")
    asked = walk.give(ServerCameBack())
    assert [effect for effect in asked if isinstance(effect, UpdateBelief)] == [
        UpdateBelief(FIRST_EMITTER),
        UpdateBelief(SECOND),
    ]
    assert sent(walk.to_craft(inputs.Restarted(OURS))) == [effects.HoldVehicle()]
    walk.believe()
    assert walk.craft.phase == "hold"
    assert sent(walk.command(commands.Resume())) != []
    assert Walk().give(ServerCameBack()) == (), "a draft was not in the air"


def test_after_an_abort_and_a_restart_the_craft_is_held_and_brought_home() -> None:
    walk = Walk().to("aborted")
    walk.state = fold(walk.recorded)
    walk.give(ServerCameBack())
    walk.to_craft(inputs.Restarted(OURS))
    assert (walk.state.phase, walk.craft.phase) == ("aborted", "hold")
    assert sent(walk.command(commands.Hold())) == [effects.HoldVehicle()]
    assert refusal(walk.command(commands.Resume())) == refusals.MissionOver()
    assert sent(walk.command(commands.Return())) == [effects.ReturnHome()]
    walk.to_craft(inputs.Landed())
    assert walk.state.engaged == ()


# Two craft


def two_craft() -> Walk:
    """Both in the air for one search, the first on its way to a place."""
    walk = Walk().start(FIRST_CRAFT)
    walk.start(OTHER_CRAFT)
    return walk.fly(FIRST_CRAFT)


def phases(walk: Walk) -> dict[str, str]:
    return {craft.craft_id: craft.phase for craft in walk.state.crafts.values()}


def test_two_craft_of_one_search_keep_their_own_phase_place_and_authority() -> None:
    walk = two_craft()
    assert phases(walk) == {FIRST_CRAFT: "flying", OTHER_CRAFT: "planning"}
    walk.fly(OTHER_CRAFT)
    first, other = (walk.state.crafts[name] for name in (FIRST_CRAFT, OTHER_CRAFT))
    assert (first.place_number, other.place_number, walk.search.place_number) == (1, 2, 2)
    assert first.chosen != other.chosen
    walk.arrive(FIRST_CRAFT)
    walk.to_craft(inputs.AuthorityHeard(GIVEN_BACK), OTHER_CRAFT)
    assert phases(walk) == {FIRST_CRAFT: "measuring", OTHER_CRAFT: "manual"}
    assert [walk.state.crafts[name].taken_over for name in (FIRST_CRAFT, OTHER_CRAFT)] == [False, True]
    assert walk.of_kind(MissionStarted)[1].craft_id == OTHER_CRAFT
    assert walk.search.home == START.home
    assert fold(walk.recorded) == walk.state


def test_what_one_craft_measures_the_other_takes_into_its_plans() -> None:
    walk = two_craft().fly(OTHER_CRAFT)
    walk.arrive(FIRST_CRAFT)
    chosen = walk.state.crafts[OTHER_CRAFT].chosen
    walk.to_craft(inputs.SweepTaken((bearing(1),)))
    assert walk.state.crafts[OTHER_CRAFT].chosen == chosen, "it keeps its place"
    asked = walk.believe()
    assert of_craft(asked, FIRST_CRAFT) == [effects.PlanNext(3, ())]
    assert of_craft(asked, OTHER_CRAFT) == []
    walk.give(BearingsArrived((bearing(9, source=PERSON, bearing_id="p"),)))
    asked = walk.believe(localized=True)
    for name in (FIRST_CRAFT, OTHER_CRAFT):
        assert sent(asked, name) == [effects.ReturnHome()]


def test_the_search_ends_when_the_last_craft_is_down() -> None:
    walk = two_craft().fly(OTHER_CRAFT)
    for name in (FIRST_CRAFT, OTHER_CRAFT):
        assert sent(walk.command(commands.Return(craft_id=name)), name) == [effects.ReturnHome()]
        walk.to_craft(inputs.HomeReached(), name)
        assert walk.search.stage == "open"
        walk.to_craft(inputs.Landed(), name)
    assert (walk.state.phase, walk.search.outcome, walk.state.engaged) == ("done", "not_localized", ())
    assert len(walk.of_kind(MissionEnded)) == 1


def test_an_abort_of_one_craft_leaves_the_other_searching_and_of_both_ends_the_search() -> None:
    walk = two_craft().fly(OTHER_CRAFT)
    asked = walk.command(commands.Abort(craft_id=FIRST_CRAFT))
    assert sent(asked, FIRST_CRAFT) == [effects.ReturnHome(hold_first=True)]
    assert sent(asked, OTHER_CRAFT) == []
    assert walk.search.stage == "open"
    assert phases(walk) == {FIRST_CRAFT: "returning", OTHER_CRAFT: "flying"}
    walk.to_craft(inputs.Landed(), FIRST_CRAFT)
    assert walk.search.stage == "open"
    walk.command(commands.Abort(craft_id=OTHER_CRAFT))
    assert walk.search.outcome == "aborted"
    assert [craft.craft_id for craft in walk.state.engaged] == [OTHER_CRAFT]


@pytest.mark.parametrize(
    ("command", "wanted"),
    [
        (commands.Hold(), effects.HoldVehicle()),
        (commands.Return(), effects.ReturnHome()),
        (commands.Abort(), effects.ReturnHome(hold_first=True)),
    ],
)
def test_hold_return_and_abort_without_a_name_are_for_every_craft(command: commands.ForCraft, wanted: object) -> None:
    walk = two_craft().fly(OTHER_CRAFT)
    asked = walk.command(command)
    assert refusal(asked) is None
    for name in (FIRST_CRAFT, OTHER_CRAFT):
        assert sent(asked, name) == [wanted]
    if isinstance(command, commands.Abort):
        assert walk.search.outcome == "aborted"
        assert len(walk.of_kind(MissionEnded)) == 1


def test_one_of_two_craft_that_a_pilot_flies_does_not_keep_the_other_from_being_held() -> None:
    walk = two_craft().fly(OTHER_CRAFT)
    walk.to_craft(inputs.AuthorityHeard(GIVEN_BACK), FIRST_CRAFT)
    asked = walk.command(commands.Hold())
    assert refusal(asked) is None
    assert (sent(asked, FIRST_CRAFT), sent(asked, OTHER_CRAFT)) == ([], [effects.HoldVehicle()])


def test_an_order_for_one_of_several_craft_must_name_it() -> None:
    walk = two_craft()
    for command in (commands.Resume(), commands.Override(place=HOME), commands.Accept(), commands.Veto()):
        assert isinstance(refusal(walk.command(command)), refusals.NoSuchCraft)
    assert refusal(walk.command(commands.Hold(craft_id="craft-3"))) == refusals.NoSuchCraft("craft-3")
    assert refusal(walk.command(commands.Override(craft_id=FIRST_CRAFT, place=HOME))) is None


def test_the_area_changes_only_when_every_craft_is_held() -> None:
    walk = two_craft()
    walk.command(commands.Hold(craft_id=FIRST_CRAFT))
    change = commands.ChangeArea(search=OTHER_AREA)
    assert refusal(walk.command(change)) == refusals.AreaOnlyInHold()
    walk.command(commands.Hold(craft_id=OTHER_CRAFT))
    assert refusal(walk.command(change)) is None


def test_why_a_craft_is_in_its_phase_is_its_own() -> None:
    walk = two_craft()
    walk.command(commands.Hold(craft_id=FIRST_CRAFT))
    first, other = (walk.state.crafts[name] for name in (FIRST_CRAFT, OTHER_CRAFT))
    assert first.phase_reason == Ordered("hold", "anna")
    assert other.phase_reason == Proceeds("climb")
