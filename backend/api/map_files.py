"""What uploading, naming and serving files for the map have in common: raw bodies, threads, refusals as problems."""

from __future__ import annotations

import asyncio
import errno
from collections.abc import Awaitable, Callable
from pathlib import Path as FilePath
from typing import Annotated, Literal, TypeVar

from fastapi import Path, Query, Request

from backend.api.problems import ApiProblem, not_found
from backend.maps.refusal import MapRefused, NotStored
from backend.reasons.maps import NoRoomForMap
from backend.reasons.terrain import TerrainTooLarge
from backend.reasons.work import DiskFull

T = TypeVar("T")
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
    return ApiProblem(413 if isinstance(error.reason, NoRoomForMap | TerrainTooLarge) else 422, error.reason)


def announced_bytes(request: Request) -> int | None:
    """The size that the request states for its body, None: none."""
    stated = request.headers.get("content-length", "")
    return int(stated) if stated.isdigit() else None


def label(name: str, filename: str) -> str:
    """What a file is called: as asked for, else by its own name without folder and suffix."""
    return name.strip() or FilePath(filename.replace("\\", "/")).stem
