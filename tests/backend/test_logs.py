"""Log lines: JSON for machines, with the ids of what they are about, in files that do not grow for ever."""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import text

from backend.logs import about, configure
from backend.settings import Settings
from backend.store.engine import dispose, make_engine

log = logging.getLogger("crossfix.test")


@pytest.fixture(autouse=True)
def as_before() -> Iterator[None]:
    root = logging.getLogger()
    handlers, level = root.handlers[:], root.level
    root.handlers.clear()  # pytest's own are not ours to close
    yield
    for handler in root.handlers:
        handler.close()
    root.handlers[:], root.level = handlers, level


def lines(path: Path) -> list[dict[str, object]]:
    return [json.loads(line) for line in path.read_text().splitlines()]


def test_a_line_says_what_it_is_about_even_from_a_task_that_began_there(tmp_path):
    file = tmp_path / "logs" / "crossfix.log"
    configure(Settings(log_file=file))

    async def later() -> None:
        await asyncio.sleep(0.01)
        log.info("from a task")

    async def order() -> None:
        with about(mission="m1", command="c1"):
            with about(craft="craft-1", command=None):
                task = asyncio.create_task(later())
            log.warning("ordered %s", "hold", extra={"answer_s": 0.5})
        log.info("outside")
        await task

    asyncio.run(order())
    ordered, outside, task = lines(file)
    assert (ordered["mission"], ordered["craft"], ordered["command"]) == ("m1", None, "c1")
    assert (ordered["message"], ordered["level"], ordered["logger"]) == ("ordered hold", "WARNING", "crossfix.test")
    assert ordered["answer_s"] == 0.5
    assert str(ordered["at_utc"]).endswith("+00:00")
    assert {outside[name] for name in ("mission", "craft", "command")} == {None}
    assert (task["mission"], task["craft"], task["command"]) == ("m1", "craft-1", None)


def test_an_error_is_one_line_with_its_traceback(tmp_path):
    configure(Settings(log_file=tmp_path / "log"))
    try:
        raise ValueError("two\nlines")
    except ValueError:
        log.exception("it failed")
    (line,) = lines(tmp_path / "log")
    assert "ValueError: two" in str(line["exc_info"])


def test_files_are_put_away_when_full_and_only_some_are_kept(tmp_path):
    configure(Settings(log_file=tmp_path / "log", log_file_bytes=2**16, log_files_kept=2))
    for number in range(3000):
        log.info("line %d %s", number, "x" * 100)
    files = sorted(path.name for path in tmp_path.iterdir())
    assert files == ["log", "log.1", "log.2"]
    assert all(path.stat().st_size <= 2**16 for path in tmp_path.iterdir())
    assert lines(tmp_path / "log")[-1]["message"] == "line 2999 " + "x" * 100


def test_the_terminal_gets_words_and_only_from_its_level_on(capsys):
    configure(Settings(log_level="warning"))
    with about(mission="m1"):
        log.info("not shown")
        log.warning("shown")
    told = capsys.readouterr().err
    assert "not shown" not in told
    assert told.rstrip().endswith("WARNING crossfix.test: shown [mission=m1]")


def test_the_terminal_may_get_json_too(capsys):
    configure(Settings(log_format="json", log_level="info"))
    log.info("shown")
    assert json.loads(capsys.readouterr().err)["message"] == "shown"


async def test_no_line_holds_what_a_driver_was_given(tmp_path, capsys):
    """Digests of passwords and sessions among it."""
    configure(Settings(log_level="debug"))
    engine = make_engine(f"sqlite+aiosqlite:///{tmp_path / 'x.sqlite'}", 2.0)
    async with engine.connect() as connection:
        await connection.execute(text("SELECT :given"), {"given": "argon2id$hush"})
    await dispose(engine)
    assert "hush" not in capsys.readouterr().err
