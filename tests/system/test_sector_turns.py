"""A mission that turns only as far as it needs, over real sockets, on both simulated autopilots."""

from __future__ import annotations

import math

import pytest
from console import Console

from backend.cli.running import RunningServer
from backend.simulation.emitters import Signal
from hardware.frame import LocalFrame
from hardware.readings import Place

pytestmark = pytest.mark.system


@pytest.mark.parametrize("flavour", ["px4", pytest.param("ardupilot", marks=pytest.mark.long)])
async def test_a_mission_is_localized_with_turns_only_as_far_as_needed(
    server: RunningServer, operator: Console
) -> None:
    await operator.draft(
        sensor={"sector_turns": True, "bearing_errors": "joint"},
        localization={"minimum_places": 3},
        planner={"seed": 3},
    )
    await operator.ready()
    await operator.watch()
    await operator.start()
    ended = await operator.until_event("mission_ended", wall_s=120)
    await operator.until_phase("ground")
    assert ended["outcome"] == "localized", operator.story()
    last = operator.of("belief_updated")[-1]["event"]
    assert server.receiver is not None
    truth = server.receiver.truth[Signal(868.3e6)]
    error = math.hypot(*LocalFrame(truth).to_enu(Place(last["estimate"]["lat"], last["estimate"]["lon"])))
    assert error < 4 * last["estimate"]["expected_rmse_m"]

    turns = [b["event"]["turn"] for b in operator.of("bearing_measured")]
    first = operator.of("bearing_measured")[0]
    rejected = [one for one in operator.of("sweep_rejected") if one["seq"] < first["seq"]]
    again = any(one["event"]["place_number"] == first["event"]["place_number"] for one in rejected)
    assert turns[0]["planned_because"] == {"because": "again" if again else "first", "code": "whole_turn"}
    assert turns[0]["turned_deg"] == 360.0
    sectors = [turn for turn in turns[1:] if turn["planned_because"]["code"] == "sector_expected"]
    assert sectors, "no sector was turned"
    assert min(turn["turned_deg"] for turn in sectors) < 300.0
    for turn in sectors:
        asked = turn["planned_deg"] + sum(why["by_deg"] for why in turn["went_on_because"])
        assert turn["turned_deg"] == pytest.approx(asked, abs=15.0)
        assert turn["stopped_because"]["code"] in ("maximum_seen", "whole_circle_seen")
    shown = [p["sector"] for p in operator.messages["sweep_progress"] if p["sector"] is not None]
    assert any(sector["because"]["code"] == "sector_expected" for sector in shown)
