"""The mission room's front door: missions are drafted, edited, checked, commanded, and brought back after a restart.

One mission flies at a time. Commands are idempotent by their id, across restarts too: the answers are facts.
"""

from __future__ import annotations

import asyncio
import logging
from uuid import uuid4

from backend import commands
from backend.commands import CommandReply, CommandRequest
from backend.events import AntennaChecked, Event, MissionDrafted, PreflightChecked, Recorded
from backend.mission import effects, inputs
from backend.mission.antenna import antenna_fact
from backend.mission.antenna_check import check_by_hand
from backend.mission.area import centre_of, corner_of
from backend.mission.checklist import checklist, home_of
from backend.mission.elsewhere import Outlook, outlook, task_or_veto
from backend.mission.equipment import Equipment
from backend.mission.errors import MissionConflict, MissionInputError, MissionNotFound
from backend.mission.forecast import Forecast, Preview, forecast, preview
from backend.mission.importing import Upload, import_facts, imported_before
from backend.mission.localization import Localization, localization
from backend.mission.machine import transition
from backend.mission.patient_vehicle import MendsFailsafes, PatientVehicle
from backend.mission.planning import lay_out_ways
from backend.mission.ports import Status
from backend.mission.runner import Runner
from backend.mission.safety import Veto, resume_vetoes
from backend.mission.state import GROUND, TERMINAL, MissionState, fold
from backend.mission.status import status_of
from backend.mission.watch import GOING_HOME
from backend.spec import MissionSpec, Place, SearchArea
from hardware.ports import VehicleUnreachable
from hardware.readings import Telemetry
from planner.types import PlannerError

log = logging.getLogger("crossfix.mission")

TELEMETRY_S = 0.1
TICKS_A_STATUS = 10
CONNECT_AT_START_S = 3.0
EDITED_IN_FLIGHT = "in hold, change its search area; or draft a new mission"


