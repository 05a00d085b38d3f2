"""The study of the way home in small: a promise in every wind, kept, and by how much too much."""

from __future__ import annotations

from tests.benchmarks.battery_home import COLUMNS, WINDS, airspace, fly, kept_percent, row

PROBLEM = airspace()


def test_a_promise_is_kept_in_every_wind_and_is_no_multiple_of_what_it_takes() -> None:
    returns = [fly(seed, PROBLEM) for seed in range(len(WINDS))]
    assert {found.wind_m_s for found in returns} == set(WINDS)
    assert kept_percent(returns) == 100.0
    assert sum(found.promised for found in returns) < 2.5 * sum(found.took for found in returns)
    assert len(row(0.0, returns)) == len(COLUMNS)


def test_a_flight_is_the_same_every_time() -> None:
    assert fly(3, PROBLEM) == fly(3, PROBLEM)
