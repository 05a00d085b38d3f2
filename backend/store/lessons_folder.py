"""The lessons folder: a file for each craft and antenna, with what its flights taught of its bearings' errors.

A few hundred bytes a flight, written once a flight. A file that cannot be read is moved aside and said so in the log:
then the craft counts as unknown, which is slower and never wrong.
"""

from __future__ import annotations

import asyncio
import hashlib
import logging
import os
from dataclasses import dataclass
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from backend.ports import Lesson
from backend.search.lessons import LESSONS_KEPT

log = logging.getLogger("crossfix.lessons")

_LESSONS = TypeAdapter(list[Lesson])


@dataclass(frozen=True, slots=True)
class LessonsFolder:
    """One server writes it."""

    directory: Path

    async def of(self, craft_id: str, antenna: str) -> list[Lesson]:
        """Oldest first; empty when nothing can be read."""
        return await asyncio.to_thread(self._read, craft_id, antenna)

    async def keep(self, craft_id: str, antenna: str, lesson: Lesson) -> None:
        """In the place of an earlier one of the same mission. Raises OSError."""
        await asyncio.to_thread(self._keep, craft_id, antenna, lesson)

    async def forget(self, craft_id: str, antenna: str) -> None:
        """All of them. Raises OSError."""
        await asyncio.to_thread(self._file(craft_id, antenna).unlink, missing_ok=True)

    def _file(self, craft_id: str, antenna: str) -> Path:
        """An antenna's name is free text: the file is named after its digest."""
        named = hashlib.sha256(f"{craft_id}\0{antenna}".encode()).hexdigest()[:24]
        return self.directory / f"{named}.json"

    def _read(self, craft_id: str, antenna: str) -> list[Lesson]:
        path = self._file(craft_id, antenna)
        try:
            return _LESSONS.validate_json(path.read_bytes())
        except FileNotFoundError:
            return []
        except OSError as error:
            log.error("what the flights of %s with %s taught cannot be read: %s", craft_id, antenna, error)
            return []
        except ValidationError:
            aside = path.with_suffix(".damaged")
            os.replace(path, aside)
            log.error("what the flights of %s with %s taught is damaged; it lies in %s", craft_id, antenna, aside)
            return []

    def _keep(self, craft_id: str, antenna: str, lesson: Lesson) -> None:
        known = [one for one in self._read(craft_id, antenna) if one.mission_id != lesson.mission_id]
        self.directory.mkdir(parents=True, exist_ok=True)
        path = self._file(craft_id, antenna)
        part = path.with_suffix(".part")
        part.write_bytes(_LESSONS.dump_json([*known, lesson][-LESSONS_KEPT:]))
        os.replace(part, path)
