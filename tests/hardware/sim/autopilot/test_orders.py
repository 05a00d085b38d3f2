from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from hardware.sim.autopilot.firmware import Conditions
from hardware.sim.autopilot.geodesy import HomeFrame
from hardware.sim.autopilot.orders import Orders
from hardware.sim.autopilot.px4 import Px4


@pytest.fixture
def firmware() -> Px4:
    return Px4(Conditions(home=HomeFrame(47.4, 8.5, 488.0)))


def give(firmware: Px4, **order: Any) -> dict[str, Any]:
    return json.loads(Orders(firmware).receive(json.dumps(order).encode()))


def test_the_pilot_switches_modes_and_gives_back(firmware: Px4) -> None:
    assert give(firmware, do="pilot_mode")["mode"] == "POSCTL"
    assert give(firmware, do="pilot_mode", mode="RETURN")["mode"] == "RETURN"
    assert give(firmware, do="give_back")["mode"] == "HOLD"


def test_conditions_change_as_ordered(firmware: Px4) -> None:
    give(firmware, do="battery", percent=15)
    give(firmware, do="heading_error", degrees=12)
    give(firmware, do="set_param", name="NAV_DLL_ACT", value=0)
    give(firmware, do="fault", kind="ignore_yaw", count=3)
    give(firmware, do="gps_jump", north_m=30, seconds=5)
    give(firmware, do="link_loss", seconds=8)
    give(firmware, do="uplink_loss", seconds=9)
    give(firmware, do="prearm", ok=False)

    assert firmware.copter.battery_percent == pytest.approx(15.0)
    assert firmware.navigation.heading_error == 12.0
    assert firmware.parameters["NAV_DLL_ACT"] == 0
    assert firmware.faults.ignore_yaw == 3
    assert firmware.navigation.error[0] == pytest.approx(30.0, abs=1.0)
    assert firmware.faults.link_lost_until == pytest.approx(8.0)
    assert firmware.faults.uplink_lost_until == pytest.approx(9.0)
    firmware.time = 60.0
    assert not firmware.prearm_ok


@pytest.mark.parametrize(
    ("order", "says"),
    [
        ({"do": "fly_to_the_moon"}, "no order"),
        ({}, "no order"),
        ({"do": "battery"}, 'needs a number "percent"'),
        ({"do": "battery", "percent": "full"}, 'needs a number "percent"'),
        ({"do": "link_loss", "seconds": True}, 'needs a number "seconds"'),
        ({"do": "set_param", "name": "NO_SUCH", "value": 1}, "has no parameter NO_SUCH"),
        ({"do": "pilot_mode", "mode": "GUIDED"}, "has no mode GUIDED"),
        ({"do": "fault", "kind": "gremlin"}, "no fault 'gremlin'"),
    ],
)
def test_a_wrong_order_is_answered_with_what_is_wrong(firmware: Px4, order: dict[str, Any], says: str) -> None:
    answer = give(firmware, **order)

    assert answer["ok"] is False
    assert says in answer["error"]


@example(b"[" * 4000)
@given(
    st.one_of(
        st.binary(max_size=60),
        st.recursive(st.none() | st.integers() | st.text(), st.lists).map(json.dumps).map(str.encode),
    )
)
def test_no_line_brings_it_down(line: bytes) -> None:
    answer = json.loads(Orders(Px4(Conditions(home=HomeFrame(47.4, 8.5, 488.0)))).receive(line))

    assert answer["ok"] is False
    assert answer["error"]
