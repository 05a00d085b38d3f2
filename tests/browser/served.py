"""The real server in a process of its own, with its simulated vehicle; it can be killed and started again."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx

REPOSITORY = Path(__file__).resolve().parents[2]

QUICK: dict[str, dict[str, Any]] = {
    "flight": {"altitude_relative_m": 12, "speed_m_s": 12},
    "sensor": {"turn_rate_deg_s": 45},
    "timers": {"console_lost_hold_s": 120, "console_lost_return_s": 600, "receiver_silent_s": 30},
}
"""Low, fast and patient: a flight takes a third of the time, and a stall of a busy machine does not end it."""


@dataclass
class Server:
    url: str
    data_dir: Path
    arguments: list[str]
    process: subprocess.Popen[str]

    def order(self, do: str, **arguments: Any) -> None:
        """To the pilot of the simulated vehicle (see hardware/sim/autopilot/orders.py)."""
        port = json.loads((self.data_dir / "simulated_vehicle.json").read_text())["control_port"]
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as pilot:
            pilot.settimeout(5)
            pilot.sendto(json.dumps({"do": do, **arguments}).encode(), ("127.0.0.1", port))
            answer = json.loads(pilot.recv(4096))
        assert answer["ok"], answer

    def events(self, mission_id: str) -> list[dict[str, Any]]:
        """What happened so far."""
        return [r["event"] for r in self.get(f"/api/missions/{mission_id}/events")["events"]]

    def get(self, path: str) -> Any:
        answer = httpx.get(self.url.rstrip("/") + path, timeout=20)
        answer.raise_for_status()
        return answer.json()

    def draft(self, sensor: Mapping[str, Any] | None = None, **localization: Any) -> str:
        """A drafted mission with the suggested area, quickly flown; its id."""
        spec = self.get("/api/defaults")["spec"]
        for section, values in (QUICK | {"localization": localization}).items():
            spec[section] |= values
        spec["sensor"] |= sensor or {}
        return self.make(spec)

    def make(self, spec: Mapping[str, Any]) -> str:
        """A drafted mission; its id."""
        answer = httpx.post(self.url.rstrip("/") + "/api/missions", json=spec, timeout=20)
        answer.raise_for_status()
        return answer.json()["mission_id"]

    def kill(self) -> None:
        self.process.kill()
        self.process.communicate()

    def stop(self) -> None:
        """The server, and the vehicle that it leaves flying when a mission is in the air."""
        self.process.terminate()
        self.process.communicate(timeout=60)
        if (self.data_dir / "simulated_vehicle.json").exists():
            with suppress(OSError):
                self.order("stop")

    def start_again(self) -> None:
        """On the same port, as after a power cut."""
        port = self.url.rstrip("/").rsplit(":", 1)[1]
        self.process = started([*self.arguments, "--port", port])
        assert url_of(self.process) == self.url


def started(arguments: list[str]) -> subprocess.Popen[str]:
    command = [str(Path(sys.executable).with_name("crossfix")), "serve", "--json", *arguments]
    return subprocess.Popen(command, cwd=REPOSITORY, stdout=subprocess.PIPE, text=True)


def url_of(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    line = process.stdout.readline()
    assert line, "the server ended before it answered"
    return json.loads(line)["url"]
