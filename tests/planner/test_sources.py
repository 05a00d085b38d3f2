from planner.sources import digest


def test_changes_with_what_a_file_says_and_is_called_and_with_no_other_file(tmp_path):
    (tmp_path / "kernels").mkdir()
    inside, outside = tmp_path / "kernels" / "cells.py", tmp_path / "figures.py"
    inside.write_text("1")
    outside.write_text("1")
    first = digest(["kernels/*"], tmp_path)
    outside.write_text("2")
    assert digest(["kernels/*"], tmp_path) == first
    inside.write_text("2")
    second = digest(["kernels/*"], tmp_path)
    inside.rename(inside.with_name("rows.py"))
    assert len({first, second, digest(["kernels/*"], tmp_path)}) == 3


def test_does_not_count_a_file_twice_that_two_patterns_match(tmp_path):
    (tmp_path / "grid.py").write_text("1")
    assert digest(["*.py", "grid*"], tmp_path) == digest(["*.py"], tmp_path)
