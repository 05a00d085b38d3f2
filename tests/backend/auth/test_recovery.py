"""A lost password: the code of `crossfix recover`, and what it must not open."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest
from argon2 import PasswordHasher
from refusals import refusing
from typer.testing import CliRunner

from backend.auth.access import Access, Visit
from backend.auth.audit import AuditLog
from backend.auth.audit_chain import verify
from backend.auth.keeping import Denied
from backend.auth.passwords import Passwords
from backend.auth.records import Records
from backend.auth.recovery import LASTS_S, RECOVERY_FILE, make_recovery
from backend.cli.main import app
from backend.ports import JournalUnavailable
from backend.reasons.access import CodeUnusable, PasswordWeak, SignInNeeded
from backend.settings import AUDIT_FILE
from backend.store.engine import make_engine, migrate
from hardware.sim.autopilot.launch import free_port

PASSWORD, NEW = "correct horse battery", "another horse battery"
HERE = Visit("10.0.0.2", "laptop")


class Scene:
    def __init__(self, access: Access, data_dir: Path, clock: list[float]) -> None:
        self.access, self.data_dir, self.clock = access, data_dir, clock

    @property
    def ada(self) -> Any:
        return self.access.people.named("Ada")

    def code(self, *, admin: bool = False) -> str:
        return make_recovery(self.data_dir, self.ada.person_id, admin, self.clock[0])


@pytest.fixture
async def scene(tmp_path: Path) -> AsyncIterator[Scene]:
    url, clock = f"sqlite+aiosqlite:///{tmp_path / 'crossfix.sqlite'}", [1_700_000_000.0]
    await migrate(url)
    access = Access(
        Records(make_engine(url, 2.0), 2.0),
        AuditLog(tmp_path / AUDIT_FILE, lambda: clock[0]),
        people_expected=True,
        passwords=Passwords(PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)),
        data_dir=tmp_path,
        wall_s=lambda: clock[0],
    )
    await access.make_first_admin(access.begin_first_admin() or "", "Ada", PASSWORD, HERE)
    yield Scene(access, tmp_path, clock)
    await access.close()


async def test_the_only_admin_enters_again_and_everybody_who_had_the_old_password_is_out(scene: Scene) -> None:
    old = await scene.access.sign_in("Ada", PASSWORD, HERE)
    await scene.access.people.change(scene.ada.person_id, "pilot", True, True)
    new = await scene.access.recover(f" {scene.code().lower()} ", NEW, HERE)
    assert scene.access.signed_in(new, "a")
    assert scene.access.signed_in(old, "a") is None
    assert await scene.access.sign_in("Ada", NEW, HERE)
    assert scene.ada.admin


async def test_a_code_works_once_and_the_last_one_only(scene: Scene) -> None:
    first, second = scene.code(), scene.code()
    with refusing(CodeUnusable("unknown"), Denied):
        await scene.access.recover(first, NEW, HERE)
    with refusing(PasswordWeak("short", 10), Denied):  # costs no code
        await scene.access.recover(second, "short", HERE)
    assert await scene.access.recover(second, NEW, HERE)
    with refusing(CodeUnusable("unknown"), Denied):
        await scene.access.recover(second, NEW, HERE)
    assert not (scene.data_dir / RECOVERY_FILE).exists()


@pytest.mark.parametrize("stored", [False, True])
async def test_a_database_that_does_not_answer_costs_no_code(
    scene: Scene, monkeypatch: pytest.MonkeyPatch, stored: bool
) -> None:
    """Whoever heard nothing of the new password needs the code again."""
    code, change = scene.code(), Records.change

    async def silent(self: Records, **rows: Any) -> None:
        assert not (scene.data_dir / RECOVERY_FILE).exists()  # another server would take it a second time
        if stored:
            await change(self, **rows)
        raise JournalUnavailable(SignInNeeded())

    with monkeypatch.context() as meanwhile:
        meanwhile.setattr(Records, "change", silent)
        with pytest.raises(JournalUnavailable):
            await scene.access.recover(code, NEW, HERE)
    assert await scene.access.recover(code, NEW, HERE)
    with refusing(CodeUnusable("unknown"), Denied):
        await scene.access.recover(code, NEW, HERE)
    assert not list(scene.data_dir.glob(f"{RECOVERY_FILE}*"))


async def test_a_code_that_was_made_meanwhile_stays_the_one_that_works(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = list[str]()

    async def silent(*_: Any, **__: Any) -> None:
        made.append(scene.code())
        raise JournalUnavailable(SignInNeeded())

    with monkeypatch.context() as meanwhile:
        meanwhile.setattr(Records, "change", silent)
        with pytest.raises(JournalUnavailable):
            await scene.access.recover(scene.code(), NEW, HERE)
    assert await scene.access.recover(made[0], NEW, HERE)


async def test_of_two_at_once_with_one_code_one_enters(scene: Scene) -> None:
    code = scene.code()
    done = await asyncio.gather(*(scene.access.recover(code, NEW, HERE) for _ in range(2)), return_exceptions=True)
    assert [type(one) for one in done if not isinstance(one, str)] == [Denied]


@pytest.mark.parametrize("jump_s", [LASTS_S, 365 * 86_400.0, -1.0])
async def test_a_code_ends_after_an_hour_and_with_a_clock_that_jumps(scene: Scene, jump_s: float) -> None:
    code = scene.code()
    scene.clock[0] += jump_s
    with refusing(CodeUnusable("expired"), Denied):
        await scene.access.recover(code, NEW, HERE)


@pytest.mark.parametrize("content", ["", "[]", "{}", '{"code_hash": 7}', "\x00", None])
async def test_without_a_whole_file_nobody_recovers(scene: Scene, content: str | None) -> None:
    if content is not None:
        (scene.data_dir / RECOVERY_FILE).write_text(content)
    for code in ("", "AAAA-AAAA-AAAA-AAAA"):
        with refusing(CodeUnusable("unknown"), Denied):
            await scene.access.recover(code, NEW, HERE)


async def test_who_is_shut_out_comes_back_and_is_admin_when_the_command_says_so(scene: Scene) -> None:
    link, _ = await scene.access.invitations.make("viewer", False, 60.0, "x")
    await scene.access.accept_invitation(link, "Ben", PASSWORD, HERE)
    ben = scene.access.people.named("Ben")
    assert ben is not None
    await scene.access.change_person(ben.person_id, "viewer", False, False)
    code = make_recovery(scene.data_dir, ben.person_id, True, scene.clock[0])
    secret = await scene.access.recover(code, NEW, HERE)
    found = scene.access.signed_in(secret, "a")
    assert found is not None
    assert (found[0].name, found[0].role, found[0].admin) == ("Ben", "viewer", True)


async def test_the_command_names_the_person_and_is_written_into_the_log_of_the_server_that_runs(scene: Scene) -> None:
    access, runner = scene.access, CliRunner()
    access.audit.note(call="before")
    await access.audit.flushed()

    async def called(*arguments: str) -> Any:
        return await asyncio.to_thread(runner.invoke, app, ["recover", *arguments, "--data-dir", str(scene.data_dir)])

    wrong = await called("Eve")
    assert wrong.exit_code != 0
    assert "there are: Ada" in wrong.output
    done = await called(" ADA ", "--json")
    assert done.exit_code == 0, done.output
    code = json.loads(done.stdout.splitlines()[-1])["code"]
    access.audit.note(call="after")
    await access.audit.flushed()
    written = (scene.data_dir / AUDIT_FILE).read_bytes()
    verdict = verify(written.splitlines(keepends=True))
    assert (verdict.fault, verdict.head.number) == (None, 3)
    assert code.encode() not in written
    entry = json.loads(written.splitlines()[1])
    assert (entry["call"], entry["of"], entry["admin"]) == ("crossfix recover", "Ada", False)
    assert (scene.data_dir / RECOVERY_FILE).stat().st_mode & 0o077 == 0
    assert code.encode() not in (scene.data_dir / RECOVERY_FILE).read_bytes()


def test_the_command_in_the_wrong_folder_says_so(tmp_path: Path) -> None:
    found = CliRunner().invoke(app, ["recover", "Ada", "--data-dir", str(tmp_path / "nowhere")])
    assert found.exit_code != 0
    assert "--data-dir" in found.output
    assert not (tmp_path / "nowhere").exists()


def test_the_command_says_once_that_the_database_does_not_answer() -> None:
    nowhere = f"postgresql://crossfix@127.0.0.1:{free_port()}/missions"
    told = CliRunner().invoke(app, ["recover", "Ada", "--database", nowhere])
    assert told.exit_code == 2
    assert told.output.lower().count("the database does not answer") == 1
    assert told.output.rstrip().endswith("Is this the data directory of the server (--data-dir)?")


def test_the_command_makes_no_database_where_there_is_none(tmp_path: Path) -> None:
    told = CliRunner().invoke(app, ["recover", "Ada", "--data-dir", str(tmp_path)])
    assert told.exit_code == 2
    assert "there is no database" in told.output
    assert not list(tmp_path.iterdir())
