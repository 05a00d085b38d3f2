import planner.study.fingerprint as module


def test_changes_with_a_file_that_decides_and_with_no_other(tmp_path, monkeypatch):
    (tmp_path / "policy").mkdir()
    (tmp_path / "study").mkdir()
    deciding, drawing = tmp_path / "policy" / "entropy.py", tmp_path / "study" / "figures.py"
    deciding.write_text("1")
    drawing.write_text("1")
    monkeypatch.setattr(module, "PLANNER", tmp_path)
    first = module.fingerprint.__wrapped__()
    drawing.write_text("2")
    assert module.fingerprint.__wrapped__() == first
    deciding.write_text("2")
    assert module.fingerprint.__wrapped__() != first


def test_is_the_same_all_along():
    assert module.fingerprint() == module.fingerprint.__wrapped__()
    assert len(module.fingerprint()) == 12
