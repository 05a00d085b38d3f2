"""The factor at which claims are as true as they say."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from field_flights import FLOWN

from tests.benchmarks import field_widening, field_world


def claims(share: float, of: int = 1000) -> list[bool]:
    return [k < round(share * of) for k in range(of)]


def test_the_factor_is_that_of_the_curve_that_the_claims_were_made_by() -> None:
    def held(factor: float) -> list[bool]:
        return claims(1.0 / (1.0 + math.exp(-0.5 - 3.0 * math.log(factor))))

    found = field_widening.widening({factor: held(factor) for factor in (1.0, 1.5, 2.2)})
    assert found == pytest.approx(math.exp((math.log(19.0) - 0.5) / 3.0), rel=0.02)


def test_a_wedge_that_is_true_as_it_is_is_not_made_narrower() -> None:
    assert field_widening.widening({1.0: claims(0.97), 1.5: claims(0.99)}) == 1.0


def test_no_factor_is_found_where_wider_is_no_truer() -> None:
    assert field_widening.widening({1.0: claims(0.9), 2.0: claims(0.6)}) == math.inf


def test_claims_that_all_hold_from_some_factor_on_have_a_finite_one_between() -> None:
    assert 1.0 < field_widening.widening({1.0: claims(0.0, 20), 2.0: claims(1.0, 20)}) < 2.5


def test_a_factor_without_a_claim_counts_for_nothing() -> None:
    some = {1.0: claims(0.8), 2.0: claims(0.99)}
    assert field_widening.widening({**some, 3.0: []}) == field_widening.widening(some)


def test_the_factors_are_told_from_what_was_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    setting = field_world.Setting(0.0, "yagi")
    rng = np.random.default_rng(1)
    for factor, share in ((1.0, 0.7), (1.5, 0.95)):
        for seed in range(40):
            mission = FLOWN.__class__(**{**_fields(), "seed": seed, "in_c95": bool(rng.uniform() < share)})
            field_world._keep(tmp_path, setting, f"wedge*{factor:g}", mission)
    monkeypatch.setattr(
        "sys.argv",
        [
            *("x", "--told", "--seed", "0", "--factors", "1,1.5,2.2", "--compass", "0", "--antennas", "yagi"),
            *("--pieces", str(tmp_path)),
        ],
    )
    field_widening.main()
    told = capsys.readouterr().out
    assert "yagi, compass 0: sigma times 1." in told
    assert "| 1.50 |" in told
    assert "2.20" not in told


def _fields() -> dict[str, object]:
    return {name: getattr(FLOWN, name) for name in FLOWN.__dataclass_fields__}
