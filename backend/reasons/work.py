"""Why a file was not read to its end."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class FileTooHeavy:
    """limit: which one it met; process: the reading process ended without a word."""

    limit: Literal["time", "memory", "depth", "process"]
    most_s: float
    most_bytes: int
    code: Literal["file_too_heavy"] = "file_too_heavy"
    english: ClassVar[Words] = Words(
        "The file was not read to its end: {limit?time=it took too long|memory=it took too much memory"
        "|depth=it is nested too deep|process=the process that read it ended} (a file may take {most_s} and "
        "{most_bytes} of memory). Nothing of it was kept.",
        "Simplify it or divide it, and upload the parts.",
    )


@dataclass(frozen=True, slots=True)
class ReadersBusy:
    waiting: int
    code: Literal["readers_busy"] = "readers_busy"
    english: ClassVar[Words] = Words(
        "{waiting|other file is|other files are} waiting to be read.", "Wait a moment, then upload it again."
    )


@dataclass(frozen=True, slots=True)
class DiskFull:
    code: Literal["disk_full"] = "disk_full"
    english: ClassVar[Words] = Words(
        "The disk is full. Nothing of the file was kept.",
        "Delete maps, overlays or other files, then upload it again.",
    )


@dataclass(frozen=True, slots=True)
class MissionTooHeavy:
    """limit: which one the work on it met; busy: as much work as may wait is waiting."""

    limit: Literal["time", "memory", "depth", "process", "busy"]
    most_s: float
    most_bytes: int
    code: Literal["mission_too_heavy"] = "mission_too_heavy"
    english: ClassVar[Words] = Words(
        "This was not worked out: {limit?time=it took too long|memory=it took too much memory"
        "|depth=it is nested too deep|process=the process that worked on it ended|busy=too much else is worked on} "
        "(a mission may take {most_s} and {most_bytes} of memory). Nothing is lost, and the flight goes on.",
        "{limit?busy=Wait a moment, then ask again.|*=Ask for less of it: one format, or an earlier belief.}",
    )


WorkReason = FileTooHeavy | ReadersBusy | DiskFull | MissionTooHeavy
