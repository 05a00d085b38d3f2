"""The ways to turn a multicopter on the spot, each watched by telemetry; when one does nothing the next is tried."""

from __future__ import annotations

import math

from hardware.autopilot.commander import Manoeuvre
from hardware.autopilot.dialect import TurnMethod
from hardware.autopilot.guidance import Guidance
from hardware.autopilot.messages import CONDITION_YAW, Outgoing, command_long, reposition
from hardware.autopilot.turn_progress import FULL_CIRCLE, TOLERANCE, TurnProgress, next_target, step_size
from hardware.ports import VehicleError
from hardware.readings import Place
from hardware.reasons.vehicle import TurnNotMade, TurnStopped
from hardware.reasons.vehicle_news import TriedAgain

STUCK_S = 6.0
"""Seconds (of the headings seen) without at least STUCK_DEG of turning after which a way of turning has failed."""
STUCK_DEG = 4.0
LEG_DEG = 90.0
SPOT_M = 5.0
"""Nearer than this to the place it was sent to the vehicle turns there, else where it is."""
_NUDGE_DEG = 9e-6  # one metre of latitude


async def turn_around(guidance: Guidance, rate_deg_s: float, by_deg: float = FULL_CIRCLE) -> None:
    """Returns once telemetry saw it turn by `by_deg`, negative: counterclockwise. Raises VehicleError when no way of
    turning made it."""
    here = guidance.here()
    spot = here if guidance.spot is None or sum(guidance.distance(*guidance.spot)) > SPOT_M else guidance.spot
    methods = guidance.monitor.dialect.turn_methods
    turn = Turn(guidance, guidance.begin("turn"), rate_deg_s, by_deg)
    for number, method in enumerate(methods, 1):
        if await turn.run(method, *spot):
            return
        if number < len(methods):
            guidance.monitor.announce(TriedAgain(TurnStopped(turn.turned_deg), number + 1))
    raise VehicleError(TurnNotMade(turn.turned_deg, len(methods)))


class Turn:
    """One turn; `run` tries one way of doing it and says whether it was seen."""

    def __init__(self, guidance: Guidance, manoeuvre: Manoeuvre, rate_deg_s: float, by_deg: float) -> None:
        self._guidance = guidance
        self._manoeuvre = manoeuvre
        self._rate = rate_deg_s
        self._by_deg = by_deg
        self.turned_deg = 0.0

    async def run(self, method: TurnMethod, place: Place, altitude_amsl_m: float) -> bool:
        """True once telemetry saw the whole turn; False when the vehicle stopped turning."""
        monitor = self._guidance.monitor
        snapshot, clock = monitor.snapshot, monitor.clock
        await self._guidance.enter_steering(self._manoeuvre)
        if snapshot.heading_deg is None or snapshot.heading_at_s is None:
            return False
        progress, seen_at = TurnProgress(snapshot.heading_deg, self._by_deg), snapshot.heading_at_s
        began, sent = clock.now(), 0.0
        progress_at, progress_deg = seen_at, 0.0
        while not progress.done:
            self._guidance.go_on(self._manoeuvre)
            target = self._target(method, clock.now() - began, progress.turned_deg, sent)
            if target - sent > 1.0:
                step = self._step(method, progress, target, place, altitude_amsl_m)
                await self._guidance.steer(self._manoeuvre, step, "turn")
                sent = target
            await monitor.wakeup.wait()
            for sample in snapshot.headings(math.nextafter(seen_at, math.inf)):
                self.turned_deg, seen_at = progress.see(sample.heading_deg), sample.at_s
            if progress.turned_deg > progress_deg + STUCK_DEG:
                progress_at, progress_deg = seen_at, progress.turned_deg
            elif seen_at - progress_at > STUCK_S:
                return False
        return True

    def _target(self, method: TurnMethod, elapsed_s: float, turned_deg: float, sent_deg: float) -> float:
        """Degrees from the start that should be commanded by now."""
        if method != "condition_yaw":
            return next_target(elapsed_s, self._rate, turned_deg, step_size(self._rate), abs(self._by_deg))
        lead = 0.4 * self._rate + 2.0  # command the next leg before this one brakes
        reached = sent_deg == 0.0 or turned_deg > sent_deg - lead
        return min(turned_deg + LEG_DEG, abs(self._by_deg) + TOLERANCE) if reached else sent_deg

    def _step(
        self, method: TurnMethod, progress: TurnProgress, target_deg: float, place: Place, altitude_amsl_m: float
    ) -> Outgoing:
        side = progress.direction
        heading = (progress.start_deg + side * target_deg) % FULL_CIRCLE
        if method == "condition_yaw":
            return command_long(CONDITION_YAW, target_deg - progress.turned_deg, self._rate, side, 1.0, 0.0, 0.0, 0.0)
        if method == "condition_yaw_absolute":
            return command_long(CONDITION_YAW, heading, self._rate, side, 0.0, 0.0, 0.0, 0.0)
        if method == "nudged_yaw_steps":
            # some versions ignore a reposition that changes nothing but yaw: move a metre to and fro with it
            nudge = _NUDGE_DEG if round(target_deg / step_size(self._rate)) % 2 else 0.0
            place = Place(place.lat + nudge, place.lon)
        return reposition(place, altitude_amsl_m, None, heading)
