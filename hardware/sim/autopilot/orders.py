"""The simulated pilot, and what goes wrong: JSON orders for tests and demonstrations, one object in, one object out.

    {"do": "pilot_sticks", "north_m_s": 2, "east_m_s": 0, "up_m_s": 0, "yaw_deg_s": 0}   the pilot moves the sticks
    {"do": "pilot_mode", "mode": "POSCTL"}    the pilot's mode switch (without "mode": the flavour's usual one)
    {"do": "move_switch"}                     the switch alone, as if an order had undone it in the same instant
    {"do": "give_back"}                       the mode switch back to the autopilot's holding mode
    {"do": "link_loss", "seconds": 8}         nothing passes the radio link, both ways (simulated seconds)
    {"do": "uplink_loss", "seconds": 8}       it hears nothing of ours, and is heard all the same
    {"do": "link_delay", "seconds": 0.08}     each way, from now on (simulated seconds)
    {"do": "gps_jump", "north_m": 30, "east_m": 0, "seconds": 5}
    {"do": "transmitter_loss", "seconds": 10}  the pilot's transmitter is silent
    {"do": "gps_loss", "seconds": 10}         no satellites; after 5 s it lands by itself
    {"do": "heading_error", "degrees": 15}
    {"do": "battery", "percent": 15}
    {"do": "set_param", "name": "NAV_DLL_ACT", "value": 0}
    {"do": "fault", "kind": "refuse" | "ignore_yaw" | "ignore_goto" | "ignore_all" | "silent"
     | "unanswered", "count": 1, "of": 0}   of: refused or unanswered are those of this MAV_CMD only
    {"do": "home_drift", "up_m": -3}          this high it says it is above home, until arming sets home
    {"do": "prearm", "ok": false}
    {"do": "say", "text": "", "severity": 2, "lost": []}   a STATUSTEXT, its lost chunks left out; "hex" for any bytes
    {"do": "fence_fault", "mute": 0, "deaf_after": -1, "altered": false}   see firmware.Faults; as given, all at once
    {"do": "fence"}                           the fence that it holds
    {"do": "remote_id", "problem": ""}        Remote ID says once what is wrong (nothing: good)
    {"do": "reboot"}                          on the ground only
    {"do": "truth"}                           where the vehicle truly is
    {"do": "commands", "since_s": 0}          every command received (time since boot, MAV_CMD)
    {"do": "ping"}                            its flavour, and the token it was started with
    {"do": "stop"}

Every answer has "ok", "time_s" (since boot, simulated) and, when not ok, "error".
"""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from typing import Any, cast

from hardware.sim.autopilot.firmware import SWITCH_AT_REST_US, SWITCH_MOVED_US, Firmware

LONGEST_DELAY = 5.0


class OrderError(ValueError):
    """An order that cannot be carried out; the message says why."""


def _number(order: dict[str, Any], key: str, default: float | None = None) -> float:
    value = order.get(key, default)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise OrderError(f'The order {order.get("do")!r} needs a number "{key}", not {value!r}.')
    return float(value)


def _delay(order: dict[str, Any]) -> float:
    seconds = _number(order, "seconds")
    if not 0.0 <= seconds <= LONGEST_DELAY:
        raise OrderError(f"A link's delay is 0 to {LONGEST_DELAY:g} seconds each way, not {seconds:g}.")
    return seconds


