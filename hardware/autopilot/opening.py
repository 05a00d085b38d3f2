"""MAVSDK with a connection, which hears the vehicle from then on.

A vehicle left in flight is listened for while the rest of the link is loaded: nothing heavy is imported here.
"""

# pyright: standard
# (mavsdk has no types)

from __future__ import annotations

import ctypes
import logging
import socket
from dataclasses import dataclass
from functools import cache

from mavsdk import ComponentType, Configuration, LogLevel, Mavsdk, log_subscribe

log = logging.getLogger(__name__)
_LEVELS = {LogLevel.WARN: logging.INFO, LogLevel.ERROR: logging.WARNING}
_SCHEMES = ("udpin://", "udpout://", "tcpin://", "tcpout://", "tcp://", "serial://")
PATIENCE_WALL_S = 1.5
"""What a fence's part or a parameter is waited for, before it is sent again."""
STATION_SYSTEM = 255
"""Our MAVLink system id. ArduPilot's ground-station failsafe watches the heartbeats of this id only (MAV_GCS_SYSID,
SYSID_MYGCS: 255 by default); under MAVSDK's own 245 it would never act when this program dies."""


@dataclass(frozen=True, slots=True)
class Connection:
    """Whoever has it destroys it."""

    mavsdk: Mavsdk


def check_url(url: str) -> str:
    """A connection URL that MAVSDK takes. Raises ValueError with the forms there are."""
    if not url.startswith(_SCHEMES) or url.endswith("//"):
        raise ValueError(
            f"{url!r} is no vehicle address. Use udpin://0.0.0.0:14540 (the vehicle sends to this port), "
            "udpout://HOST:PORT, tcpout://HOST:PORT, tcpin://0.0.0.0:PORT or serial:///dev/ttyUSB0:57600."
        )
    return "tcpout://" + url.removeprefix("tcp://") if url.startswith("tcp://") else url


def open_connection(url: str) -> Connection:
    """Blocks until the connection is there, which does not mean that anybody answers. Raises ValueError for an address
    that cannot be read, OSError when it cannot be opened."""
    url = check_url(url)
    _take_log_over()
    _refuse_taken_port(url)
    configuration = Configuration.create_with_component_type(ComponentType.GROUND_STATION)
    configuration.system_id = STATION_SYSTEM
    mavsdk = Mavsdk(configuration)
    be_patient(mavsdk, PATIENCE_WALL_S)
    try:
        mavsdk.add_any_connection_with_handle(url)
    except Exception as error:
        mavsdk.destroy()
        raise OSError(str(error)) from error
    return Connection(mavsdk)


def _keep_log(level: LogLevel, message: str, file: str | None, line: int) -> bool:
    log.log(_LEVELS.get(level, logging.DEBUG), "mavsdk: %s", message)
    return True


@cache
def _take_log_over() -> None:
    """MAVSDK prints to stdout by itself, where `--json` promises one JSON value. Once a process: a second subscription
    frees the first one's callback while a thread of another link may be in it, and the process dies (seen)."""
    log_subscribe(_keep_log)


def be_patient(mavsdk: Mavsdk, wall_s: float) -> None:
    """Set how long each answer is waited for. By itself MAVSDK sends a part of a fence again after 0.5 s, at 250 ms
    each way before its answer can be here; ArduCopter then ends the transfer ("invalid sequence"). Python's binding
    leaves out the library's way to change that."""
    patience = mavsdk._lib.mavsdk_set_timeout_s
    patience.argtypes, patience.restype = [ctypes.c_void_p, ctypes.c_double], None
    patience(mavsdk._handle, wall_s)


def _refuse_taken_port(url: str) -> None:
    """MAVSDK binds a port that another program has without a word, and then hears nothing or half. Raises OSError."""
    host, _, port = url.removeprefix("udpin://").rpartition(":")
    if not url.startswith("udpin://") or not port.isdecimal():
        return
    with socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind((host.strip("[]"), int(port)))
