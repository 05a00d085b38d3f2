"""What the console is told once a second beside the facts: what goes on, and what it waits for."""

from __future__ import annotations

from backend.mission.describe import doing, waits_for
from backend.mission.equipment import Equipment
from backend.mission.ports import Status
from backend.mission.runner import Runner
from backend.mission.safety import battery_to_return_percent


def status_of(runner: Runner | None, equipment: Equipment) -> Status:
    """runner None: no mission is flying."""
    if runner is None:
        detail = "no mission is flying" if equipment.vehicle.telemetry().connected else "no vehicle is connected"
        return Status(None, None, detail, None, "off", None, None, None, equipment.database())
    state, last = runner.state, runner.listening.last
    situation = runner.watch.situation()
    position = situation.telemetry.position
    needed = None
    if position is not None:
        needed = battery_to_return_percent(runner.task.limits, position, situation.drain_percent_s)
    return Status(
        mission_id=runner.mission_id,
        phase=state.phase,
        doing=doing(state),
        waits_for=waits_for(state),
        receiver=runner.listening.state,
        receiver_power_db=None if last is None else last.power_db,
        receiver_age_s=runner.listening.age_s,
        battery_to_return_percent=needed,
        database="lost" if runner.outbox.failing else equipment.database(),
    )
