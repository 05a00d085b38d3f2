"""A whole rollout in readable numpy: the specification of `compiled`, and its oracle in the tests.

A rollout takes a first action, then follows the base policy until the expected RMSE of its own belief falls below the
threshold (4.11) or the horizon is reached. Each step: measure with the sample path's noise, clip the possible
positions to the bearing's wedge, crop the grid, multiply the likelihood in, take the estimate.

Where rounding could decide, both kernels leave it no say: cells are compared by the leading 44 bits of their weight
(the first of equal ones wins), of actions that are equal to 1e-9 the first wins, and edges are met 1e-9 of a
cell early. Doubling the grid is put off to the next bearing, when children and parents still have the same mass.
"""

from planner.kernels.reference.rollout import rollouts

__all__ = ["rollouts"]
