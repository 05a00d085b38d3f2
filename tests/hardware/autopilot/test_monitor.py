"""What is heard of a vehicle, message by message."""

from __future__ import annotations

import time

import pytest
from paper import IN_AIR, ON_GROUND, PLACE, POSCTL, Scene, heartbeat

from hardware.authority import Authority, CommandSent
from hardware.autopilot import monitor
from hardware.autopilot.ardupilot import BRAKE, GUIDED, LAND
from hardware.autopilot.messages import HEARTBEAT_ID, SET_MESSAGE_INTERVAL
from hardware.autopilot.monitor import AFTER_SILENCE_S, LINK_LOST_WALL_S, STREAMS
from hardware.autopilot.px4 import HOLD, LANDING, RETURNING
from hardware.autopilot.silence import Silence


@pytest.fixture
async def returning(flying: Scene) -> Scene:
    """By our order."""
    flying.monitor.control.see(CommandSent(frozenset({RETURNING})))
    flying.mode(RETURNING)
    assert flying.monitor.telemetry().authority.who == "ours"
    return flying


@pytest.mark.parametrize(("mode", "who"), [(POSCTL, "pilot"), (RETURNING, "pilot"), (HOLD, "nobody")])
async def test_who_has_control_is_known_when_connecting_is_done_though_the_mode_came_before_all_else(
    mode: int, who: str
) -> None:
    """An order given at once would take the vehicle from a pilot."""
    scene = Scene(heartbeat(mode, True), ("GLOBAL_POSITION_INT", PLACE))
    await scene.monitor.connect(1.0)
    assert scene.monitor.telemetry().authority.who == who
    await scene.monitor.close()


async def test_a_vehicle_that_landed_unheard_is_judged_by_what_it_says_now_and_no_pilot_landed_it(
    returning: Scene,
) -> None:
    returning.silence(2 * LINK_LOST_WALL_S)
    assert not returning.monitor.connected
    returning.mode(HOLD)
    returning.monitor.look_at_link(0.1)
    assert not returning.monitor.connected
    assert returning.monitor.telemetry().authority.who == "ours"
    returning.heartbeat(HOLD, armed=False)
    returning.monitor.look_at_link(0.1)
    telemetry = returning.monitor.telemetry()
    assert telemetry.connected
    assert telemetry.authority.who == "nobody"
    assert telemetry.in_air is False


async def test_a_pilot_who_took_over_unheard_has_control_with_the_first_report_of_their_mode(returning: Scene) -> None:
    returning.silence(2 * LINK_LOST_WALL_S)
    returning.mode(POSCTL)
    assert returning.monitor.telemetry().authority.who == "pilot"


async def test_a_hold_chosen_unheard_in_the_air_is_a_pilots_once_the_vehicle_says_that_it_flies(
    returning: Scene,
) -> None:
    returning.silence(2 * LINK_LOST_WALL_S)
    returning.heartbeat(HOLD, armed=True)
    returning.monitor.look_at_link(0.1)
    assert returning.monitor.telemetry().connected
    assert returning.monitor.telemetry().authority.who == "pilot"


async def test_a_silence_in_which_it_took_off_leaves_no_old_word_of_the_ground(returning: Scene) -> None:
    returning.landed(ON_GROUND)
    returning.silence(2 * LINK_LOST_WALL_S)
    returning.heartbeat(RETURNING, armed=True)
    returning.hear("GLOBAL_POSITION_INT", PLACE | {"time_boot_ms": 9000})
    returning.monitor.look_at_link(0.1)
    assert returning.monitor.telemetry().in_air


def heard_again(scene: Scene, mode: int) -> None:
    scene.silence(2 * LINK_LOST_WALL_S)
    scene.heartbeat(mode, armed=True)
    scene.monitor.look_at_link(0.1)
    assert scene.monitor.connected


@pytest.fixture
async def holding(flying: Scene) -> Scene:
    """By our command."""
    flying.monitor.control.see(CommandSent(frozenset({HOLD})))
    flying.mode(HOLD)
    return flying


async def test_a_return_found_after_a_silence_is_the_failsafes(holding: Scene) -> None:
    heard_again(holding, RETURNING)
    assert holding.monitor.telemetry().authority.who == "failsafe"


