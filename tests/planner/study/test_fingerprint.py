from planner.sources import PLANNER
from planner.study.fingerprint import DECIDING, fingerprint


def test_every_file_that_decides_is_in_it_and_no_drawing():
    deciding = {path for pattern in DECIDING for path in PLANNER.glob(pattern)}
    named = (
        "plan.py",
        "belief/grid.py",
        "kernels/compiled/rollout.py",
        "policy/ellipse_table.json",
        "study/mission.py",
    )
    assert all(PLANNER / name in deciding for name in named)
    assert PLANNER / "study/figures.py" not in deciding
    assert {path.suffix for path in deciding if path.is_file()} == {".py", ".json", ".npz"}


def test_is_twelve_hex_digits_and_the_same_all_along():
    assert fingerprint() == fingerprint.__wrapped__()
    assert len(fingerprint()) == 12
    assert int(fingerprint(), 16) > 0
