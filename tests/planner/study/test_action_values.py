import numpy as np

from planner.study.action_values import values_of_grid, values_of_places
from planner.study.scenarios import scenario


def test_values_hold_flight_and_measurement_at_least():
    case = scenario("2", action_grid=(6, 6))
    found = values_of_grid(case, paths=50)
    least = np.hypot(*(found.places - case.platform).T) / 5.0 + 10.0
    assert (found.values >= least - 1e-9).all()
    assert found.values.shape == (36,)


def test_places_share_their_luck():
    case = scenario("2", action_grid=(6, 6))
    one = values_of_places(case, np.array([[200.0, 140.0]]), paths=50)
    two = values_of_places(case, np.array([[10.0, 10.0], [200.0, 140.0]]), paths=50)
    assert one[0] == two[1]
    assert two[0] > two[1]
