"""The nose of a vehicle that flies to a place: sent from side to side, as the swings of its leg say, and never more.

An order of the nose is a steering command: it is sent only in the mode that obeys it and never changes the mode, so it
undoes no pilot's switch. One that is refused or unanswered ends the swings; the flight goes on.
"""

from __future__ import annotations

from hardware.autopilot.commander import Manoeuvre, ManoeuvreSuperseded
from hardware.autopilot.ground import distance_m
from hardware.autopilot.guidance import Guidance
from hardware.autopilot.messages import CONDITION_YAW, Outgoing, command_long, reposition
from hardware.ports import NotInControl, VehicleError
from hardware.readings import Place
from hardware.yaw_swings import Seen, Swinging


class LegNose:
    """begin: where the leg begins."""

    def __init__(self, guidance: Guidance, manoeuvre: Manoeuvre, swinging: Swinging, begin: Place) -> None:
        self._guidance = guidance
        self._manoeuvre = manoeuvre
        self._swinging = swinging
        self._begin = begin

    async def steer(self, place: Place, altitude_amsl_m: float, speed_m_s: float) -> None:
        """Sends the nose where it should go by what was heard last. place, altitude, speed: of the flight.

        Raises NotInControl, ManoeuvreSuperseded.
        """
        snapshot = self._guidance.monitor.snapshot
        here, heading_deg, at_s = snapshot.position, snapshot.heading_deg, snapshot.heading_at_s
        if here is None or heading_deg is None or at_s is None or snapshot.speed_m_s is None:
            return
        yaw_deg = self._swinging.see(
            Seen(
                at_s=at_s,
                heading_deg=heading_deg,
                flown_m=distance_m(self._begin, here),
                to_go_m=distance_m(here, place),
                speed_m_s=snapshot.speed_m_s,
                clear_m=self._swinging.clear_m(here),
                ours=self._guidance.monitor.control.authority.who == "ours",
            )
        )
        if yaw_deg is None:
            return
        try:
            await self._guidance.steer(self._manoeuvre, self._order(place, altitude_amsl_m, speed_m_s, yaw_deg), "turn")
        except (NotInControl, ManoeuvreSuperseded):
            raise
        except VehicleError:
            self._swinging.stop("refused")

    def _order(self, place: Place, altitude_amsl_m: float, speed_m_s: float, yaw_deg: float) -> Outgoing:
        if self._guidance.monitor.dialect.yaw_on_the_way == "condition_yaw":
            return command_long(CONDITION_YAW, yaw_deg, self._swinging.plan.rate_deg_s, 0.0, 0.0, 0.0, 0.0, 0.0)
        return reposition(place, altitude_amsl_m, speed_m_s, yaw_deg)
