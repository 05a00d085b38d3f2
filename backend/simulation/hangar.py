"""Where the simulated vehicle is kept while no server runs."""

from __future__ import annotations

import json
import logging
import secrets
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from backend.settings import Settings
from hardware.sim.autopilot.geodesy import HomeFrame
from hardware.sim.autopilot.launch import Setting, SimulatedAutopilot, find_simulated, launch_simulated

log = logging.getLogger("crossfix")

HOME_AMSL_M = 120.0


@dataclass(frozen=True, slots=True)
class Hangar:
    """Remembers the simulated vehicle in a file, so that it is found again when the server was killed: in the air or on
    the ground, with what is left in its battery. Whoever ends the server on purpose gets a charged one.

    Its token tells it apart from another data directory's, which may have got its ports after it had ended.
    """

    settings: Settings

    @property
    def _register(self) -> Path:
        return self.settings.data_dir / "simulated_vehicle.json"

    def _key(self) -> dict[str, object]:
        s = self.settings
        return {
            "flavour": s.simulate,
            "time_factor": s.time_factor,
            "seed": s.seed,
            "home": [s.home_lat_deg, s.home_lon_deg],
        }

    async def enter(self) -> SimulatedAutopilot:
        """The vehicle that a server of these settings left behind, else a new one."""
        left = await self._left_behind()
        if left is not None:
            found, same = left
            if same:
                log.warning("the simulated vehicle of the last server is still there, it is taken over as it is")
                return found
            await found.stop()
        s = self.settings
        token = secrets.token_hex(8)
        started = await launch_simulated(
            Setting(
                flavour=s.simulate,
                home=HomeFrame(s.home_lat_deg, s.home_lon_deg, HOME_AMSL_M),
                speedup=s.time_factor,
                seed=s.seed,
                wind=(3.0, 240.0, 1.0),
                keep_running=s.simulated_flies_on,
                token=token,
            )
        )
        found_by = {"connect_port": started.connect_port, "control_port": started.control_port, "token": token}
        self._register.parent.mkdir(parents=True, exist_ok=True)
        self._register.write_text(json.dumps(self._key() | found_by))
        log.info("a new simulated vehicle stands at home, its battery is full")
        return started

    async def address_left(self) -> str | None:
        """URL of the vehicle that an earlier server of these settings left in the air, None when there is none."""
        left = await self._left_behind()
        return left[0].url if left is not None and left[1] else None

    async def _left_behind(self) -> tuple[SimulatedAutopilot, bool] | None:
        try:
            kept = json.loads(self._register.read_text())
            found = await find_simulated(int(kept["connect_port"]), int(kept["control_port"]), kept.get("token"))
        except (OSError, ValueError, KeyError, TypeError, OverflowError):
            return None
        same = all(kept.get(name) == value for name, value in self._key().items())
        return None if found is None else (found, same)

    async def leave(self, vehicle: SimulatedAutopilot) -> None:
        """The server ends on purpose: the vehicle stops, and the next one does not look for it."""
        await vehicle.stop()
        with suppress(OSError):
            self._register.unlink()
