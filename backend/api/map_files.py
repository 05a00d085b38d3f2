"""What uploading, naming and serving files for the map have in common: raw bodies, threads, refusals as problems."""

from __future__ import annotations

import asyncio
import errno
from collections.abc import AsyncIterator, Awaitable, Callable
from datetime import UTC, datetime
from pathlib import Path as FilePath
from typing import Annotated, Literal, Protocol, TypeVar

from fastapi import Path, Query, Request
from starlette.requests import ClientDisconnect

from backend.api.problems import ApiProblem, not_found
from backend.maps.refusal import MapRefused, NotStored
from backend.reasons.maps import NoRoomForMap
from backend.reasons.request import BodyTooLarge, UploadBrokeOff
from backend.reasons.storage import StockFull
from backend.reasons.terrain import TerrainTooLarge
from backend.reasons.work import DiskFull
from backend.workers import Workers

T = TypeVar("T")
Stored = TypeVar("Stored", covariant=True)
What = Literal["map", "overlay", "terrain"]

DISK_IS_FULL = (errno.ENOSPC, errno.EDQUOT)

ContentId = Annotated[str, Path(pattern=r"^[0-9a-f]{16}$")]
Name = Annotated[str, Query(max_length=120, description="What to call it; the file's own name when left out")]
Filename = Annotated[str, Query(max_length=255)]

RAW_BODY = {
    "requestBody": {
        "required": True,
        "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}},
    }
}


async def in_thread(what: What, work: Callable[..., T], *arguments: object) -> T:
    """Disk work off the event loop. Raises ApiProblem."""
    return await as_problem(what, asyncio.to_thread(work, *arguments))


class UploadFolder(Protocol[Stored]):
    """Where uploads of one kind are kept."""

    def store(
        self, body: AsyncIterator[bytes], name: str, announced_bytes: int | None, now: datetime, workers: Workers
    ) -> Awaitable[Stored]:
        """Check and keep it. MapRefused, WorkStopped: nothing is left of it."""
        ...


async def upload(
    what: What, folder: UploadFolder[Stored], request: Request, workers: Workers, name: str, filename: str
) -> Stored:
    """The request's body is the file itself. Raises ApiProblem."""
    stated = request.headers.get("content-length", "")
    announced_bytes = int(stated) if stated.isdigit() else None
    called, now = label(name, filename), datetime.now(UTC)
    try:
        return await as_problem(what, folder.store(request.stream(), called, announced_bytes, now, workers))
    except ClientDisconnect as error:
        raise ApiProblem(400, UploadBrokeOff()) from error


async def as_problem(what: What, doing: Awaitable[T]) -> T:
    """What the map room refuses becomes a problem."""
    try:
        return await doing
    except NotStored as error:
        raise ApiProblem(404, error.reason) from error
    except FileNotFoundError as error:  # deleted meanwhile
        raise not_found(what, FilePath(error.filename).stem) from error
    except OSError as error:
        if error.errno not in DISK_IS_FULL:
            raise
        raise ApiProblem(507, DiskFull()) from error
    except MapRefused as error:
        raise _refused(error) from error


def _refused(error: MapRefused) -> ApiProblem:
    return ApiProblem(
        413 if isinstance(error.reason, BodyTooLarge | NoRoomForMap | StockFull | TerrainTooLarge) else 422,
        error.reason,
    )


def label(name: str, filename: str) -> str:
    """What a file is called: as asked for, else by its own name without folder and suffix."""
    return name.strip() or FilePath(filename.replace("\\", "/")).stem
