"""A lost password: a code that a command on the server's machine makes, and the running server takes once.

Whoever may write into the data directory owns the server already. The code travels by a file there that holds its
digest: a server that runs needs no other door, and one that does not run finds it when it starts.
"""

from __future__ import annotations

import hmac
import json
import os
from collections.abc import Generator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from backend.auth.keeping import Denied
from backend.auth.registry import digest, new_code, typed
from backend.reasons.access import CodeUnusable

RECOVERY_FILE = "recovery.json"
"""In the data directory."""
LASTS_S = 3600.0


@dataclass(frozen=True, slots=True)
class Recovery:
    """For whom, and whether they manage people from then on. made_s: UTC epoch seconds."""

    code_hash: str
    person_id: str
    admin: bool
    made_s: float


def make_recovery(data_dir: Path, person_id: str, admin: bool, now_s: float) -> str:
    """The code; one that was made before works no longer. Raises OSError."""
    code = new_code()
    data_dir.mkdir(parents=True, exist_ok=True)
    path, new = data_dir / RECOVERY_FILE, data_dir / f"{RECOVERY_FILE}.new"
    new.unlink(missing_ok=True)
    handle = os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(handle, "w") as file:
        json.dump(asdict(Recovery(digest(code), person_id, admin, now_s)), file)
    same_owner(new)
    os.replace(new, path)
    return code


def take_recovery(data_dir: Path, code: str, now_s: float) -> Recovery:
    """Looked at, not yet used up. Raises Denied 403."""
    found = _read(data_dir / RECOVERY_FILE)
    if found is None or not hmac.compare_digest(found.code_hash, digest(typed(code))):
        raise Denied(403, CodeUnusable("unknown"))
    if not 0 <= now_s - found.made_s < LASTS_S:  # a clock that was set back ends it, too
        raise Denied(403, CodeUnusable("expired"))
    return found


@contextmanager
def use_up_recovery(data_dir: Path) -> Generator[None]:
    """What is changed with it is changed within: nobody else can take it meanwhile, and it is there again when the
    change fails, unless another was made since. A server that is killed within has used it up. Raises OSError."""
    path, taken = data_dir / RECOVERY_FILE, data_dir / f"{RECOVERY_FILE}.taken"
    path.rename(taken)
    try:
        yield
    except BaseException:
        with suppress(OSError):
            os.link(taken, path)
        raise
    finally:
        taken.unlink(missing_ok=True)


def same_owner(path: Path) -> None:
    """root made it: it belongs to whoever the folder belongs to, which is the server's user."""
    with suppress(PermissionError):
        owner = path.parent.stat()
        os.chown(path, owner.st_uid, owner.st_gid)


def _read(path: Path) -> Recovery | None:
    try:
        return Recovery(**json.loads(path.read_text()))
    except (OSError, ValueError, TypeError):
        return None
