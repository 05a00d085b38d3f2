"""`python -m hardware.sim.autopilot`: one simulated multicopter as a MAVLink autopilot on UDP."""

from __future__ import annotations

import argparse
import json
import math
import signal
import sys
from collections.abc import Sequence
from types import FrameType

from hardware.sim.autopilot.ardupilot import ArduCopter
from hardware.sim.autopilot.copter import Wind
from hardware.sim.autopilot.firmware import Conditions, Firmware
from hardware.sim.autopilot.geodesy import HomeFrame
from hardware.sim.autopilot.orders import Orders
from hardware.sim.autopilot.process import Endpoint, Process, Schedule
from hardware.sim.autopilot.px4 import Px4

FLAVOURS: dict[str, type[Px4] | type[ArduCopter]] = {"px4": Px4, "ardupilot": ArduCopter}


def _numbers(text: str, count: int, what: str) -> list[float]:
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    if len(values) != count or not all(math.isfinite(value) for value in values):
        raise argparse.ArgumentTypeError(f"{text!r} is not {what}")
    return values


def _endpoint(text: str) -> Endpoint:
    host, _, port = text.rpartition(":")
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise argparse.ArgumentTypeError(f"{text!r} is not HOST:PORT, such as 127.0.0.1:14540")
    return Endpoint(host, int(port))


def _home(text: str) -> HomeFrame:
    lat, lon, amsl = _numbers(text, 3, "LAT,LON,AMSL, such as 47.3977,8.5456,488")
    try:
        return HomeFrame(lat, lon, amsl)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def _positive(text: str) -> float:
    (value,) = _numbers(text, 1, "a number")
    if value <= 0:
        raise argparse.ArgumentTypeError(f"{text} is not above zero")
    return value


def _parameter(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    return name, _numbers(value, 1, "NAME=VALUE, such as NAV_DLL_ACT=0")[0]


def _wind(text: str) -> Wind:
    parts = text.count(",") + 1
    values = _numbers(text, 3 if parts == 3 else 2, "SPEED,FROM or SPEED,FROM,GUSTS (m/s, degrees, m/s)")
    return Wind(values[0], values[1], values[2] if len(values) == 3 else 0.4 * values[0])


def parser() -> argparse.ArgumentParser:
    """The options as `launch.Setting` writes them."""
    p = argparse.ArgumentParser(
        prog="python -m hardware.sim.autopilot",
        description="A simulated multicopter that speaks MAVLink on UDP as PX4 or ArduCopter would. "
        "It prints one JSON line when it is ready (with its port for orders: pilot, faults) and flies until stopped.",
    )
    p.add_argument("--flavour", choices=sorted(FLAVOURS), default="px4", help="which autopilot to behave as")
    p.add_argument(
        "--connect", type=_endpoint, default=Endpoint("127.0.0.1", 14540), metavar="HOST:PORT",
        help="where the ground station listens (its URL: udpin://HOST:PORT); default 127.0.0.1:14540",
    )  # fmt: skip
    p.add_argument(
        "--home", type=_home, default=HomeFrame(47.3977419, 8.5455938, 488.0), metavar="LAT,LON,AMSL",
        help="where it stands: degrees WGS84 and metres above mean sea level",
    )  # fmt: skip
    p.add_argument("--heading", type=float, default=0.0, metavar="DEG", help="where its nose points at first")
    p.add_argument(
        "--speedup", type=_positive, default=1.0, metavar="S", help="run S times as fast as real time (to 20)"
    )
    p.add_argument("--seed", type=int, default=1, help="of gusts and sensor noise")
    p.add_argument(
        "--wind", type=_wind, default=Wind(), metavar="SPEED,FROM[,GUSTS]",
        help="m/s, degrees it blows from, m/s of gusts (default 0.4 SPEED)",
    )  # fmt: skip
    p.add_argument("--gps-noise", type=float, default=0.3, metavar="M", help="wandering GPS error, standard deviation")
    p.add_argument("--heading-error", type=float, default=0.0, metavar="DEG", help="constant compass error")
    p.add_argument("--heading-noise", type=float, default=0.3, metavar="DEG", help="white heading noise")
    p.add_argument("--battery", type=float, default=100.0, metavar="PERCENT", help="charge at the start")
    p.add_argument(
        "--param", type=_parameter, action="append", default=[], metavar="NAME=VALUE",
        help="set a parameter, for instance NAV_DLL_ACT=0 (may be repeated)",
    )  # fmt: skip
    p.add_argument("--control", type=int, default=0, metavar="PORT", help="UDP port for orders on 127.0.0.1 (0: any)")
    p.add_argument("--token", default="", help="its answer to a ping, by which its starter knows it again")
    p.add_argument(
        "--station-timeout", type=_positive, default=Schedule().station_timeout, metavar="S",
        help="wall seconds below which a silent ground station is not taken for lost (for sped-up runs)",
    )  # fmt: skip
    p.add_argument("--link-delay", type=float, default=0.0, metavar="S", help="of the radio, each way, 0 to 5")
    p.add_argument(
        "--clock-rate", type=_positive, default=1.0, metavar="R",
        help="the vehicle's seconds in one wall-clock second (times S): 0.98 is an overloaded simulator",
    )  # fmt: skip
    p.add_argument("--parent", type=int, metavar="PID", help="stop when this parent process is gone")
    p.add_argument(
        "--linger", type=_positive, metavar="S", help="stop when nobody was heard for that many wall seconds"
    )
    return p


def build(arguments: argparse.Namespace) -> Firmware:
    """Raises ValueError for a parameter the flavour has not."""
    conditions = Conditions(
        home=arguments.home,
        seed=arguments.seed,
        wind=arguments.wind,
        gps_sigma=arguments.gps_noise,
        heading_deg=arguments.heading,
        heading_error=arguments.heading_error,
        heading_sigma=arguments.heading_noise,
        battery_percent=arguments.battery,
    )
    firmware = FLAVOURS[arguments.flavour](conditions)
    for name, value in arguments.param:
        firmware.parameters.set(name, value)
    Orders(firmware).carry_out({"do": "link_delay", "seconds": arguments.link_delay})
    return firmware


def _leave(_signal: int, _frame: FrameType | None) -> None:
    sys.exit(0)


def main(argv: Sequence[str] | None = None) -> int:
    """Flies until it is stopped; the exit status, 2 when it cannot start."""
    arguments = parser().parse_args(argv)
    try:
        schedule = Schedule(
            arguments.speedup, arguments.clock_rate, arguments.station_timeout, arguments.parent, arguments.linger
        )
        process = Process(build(arguments), arguments.connect, arguments.control, schedule, arguments.token)
    except (ValueError, OSError) as error:
        print(f"The simulated autopilot cannot start: {error}", file=sys.stderr)
        return 2
    signal.signal(signal.SIGTERM, _leave)
    print(json.dumps({"ready": True, "control_port": process.control_port}), flush=True)
    try:
        process.run()
    except KeyboardInterrupt:
        return 0
    finally:
        process.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
