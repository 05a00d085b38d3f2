"""On how many days the server ran since it first saw a mission deleted, or its raw sweeps old: a clock that was set
ahead by years takes nothing, since it adds one day.

A server that runs at week-ends only keeps what was deleted longer than thirty days; too long is no loss. Blocking; use
threads.
"""

from __future__ import annotations

import logging
import os
from collections.abc import Collection
from dataclasses import dataclass
from datetime import date
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from backend.settings import Settings

log = logging.getLogger("crossfix.store")

_COUNTED = TypeAdapter(dict[str, tuple[int, date]])


@dataclass(frozen=True, slots=True)
class DaysSeen:
    """A file beside the database: by mission, the days after the first, and the last of them. One server writes it."""

    file: Path

    @classmethod
    def deleted(cls, settings: Settings) -> DaysSeen:
        """Where a server with these settings counts for deleted missions."""
        return cls(settings.data_dir / "deleted.json")

    @classmethod
    def old(cls, settings: Settings) -> DaysSeen:
        """Where it counts for missions that are older than the rule for raw sweeps."""
        return cls(settings.data_dir / "old_sweeps.json")

    def count(self, seen: Collection[str], today: date) -> dict[str, int]:
        """Days on which the server ran after the one on which it first saw each of them so; asked again on the same day
        it counts once. What is not so any more is forgotten. Raises OSError."""
        before = self._read()
        now = {name: _next(before.get(name), today) for name in seen}
        if now != before:
            part = self.file.with_suffix(".part")
            with part.open("wb") as stream:
                stream.write(_COUNTED.dump_json(now))
                stream.flush()
                os.fsync(stream.fileno())
            os.replace(part, self.file)
        return {name: days for name, (days, _) in now.items()}

    def _read(self) -> dict[str, tuple[int, date]]:
        """Raises OSError."""
        try:
            return _COUNTED.validate_json(self.file.read_bytes())
        except FileNotFoundError:
            return {}
        except ValidationError:
            log.warning("%s cannot be read: what it counted is kept for thirty days from now", self.file)
            return {}


def _next(counted: tuple[int, date] | None, today: date) -> tuple[int, date]:
    if counted is None:
        return 0, today
    days, last = counted
    return (days, last) if last == today else (days + 1, today)
