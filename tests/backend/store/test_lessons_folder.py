"""What flights taught, kept in files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from backend.ports import Lesson, Said
from backend.store.lessons_folder import LessonsFolder

ONE = Lesson("m1", 4, 3.0, 1.5, (Said(0.5, -1.0), Said(10.0, 0.0)), (Said(1.0, 0.0),), (Said(0.05, 0.0),))
TWO = replace(ONE, mission_id="m2")


def files(directory: Path) -> list[Path]:
    return [path for path in directory.rglob("*") if path.is_file()]


async def test_lessons_come_back_oldest_first_and_a_mission_has_one(tmp_path: Path) -> None:
    folder = LessonsFolder(tmp_path / "lessons")
    assert await folder.of("craft-1", "yagi") == []
    for one in (ONE, TWO, replace(ONE, bearings=9)):
        await folder.keep("craft-1", "yagi", one)
    assert await LessonsFolder(tmp_path / "lessons").of("craft-1", "yagi") == [TWO, replace(ONE, bearings=9)]


async def test_each_craft_and_antenna_has_its_own_and_names_reach_no_other_file(tmp_path: Path) -> None:
    folder = LessonsFolder(tmp_path / "lessons")
    await folder.keep("craft-1", "../../yagi", ONE)
    assert await folder.of("craft-1", "yagi") == await folder.of("craft-2", "../../yagi") == []
    assert {path.parent for path in files(tmp_path)} == {tmp_path / "lessons"}


async def test_forgotten_is_forgotten_of_that_one_only(tmp_path: Path) -> None:
    folder = LessonsFolder(tmp_path / "lessons")
    await folder.keep("craft-1", "yagi", ONE)
    await folder.keep("craft-1", "whip", TWO)
    await folder.forget("craft-1", "yagi")
    await folder.forget("craft-1", "never flown")
    assert await folder.of("craft-1", "yagi") == []
    assert await folder.of("craft-1", "whip") == [TWO]


async def test_a_damaged_file_is_moved_aside_and_the_craft_is_unknown(tmp_path: Path) -> None:
    folder = LessonsFolder(tmp_path)
    await folder.keep("craft-1", "yagi", ONE)
    (file,) = files(tmp_path)
    file.write_text('[{"mission_id": 3')
    assert await folder.of("craft-1", "yagi") == []
    assert [path.suffix for path in files(tmp_path)] == [".damaged"]
    await folder.keep("craft-1", "yagi", TWO)
    assert await folder.of("craft-1", "yagi") == [TWO]
