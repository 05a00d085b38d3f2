"""What checked missions told, kept in files: whatever lies in the folder, the server reckons on."""

from __future__ import annotations

from pathlib import Path

from backend.store.told_folder import ToldFolder


def test_a_folder_in_a_files_place_is_left_and_said(tmp_path: Path) -> None:
    folder = ToldFolder(tmp_path)
    (tmp_path / "one.json").mkdir()
    (tmp_path / "two.json").write_text("{}")
    folder.forget(["one", "two", "three"])
    assert folder.missions() == ["one"]
