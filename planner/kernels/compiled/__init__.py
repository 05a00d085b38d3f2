"""The fast twin of `reference`: the same rollouts with the same signature, compiled by numba, without the GIL.

What makes it fast (measured in docs/kernel.md): the grid is cropped before the likelihood is evaluated; of each row
only the columns that the widened wedge touches are gathered (cells); one long loop then needs neither atan2 nor exp
(sin^2 of the error, a polynomial, three squarings), another takes the moments; the heaviest cell is a maximum over the
floats' integer view with the index in the low bits (update); the expected RMSE is only summed when its bounds do not
decide (estimate). Nothing is allocated and no reference counted inside a rollout.
"""

from planner.kernels.compiled.rollout import rollouts

__all__ = ["rollouts"]