class MissionService:
    """Lives on one event loop from `start_up` to `shut_down`."""

    def __init__(self, equipment: Equipment) -> None:
        self._equipment = equipment
        self._runner: Runner | None = None
        self._locks: dict[str, asyncio.Lock] = {}
        self._one_start = asyncio.Lock()
        self._tasks: list[asyncio.Task[None]] = []

    # Life

    async def start_up(self) -> None:
        """Connect the vehicle (goes on in the background) and bring an unfinished mission back into HOLD."""
        try:
            await self._equipment.vehicle.connect(CONNECT_AT_START_S)
        except VehicleUnreachable as error:
            log.warning("%s", error)
        unfinished = await self._equipment.journal.unfinished()
        for mission_id in unfinished[:-1]:
            await self._close_interrupted(mission_id, "a mission started later is the one in the air")
        if unfinished:
            await self._recover(unfinished[-1])
        self._tasks = [asyncio.create_task(self._show())]

    async def _recover(self, mission_id: str) -> None:
        state, last_seq = await self._load(mission_id)
        if state.home is None or state.phase in TERMINAL:
            return
        try:
            task = localization(state.mission, state.home, state.home_amsl_m)
        except MissionInputError as error:
            await self._close_interrupted(mission_id, f"it can no longer be read: {error}")
            return
        await asyncio.to_thread(lay_out_ways, task)
        runner = self._runner = Runner(mission_id, state, last_seq, task, self._equipment)
        telemetry = self._equipment.vehicle.telemetry()
        uncommanded = telemetry.controller == "pilot"
        going_home = uncommanded and telemetry.mode in GOING_HOME
        if going_home:
            runner.watch.tolerated_mode = telemetry.mode
        runner.listening.start()
        pilot = uncommanded and not going_home
        runner.give(inputs.Restarted(pilot, going_home, "the server was away and came back"))
        runner.begin()
        self._tasks.append(asyncio.create_task(self._let_go(runner)))
        log.warning("mission %s is back, in %s", mission_id, runner.state.phase)

    async def _close_interrupted(self, mission_id: str, why: str) -> None:
        """There is one vehicle: what it does not fly any more is over, and says so in the list of missions."""
        state, _ = await self._load(mission_id)
        await self._record(mission_id, state, inputs.Interrupted(why))
        log.error("mission %s is closed as interrupted: %s", mission_id, why)

    async def shut_down(self) -> None:
        """Stops watching; the vehicle goes on with what it was told and its own failsafe acts."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        if self._runner is not None:
            await self._runner.close()
            self._runner = None
        await self._equipment.vehicle.close()

    async def _let_go(self, runner: Runner) -> None:
        """When a mission is over and its vehicle down, the next may start."""
        await runner.finished.wait()
        await runner.close()
        if self._runner is runner:
            self._runner = None

    # Missions

    async def create(self, spec: MissionSpec, by: str) -> str:
        """Draft a mission. Raises MissionInputError when the specification makes no sense."""
        await asyncio.to_thread(self._check_spec, spec)
        mission_id = str(uuid4())
        await self._append(mission_id, [MissionDrafted(spec=spec)])
        log.info("mission %s drafted by %s", mission_id, by)
        return mission_id

    async def edit(self, mission_id: str, spec: MissionSpec, by: str) -> None:
        """Raises MissionNotFound, MissionConflict once it has started, MissionInputError."""
        await asyncio.to_thread(self._check_spec, spec)
        async with self._lock(mission_id):
            state, _ = await self._load(mission_id)
            if state.phase not in GROUND:
                raise MissionConflict("the mission has started and can no longer be edited", EDITED_IN_FLIGHT)
            await self._record(mission_id, state, inputs.Edited(spec))
            await self._settle_belief(mission_id)
        log.info("mission %s edited by %s", mission_id, by)

    async def preflight(self, mission_id: str) -> PreflightChecked:
        """Run the checklist and record it. Raises MissionNotFound."""
        async with self._lock(mission_id):
            runner = self._running(mission_id)
            state = runner.state if runner else (await self._load(mission_id))[0]
            listening = None if self._runner is None else self._runner.listening
            checks, _ = await checklist(state.mission, self._equipment, listening, state.antenna)
            given = inputs.PreflightDone(checks)
            if runner:
                runner.give(given)
                await runner.outbox.flushed()
            else:
                await self._record(mission_id, state, given)
        return PreflightChecked(passed=all(c.ok or not c.blocking for c in checks), checks=list(checks))

    async def check_antenna(self, mission_id: str, emitter: Place | float, wait_s: float, by: str) -> AntennaChecked:
        """Turn the vehicle by hand before an emitter at a known place or bearing; the result stays in the checklist.

        Raises MissionNotFound, MissionConflict while anything flies, MissionInputError.
        """
        async with self._one_start:
            if self._runner is not None:
                raise MissionConflict("a mission is flying", "check the antenna when the vehicle is down")
            state, _ = await self._load(mission_id)
            if state.phase not in GROUND:
                raise MissionConflict("the mission has started", "check the antenna of a draft")
            checked = await check_by_hand(self._equipment, state.mission, emitter, wait_s, by)
            async with self._lock(mission_id):
                await self._append(mission_id, [checked])
        return checked

    async def command(self, mission_id: str, request: CommandRequest, by: str) -> CommandReply:
        """Carry out or refuse. The same command id gets the same answer. Raises MissionNotFound."""
        runner = self._running(mission_id)
        if runner is not None and isinstance(request.command, commands.ChangeArea):
            task = await asyncio.to_thread(task_or_veto, runner.state, request.command.search)
            runner = self._running(mission_id)
            if runner is not None:
                asked = runner.change_area(str(request.command_id), by, request.command, task)
                return await self._answered(runner, request, asked)
        if runner is not None:
            return await self._to_runner(runner, request, by)
        async with self._lock(mission_id):
            runner = self._running(mission_id)
            if runner is not None:
                return await self._to_runner(runner, request, by)
            state, last_seq = await self._load(mission_id)
            given = inputs.Commanded(str(request.command_id), by, request.command)
            if isinstance(request.command, commands.Start) and state.phase in GROUND:
                if given.command_id not in state.answered:
                    return await self._start(mission_id, state, last_seq, request, by)
            elif state.phase in TERMINAL:
                given = inputs.Commanded(
                    given.command_id, by, request.command, (Veto("ended", "the mission has ended", "draft a new one"),)
                )
            asked, seq = await self._record(mission_id, state, given)
            return _reply(request, asked, await self._settle_belief(mission_id) or seq or last_seq)

    async def import_recording(self, mission_id: str, upload: Upload, by: str) -> tuple[list[Recorded], bool]:
        """Bring recorded sweeps into a mission that is not flying: its facts about them, and whether they were there
        before. All or nothing. Raises MissionNotFound, MissionConflict, MissionInputError."""
        async with self._lock(mission_id):
            recorded = await self._equipment.journal.read(mission_id)
            if not recorded:
                raise MissionNotFound(mission_id)
            before = imported_before(recorded, upload.recording_id)
            if before:
                return before, True
            state = fold(recorded)
            if self._running(mission_id) is not None or state.phase not in GROUND | TERMINAL:
                raise MissionConflict("the mission is flying", "import the recording when it has ended")
            equipment = self._equipment
            found = await asyncio.to_thread(
                import_facts, mission_id, state, upload, equipment.finder, equipment.pattern, by
            )
            for kept in found.sweeps:
                await equipment.journal.save_sweep(mission_id, kept.sweep_id, kept.place_number, 1, kept.sweep)
            new = await equipment.journal.append(mission_id, found.facts)
            equipment.publisher.events(new)
        log.info("mission %s: %s imported by %s", mission_id, upload.filename, by)
        return new, False

    async def _settle_belief(self, mission_id: str) -> int | None:
        """On the ground nobody folds the belief when imported bearings or the area under them change. The last seq."""
        state, _ = await self._load(mission_id)
        if state.phase not in GROUND or state.belief_current or not state.measured:
            return None
        try:
            task = await asyncio.to_thread(localization, state.mission, corner_of(state.mission.area), 0.0)
            belief, _ = await asyncio.to_thread(task.belief_fact, state.bearings)
        except (MissionInputError, PlannerError) as error:
            log.warning("mission %s: no belief can be made of its bearings: %s", mission_id, error)
            return None
        return await self._append(mission_id, [belief])

    async def _to_runner(self, runner: Runner, request: CommandRequest, by: str) -> CommandReply:
        """At once: what moves or stops the vehicle is under way before the journal is waited for."""
        return await self._answered(runner, request, runner.command(str(request.command_id), by, request.command))

    async def _answered(
        self, runner: Runner, request: CommandRequest, asked: tuple[effects.Effect, ...]
    ) -> CommandReply:
        await runner.outbox.flushed()
        return _reply(request, asked, runner.outbox.last_seq)

    async def _start(
        self, mission_id: str, state: MissionState, last_seq: int, request: CommandRequest, by: str
    ) -> CommandReply:
        async with self._one_start:
            other = self._runner
            objections: tuple[Veto, ...] = ()
            if other is not None:
                detail = f"another mission is still flying ({other.state.mission.name})"
                objections = (Veto("one_mission", detail, "end it and let the vehicle land first"),)
            listening = None if other is None else other.listening
            checks, task = await checklist(state.mission, self._equipment, listening, state.antenna)
            home, home_amsl_m = (None, None) if task is None else (task.home, task.limits.home_amsl_m)
            software, antenna = self._equipment.software, antenna_fact(self._equipment.pattern)
            facts = inputs.StartFacts(() if objections else checks, home, home_amsl_m, software, antenna)
            objections += resume_vetoes(self._equipment.vehicle.telemetry())
            given = inputs.Commanded(str(request.command_id), by, request.command, objections, facts)
            if task is None or objections:
                asked, seq = await self._record(mission_id, state, given)
                return _reply(request, asked, seq or last_seq)
            runner = Runner(mission_id, state, last_seq, task, self._equipment)
            self._runner = runner
            runner.listening.start()
            asked = runner.give(given)
            if runner.state.started_at_s is None:
                self._runner = None
                await runner.close()
            else:
                runner.begin()
                self._tasks.append(asyncio.create_task(self._let_go(runner)))
                await runner.outbox.flushed()
            return _reply(request, asked, runner.outbox.last_seq)

    # What if

    async def expected_time(self, mission_id: str, place: Place) -> Forecast:
        """The expected time to localization when the vehicle measured at this place next. Raises MissionNotFound."""
        runner = self._running(mission_id)
        state = runner.state if runner else (await self._load(mission_id))[0]
        task = runner.task if runner else self._task(state)
        telemetry = self._equipment.vehicle.telemetry()
        situation = runner.watch.situation() if runner else None
        start = self._platform(telemetry, task) if runner else task.place(0.0, 0.0)
        return await asyncio.to_thread(forecast, task, state.bearings, start, place, situation)

    async def outlook(self, mission_id: str, search: SearchArea) -> Outlook:
        """What to expect of another search area now. Raises MissionNotFound, MissionConflict unless the mission flies,
        MissionInputError."""
        runner = self._running(mission_id)
        if runner is None:
            await self._load(mission_id)
            raise MissionConflict("the mission is not flying", "edit the draft, or draft a new mission")
        return await asyncio.to_thread(outlook, runner.state, search, runner.watch.situation(), self._equipment.threads)

    async def preview(self, spec: MissionSpec) -> Preview:
        """Plan the first place of a mission that is not flown yet. Raises MissionInputError, PlannerError."""
        home, home_amsl_m = self._home_for(spec)
        task = await asyncio.to_thread(localization, spec, home, home_amsl_m)
        start = self._platform(self._equipment.vehicle.telemetry(), task)
        return await asyncio.to_thread(preview, task, start, self._equipment.threads)

    def _task(self, state: MissionState) -> Localization:
        if state.home is not None:
            return localization(state.mission, state.home, state.home_amsl_m)
        return localization(state.mission, *self._home_for(state.mission))

    def _home_for(self, spec: MissionSpec) -> tuple[Place, float]:
        home, amsl = home_of(self._equipment.vehicle.telemetry())
        if home is None:
            middle = centre_of(spec.area)
            home = Place(lat=middle.lat_deg, lon=middle.lon_deg)
        return home, amsl or 0.0

    @staticmethod
    def _platform(telemetry: Telemetry, task: Localization) -> Place:
        point = telemetry.position
        return task.place(0.0, 0.0) if point is None else Place(lat=point.lat_deg, lon=point.lon_deg)

    # What is shown

    def telemetry(self) -> Telemetry:
        return self._equipment.vehicle.telemetry()

    async def mend_failsafes(self) -> list[str]:
        """Set the autopilot's failsafe parameters that would not act, on the operator's explicit wish.

        One line a changed parameter. Raises VehicleError.
        """
        vehicle = self._equipment.vehicle
        return await vehicle.mend_failsafes() if isinstance(vehicle, MendsFailsafes) else []

    def vehicle_detail(self) -> str:
        """Why there is no vehicle; empty when there is one."""
        vehicle = self._equipment.vehicle
        return vehicle.detail if isinstance(vehicle, PatientVehicle) else ""

    @property
    def active_mission_id(self) -> str | None:
        return None if self._runner is None else self._runner.mission_id

    def status(self) -> Status:
        return status_of(self._runner, self._equipment)

    async def _show(self) -> None:
        """Telemetry ten times, status once a second of the wall."""
        publisher, clock = self._equipment.publisher, self._equipment.clock
        tick = 0
        while True:
            publisher.telemetry(self.telemetry(), clock.now())
            if tick % TICKS_A_STATUS == 0:
                publisher.status(self.status())
            tick += 1
            await asyncio.sleep(TELEMETRY_S)

    # Stored missions

    def _running(self, mission_id: str) -> Runner | None:
        runner = self._runner
        started = runner is not None and runner.state.started_at_s is not None
        return runner if started and runner is not None and runner.mission_id == mission_id else None

    def _lock(self, mission_id: str) -> asyncio.Lock:
        return self._locks.setdefault(mission_id, asyncio.Lock())

    async def _load(self, mission_id: str) -> tuple[MissionState, int]:
        recorded = await self._equipment.journal.read(mission_id)
        if not recorded:
            raise MissionNotFound(mission_id)
        return fold(recorded), recorded[-1].seq

    async def _record(
        self, mission_id: str, state: MissionState, given: inputs.Input
    ) -> tuple[tuple[effects.Effect, ...], int | None]:
        """A mission that is not flying: only its facts and its answer matter. The last seq, None without a fact."""
        _, asked = transition(state, given, self._equipment.clock.now())
        return asked, await self._append(mission_id, [e.event for e in asked if isinstance(e, effects.Record)])

    async def _append(self, mission_id: str, events: list[Event]) -> int | None:
        if not events:
            return None
        recorded = await self._equipment.journal.append(mission_id, events)
        self._equipment.publisher.events(recorded)
        return recorded[-1].seq

    @staticmethod
    def _check_spec(spec: MissionSpec) -> None:
        """Raises MissionInputError when the areas make no sense, wherever the vehicle is: a mission may be planned far
        from it, or hold recordings only. Preflight refuses to fly it there."""
        middle = centre_of(spec.area)
        localization(spec, Place(lat=middle.lat_deg, lon=middle.lon_deg), 0.0)


def _reply(request: CommandRequest, asked: tuple[effects.Effect, ...], seq: int) -> CommandReply:
    answer = next(e for e in asked if isinstance(e, effects.Reply))
    return CommandReply(
        command_id=request.command_id, accepted=answer.accepted, reason=answer.reason, remedy=answer.remedy, seq=seq
    )
