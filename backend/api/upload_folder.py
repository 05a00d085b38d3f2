"""Where files that were uploaded lie while they are read: a folder each, which nothing outlasts for long.

A server that is killed leaves its folders. The next one to start on the machine removes them: each is locked by whoever
uses it, which ends with the process, so that those of another server that runs stay.
"""

from __future__ import annotations

import fcntl
import os
import shutil
import tempfile
from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path

PREFIX = "crossfix-recording-"


@contextmanager
def upload_folder() -> Generator[Path]:
    """Gone afterwards, with all that is in it. Raises OSError."""
    folder, lock = _made()
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        os.close(lock)


def remove_left_behind() -> None:
    """The folders of this user's servers that ended without removing them. Blocking; use threads."""
    for folder in Path(tempfile.gettempdir()).glob(f"{PREFIX}*"):
        with suppress(OSError):  # it has gone meanwhile, belongs to somebody else, or is in use
            lock = _opened(folder)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                if os.fstat(lock).st_uid == os.geteuid():
                    shutil.rmtree(folder, ignore_errors=True)
            finally:
                os.close(lock)


def _made() -> tuple[Path, int]:
    while True:
        folder = Path(tempfile.mkdtemp(prefix=PREFIX))
        with suppress(FileNotFoundError):
            lock = _opened(folder)
            with suppress(OSError):  # a disk without locks: what is left there stays
                fcntl.flock(lock, fcntl.LOCK_EX)
            if folder.exists():  # no server that starts has taken it for one that was left, before the lock
                return folder, lock
            os.close(lock)


def _opened(folder: Path) -> int:
    return os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