async def test_a_return_begun_soon_after_a_silence_is_the_failsafes_a_later_one_may_be_the_pilots(
    holding: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(monitor, "AFTER_SILENCE_WALL_S", 0.0)
    heard_again(holding, HOLD)
    assert holding.monitor.telemetry().authority.who == "ours"
    before = holding.monitor.control.authority
    holding.mode(RETURNING)
    assert holding.monitor.telemetry().authority.who == "failsafe"
    holding.monitor.control.authority = before
    holding.clock.at += AFTER_SILENCE_S
    holding.mode(RETURNING)
    authority = holding.monitor.telemetry().authority
    assert (authority.who, authority.perhaps_failsafe) == ("pilot", True)


async def test_a_return_that_waited_to_be_read_while_the_server_was_being_loaded_is_the_failsafes(
    holding: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What loads a server stops its loop: for a minute on a busy machine, longer than the failsafe takes to act."""
    now_s = time.monotonic()
    monkeypatch.setattr(time, "monotonic", lambda: now_s)
    holding.monitor.restore(holding.monitor.control.authority)
    holding.mode(HOLD)
    now_s += 60.0
    holding.clock.at += 60.0
    holding.mode(RETURNING)
    assert holding.monitor.telemetry().authority.who == "failsafe"


RETURNS_UNHEARD_TRANSMITTER = [0, 0, 4, 3, 6, 1, *(0,) * 34]


async def test_a_return_that_px4_explains_by_an_event_is_the_failsafes(holding: Scene) -> None:
    holding.mode(RETURNING)
    assert holding.monitor.telemetry().authority.who == "pilot"
    holding.hear("EVENT", {"id": 0x0194CA8A, "arguments": RETURNS_UNHEARD_TRANSMITTER})
    authority = holding.monitor.telemetry().authority
    assert (authority.who, authority.cause) == ("failsafe", "transmitter")


async def test_an_event_that_another_station_asked_for_again_names_no_failsafe(holding: Scene) -> None:
    event = {"id": 0x0194CA8A, "arguments": RETURNS_UNHEARD_TRANSMITTER, "sequence": 17, "event_time_boot_ms": 1000}
    holding.hear("EVENT", event)
    holding.clock.at += 20.0
    holding.hear("EVENT", event)
    holding.mode(RETURNING)
    assert holding.monitor.telemetry().authority.who == "pilot"


async def test_a_return_that_px4_announced_is_the_failsafes_until_its_state_tells_of_a_pilot(holding: Scene) -> None:
    for text in ("Critical battery\t", "Failsafe activated: entering Hold for 5 seconds\t"):
        holding.hear("STATUSTEXT", {"severity": 2, "text": text})
    assert holding.monitor.telemetry().authority.who == "ours"
    holding.clock.at += 5.0
    holding.hear("STATUSTEXT", {"severity": 2, "text": "Failsafe activated\t"})
    holding.mode(RETURNING)
    authority = holding.monitor.telemetry().authority
    assert (authority.who, authority.cause) == ("failsafe", "battery")
    name, fields = heartbeat(RETURNING, True)
    holding.hear(name, fields | {"system_status": 5})
    assert holding.monitor.telemetry().authority.who == "failsafe"
    holding.hear(name, fields | {"system_status": 4})
    assert holding.monitor.telemetry().authority.who == "pilot"


@pytest.mark.parametrize(("tells_current_mode", "who"), [(False, "pilot"), (True, "failsafe")])
async def test_a_px4_before_1_15_is_critical_while_it_only_warns_so_that_its_state_names_no_failsafe(
    tells_current_mode: bool, who: str
) -> None:
    """A pilot who selects RETURN because of the warning. It knows no CURRENT_MODE either."""
    scene = Scene(
        heartbeat(HOLD, True), ("EXTENDED_SYS_STATE", {"landed_state": IN_AIR}), ("GLOBAL_POSITION_INT", PLACE)
    )
    await scene.monitor.connect(1.0)
    await scene.monitor.close()
    scene.monitor.connected = True
    scene.monitor.control.see(CommandSent(frozenset({HOLD})))
    scene.heartbeat(HOLD, armed=True)
    if tells_current_mode:
        scene.mode(HOLD)
    name, fields = heartbeat(RETURNING, True)
    scene.hear(name, fields | {"system_status": 5})
    authority = scene.monitor.telemetry().authority
    assert (authority.who, authority.perhaps_failsafe) == (who, who == "pilot")
    scene.hear(name, fields | {"system_status": 4})
    assert scene.monitor.telemetry().authority.who == "pilot"
    assert not scene.monitor.telemetry().authority.perhaps_failsafe


async def test_a_vehicle_that_was_listened_to_for_long_enough_returns_for_its_pilot(
    holding: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    now_s = time.monotonic()
    monkeypatch.setattr(time, "monotonic", lambda: now_s)
    holding.monitor.restore(holding.monitor.control.authority)
    holding.mode(HOLD)
    for _ in range(int(AFTER_SILENCE_S / 0.1) + 1):
        now_s += 0.1
        holding.clock.at += 0.1
        holding.mode(HOLD)
        holding.monitor.look_at_link(0.1)
    holding.monitor.control.see(CommandSent(frozenset({HOLD})))
    holding.mode(RETURNING)
    assert holding.monitor.telemetry().authority.who == "pilot"


@pytest.mark.parametrize(
    ("patience_s", "unanswered_s", "who"),
    [
        (None, 0.8, "pilot"),
        (None, 1.5, "failsafe"),
        (5.0, 2.3, "pilot"),
        (5.0, 4.0, "failsafe"),
        (10.0, 4.8, "pilot"),
        (10.0, 17.0, "failsafe"),
        (10.0, 60.0, "pilot"),
    ],
)
async def test_a_vehicle_that_is_heard_acts_on_hearing_nothing_when_its_patience_may_be_gone_and_not_long_after(
    patience_s: float | None, unanswered_s: float, who: str, holding: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A link that loses much leaves gaps of a second, too, and a pilot's return would be taken from them."""
    now_s = time.monotonic()
    monkeypatch.setattr(time, "monotonic", lambda: now_s)
    holding.monitor.patience_s = patience_s
    holding.monitor.timesync.unanswered = Silence()
    for _ in range(round(unanswered_s / 0.1)):
        now_s += 0.1
        holding.clock.at += 0.1
        holding.mode(HOLD)
        holding.monitor.look_at_link(0.1)
    holding.mode(RETURNING)
    authority = holding.monitor.telemetry().authority
    assert (authority.who, authority.perhaps_failsafe) == (who, who == "pilot")


async def test_the_autopilots_report_of_the_sticks_is_a_takeover_before_its_mode_shows_one(holding: Scene) -> None:
    holding.hear("STATUSTEXT", {"severity": 6, "text": "Pilot took over using sticks\x00"})
    authority = holding.monitor.telemetry().authority
    assert (authority.who, authority.taken_by) == ("pilot", "sticks")


@pytest.mark.parametrize("early", [True, False], ids=["before connecting", "after connecting"])
@pytest.mark.parametrize(
    ("mode", "who"), [(POSCTL, "pilot"), (RETURNING, "failsafe"), (LANDING, "ours"), (HOLD, "nobody")]
)
async def test_a_new_server_goes_on_from_who_flew_before(mode: int, who: str, early: bool) -> None:
    """We had commanded the landing. What waits was commanded by nobody that is remembered."""
    before = Authority(who="ours", commanded=(LANDING,), heard=LANDING, kind="land", armed=True)
    scene = Scene(heartbeat(mode, True), ("GLOBAL_POSITION_INT", PLACE))
    if early:
        scene.monitor.restore(before)
    await scene.monitor.connect(1.0)
    if not early:
        scene.monitor.restore(before)
    assert scene.monitor.telemetry().authority.who == who
    await scene.monitor.close()


async def test_connecting_asks_for_the_heartbeat_and_waits_for_no_answer_to_the_rates() -> None:
    """Each answer takes both ways of the link, and a vehicle that was left in flight is not held before."""
    scene = Scene(("EXTENDED_SYS_STATE", {"landed_state": IN_AIR}), ("GLOBAL_POSITION_INT", PLACE))
    scene.link.answers = False
    scene.link.requested[HEARTBEAT_ID] = heartbeat(HOLD, True)

    await scene.monitor.connect(1.0)
    telemetry, sent = scene.monitor.telemetry(), list(scene.link.sent)
    await scene.monitor.close()

    assert (telemetry.mode, telemetry.armed, telemetry.authority.who) == ("HOLD", True, "nobody")
    assert sent.count(SET_MESSAGE_INTERVAL) == len(STREAMS) + 1


async def test_an_arducopter_that_is_stopped_while_it_lands_for_its_position_is_a_pilots() -> None:
    def beat(mode: int) -> tuple[str, dict[str, int]]:
        return "HEARTBEAT", {"custom_mode": mode, "base_mode": 1 | 128, "autopilot": 3, "system_status": 5}

    scene = Scene(beat(GUIDED), ("EXTENDED_SYS_STATE", {"landed_state": IN_AIR}), ("GLOBAL_POSITION_INT", PLACE))
    await scene.monitor.connect(1.0)
    await scene.monitor.close()
    scene.monitor.connected = True
    scene.monitor.control.see(CommandSent(frozenset({GUIDED})))
    scene.hear("STATUSTEXT", {"severity": 2, "text": "EKF Failsafe: changed to LAND Mode", "id": 0, "chunk_seq": 0})
    scene.hear(*beat(LAND))
    assert scene.monitor.telemetry().authority.cause == "position"
    scene.clock.at += 10.0
    scene.hear(*beat(BRAKE))
    assert scene.monitor.telemetry().authority.who == "pilot"