class Orders:
    """Carries out orders on a firmware. token: by which whoever started it knows it again."""

    def __init__(self, firmware: Firmware, token: str = "") -> None:
        self._firmware = firmware
        self._token = token
        self.stop_requested = False

    def receive(self, line: bytes) -> bytes:
        """One JSON object in, one out; a wrong one is answered with what is wrong."""
        try:
            order = json.loads(line)
            if not isinstance(order, dict):
                raise OrderError('An order is a JSON object such as {"do": "ping"}.')
            answer: dict[str, Any] = {"ok": True, "time_s": self._firmware.time} | self.carry_out(
                cast(dict[str, Any], order)
            )
        except (ValueError, RecursionError) as error:
            answer = {"ok": False, "time_s": self._firmware.time, "error": str(error)}
        return json.dumps(answer).encode() + b"\n"

    def carry_out(self, order: dict[str, Any]) -> dict[str, Any]:
        """Raises ValueError with a sentence for whoever sent it."""
        firmware, faults = self._firmware, self._firmware.faults
        match order.get("do"):
            case "ping":
                return {"flavour": firmware.name, "token": self._token}
            case "pilot_sticks":
                velocity = tuple(_number(order, key, 0.0) for key in ("north_m_s", "east_m_s", "up_m_s"))
                took = firmware.move_sticks((velocity[0], velocity[1], velocity[2]), _number(order, "yaw_deg_s", 0.0))
                return {"took_control": took, "mode": firmware.mode}
            case "move_switch":
                firmware.mode_switch_us = SWITCH_MOVED_US
            case "pilot_mode":
                firmware.mode_switch_us = SWITCH_MOVED_US
                firmware.switch_mode(str(order.get("mode") or firmware.pilot_mode))
                return {"mode": firmware.mode}
            case "give_back":
                firmware.mode_switch_us = SWITCH_AT_REST_US
                firmware.switch_mode(firmware.give_back_mode)
                return {"mode": firmware.mode}
            case "link_loss":
                faults.link_lost_until = firmware.time + _number(order, "seconds")
            case "uplink_loss":
                faults.uplink_lost_until = firmware.time + _number(order, "seconds")
            case "link_delay":
                faults.link_delay = _delay(order)
            case "gps_jump":
                firmware.navigation.jump(
                    _number(order, "north_m", 0.0), _number(order, "east_m", 0.0), _number(order, "seconds", 5.0)
                )
            case "transmitter_loss":
                firmware.transmitter_lost_until = firmware.time + _number(order, "seconds", 10.0)
            case "gps_loss":
                firmware.navigation.lose_fix(_number(order, "seconds", 10.0))
            case "heading_error":
                firmware.navigation.heading_error = _number(order, "degrees")
            case "battery":
                percent = min(100.0, max(0.0, _number(order, "percent")))
                firmware.copter.energy = firmware.copter.airframe.capacity * percent / 100.0
            case "set_param":
                firmware.parameters.set(str(order.get("name")), _number(order, "value"))
            case "prearm":
                faults.no_prearm = not order.get("ok", True)
            case "say":
                words = bytes.fromhex(str(order["hex"])) if "hex" in order else str(order.get("text", "")).encode()
                firmware.say_bytes(
                    words, int(_number(order, "severity", 2.0)), [int(seq) for seq in order.get("lost", [])]
                )
            case "fence_fault":
                faults.fence_mute = int(_number(order, "mute", 0.0))
                faults.fence_deaf_after = int(_number(order, "deaf_after", -1.0))
                faults.fence_altered = bool(order.get("altered", False))
            case "fence":
                return {"items": [asdict(item) for item in firmware.fence.items]}
            case "remote_id":
                firmware.report_remote_id(str(order.get("problem", "")))
            case "reboot":
                firmware.reboot()
            case "fault":
                kind = order.get("kind")
                if kind not in ("refuse", "ignore_yaw", "ignore_goto", "ignore_all", "silent", "unanswered"):
                    raise OrderError(
                        f"There is no fault {kind!r}: refuse, ignore_yaw, ignore_goto, ignore_all, silent, unanswered."
                    )
                setattr(faults, kind, int(_number(order, "count", 1)))
                faults.only = int(_number(order, "of", 0))
            case "home_drift":
                faults.home_m = _number(order, "up_m", 0.0)
            case "truth":
                return self._truth()
            case "commands":
                since = _number(order, "since_s", 0.0)
                return {"commands": [[at, number] for at, number in firmware.commands if at >= since][-1000:]}
            case "stop":
                self.stop_requested = True
            case unknown:
                raise OrderError(f"There is no order {unknown!r}; see hardware/sim/autopilot/orders.py for the list.")
        return {}

    def _truth(self) -> dict[str, Any]:
        firmware, copter = self._firmware, self._firmware.copter
        lat, lon = firmware.home.to_geo(copter.north, copter.east)
        return {
            "lat": lat,
            "lon": lon,
            "altitude_amsl_m": firmware.home.amsl_m + copter.up,
            "altitude_relative_m": copter.up,
            "heading_deg": copter.heading % 360.0,
            "speed_m_s": math.hypot(copter.v_north, copter.v_east),
            "battery_percent": copter.battery_percent,
            "mode": firmware.mode,
            "mode_changed_at_s": firmware.mode_changed_at,
            "armed": firmware.flight.armed,
            "in_air": firmware.flight.in_air,
        }
