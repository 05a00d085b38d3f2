"""What is wrong with the database, its spool, or a fact that is to be stored."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class DatabaseSilent:
    """detail: what its driver says."""

    detail: str
    code: Literal["database_silent"] = "database_silent"
    english: ClassVar[Words] = Words(
        "The database does not answer: {detail}.",
        "Check that it is running, and that its disk has room and can be written; what happens meanwhile is kept in "
        "the spool on the disk.",
    )


@dataclass(frozen=True, slots=True)
class DatabaseSlow:
    answer_s: float
    code: Literal["database_slow"] = "database_slow"
    english: ClassVar[Words] = Words("The database's last answer took {answer_s:1}.", "Look at its load and its disk.")


@dataclass(frozen=True, slots=True)
class MachineBusy:
    """The database may answer; the server does not get to hear it in time."""

    code: Literal["machine_busy"] = "machine_busy"
    english: ClassVar[Words] = Words(
        "The server's machine is so busy that the database's answers come late.",
        "End what else runs on this machine; what happens meanwhile is kept in the spool on the disk.",
    )


@dataclass(frozen=True, slots=True)
class DatabaseTaken:
    """It is there, and another transaction on its file has not ended in time."""

    code: Literal["database_taken"] = "database_taken"
    english: ClassVar[Words] = Words(
        "Something else is writing to the database's file.",
        "This passes by itself, as when a bundle is brought in; else end the other program. What happens meanwhile "
        "is kept in the spool on the disk.",
    )


@dataclass(frozen=True, slots=True)
class DiskBusy:
    """SQLite is in the server itself: when it is late on a machine with time to spare, it waits for its disk."""

    code: Literal["disk_busy"] = "disk_busy"
    english: ClassVar[Words] = Words(
        "The disk is so slow that the database's answers come late.",
        "End what else uses this disk; what happens meanwhile is kept in the spool on it.",
    )


@dataclass(frozen=True, slots=True)
class DiskLow:
    free_bytes: int
    code: Literal["disk_low"] = "disk_low"
    english: ClassVar[Words] = Words("Only {free_bytes} are left on the disk.", "Free some space.")


@dataclass(frozen=True, slots=True)
class StockFull:
    """What comes from outside has room of its own. most: overlays, or raw sweeps of recordings."""

    what: Literal["overlays", "recordings"]
    most: int
    most_bytes: int
    code: Literal["stock_full"] = "stock_full"
    english: ClassVar[Words] = Words(
        "There is no room for it: at most {most} {what?overlays=overlays|recordings=raw sweeps of recordings} and "
        "{most_bytes} of them are kept.",
        "{what?overlays=Delete overlays that are not needed, or raise CROSSFIX_OVERLAYS_MAX and "
        "CROSSFIX_OVERLAYS_MAX_BYTES|recordings=Let raw sweeps of old missions be taken (crossfix thin), or raise "
        "CROSSFIX_RECORDINGS_MAX_SWEEPS and CROSSFIX_RECORDINGS_MAX_BYTES}.",
    )


@dataclass(frozen=True, slots=True)
class NothingStores:
    """database, spool: what keeps each from storing."""

    database: str
    spool: str
    code: Literal["nothing_stores"] = "nothing_stores"
    english: ClassVar[Words] = Words(
        "The database takes nothing ({database}) and the spool cannot be written ({spool}).",
        "Free space on the disk, and bring the database back.",
    )


@dataclass(frozen=True, slots=True)
class FactUnfit:
    """by: whose rule it breaks."""

    by: Literal["journal", "database"]
    detail: str
    code: Literal["fact_unfit"] = "fact_unfit"
    english: ClassVar[Words] = Words(
        "{by?journal=This makes no sense and cannot be stored|database=The database refuses this}: {detail}."
    )


@dataclass(frozen=True, slots=True)
class WrittenElsewhere:
    """Another writer has used the place of event `seq`, or left a gap before it."""

    mission_id: str
    seq: int
    code: Literal["written_elsewhere"] = "written_elsewhere"
    english: ClassVar[Words] = Words(
        "Event {seq} of mission {mission_id} does not follow what is stored: another server writes to it.",
        "Let only one server use this database.",
    )


@dataclass(frozen=True, slots=True)
class MissionDamaged:
    """detail: what was found first."""

    mission_id: str
    detail: str
    code: Literal["mission_damaged"] = "mission_damaged"
    english: ClassVar[Words] = Words(
        "What is stored of mission {mission_id} is damaged and cannot be read: {detail}.",
        "The other missions are not touched by that; a backup may hold this one whole. It can be deleted in the list.",
    )


@dataclass(frozen=True, slots=True)
class DatabaseUnfit:
    """The server cannot start on it."""

    database: str
    detail: str
    code: Literal["database_unfit"] = "database_unfit"
    english: ClassVar[Words] = Words(
        "The database {database} cannot be used: {detail}.",
        "Check --data-dir and CROSSFIX_DATABASE_URL, and that the disk can be written and has room.",
    )


@dataclass(frozen=True, slots=True)
class DatabaseLater:
    """revision: of its schema."""

    database: str
    revision: str
    code: Literal["database_later"] = "database_later"
    english: ClassVar[Words] = Words(
        "A later Crossfix has written the database {database} (schema {revision}).",
        "Update this one, or restore a backup from before the update.",
    )


@dataclass(frozen=True, slots=True)
class AnotherServer:
    path: str
    code: Literal["another_server"] = "another_server"
    english: ClassVar[Words] = Words(
        "Another server uses {path}.", "Stop it, or start this one with another --data-dir."
    )


@dataclass(frozen=True, slots=True)
class ForeignSpool:
    path: str
    code: Literal["foreign_spool"] = "foreign_spool"
    english: ClassVar[Words] = Words("What lies at {path} is not a journal spool.", "Move it away and start again.")


StorageReason = (
    DatabaseSilent
    | DatabaseSlow
    | MachineBusy
    | DatabaseTaken
    | DiskBusy
    | DiskLow
    | StockFull
    | NothingStores
    | FactUnfit
    | WrittenElsewhere
    | MissionDamaged
    | DatabaseUnfit
    | DatabaseLater
    | AnotherServer
    | ForeignSpool
)
