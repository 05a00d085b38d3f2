"""Files that lie under names of ours are called by their owner's names."""

from __future__ import annotations

from hardware.reasons.renamed import renamed
from hardware.reasons.table import CellUnusable, FileUnreadable, NothingUsable

NAMES = {"/kept/recording.csv": "my turn.csv"}


def test_names_are_replaced_in_the_reason_inside_too() -> None:
    def of(file: str) -> NothingUsable:
        return NothingUsable(file, "power", CellUnusable(file, 3, 1, "north", "heading"))

    assert renamed(of("/kept/recording.csv"), NAMES) == of("my turn.csv")
    assert renamed(of("another.csv"), NAMES) == of("another.csv")


def test_no_path_of_ours_is_left_in_a_librarys_words() -> None:
    told = FileUnreadable("/kept/recording.csv", "[Errno 5] I/O error: '/kept/recording.csv'")
    assert renamed(told, NAMES) == FileUnreadable("my turn.csv", "[Errno 5] I/O error: 'my turn.csv'")
