"""The ways of somebody who does not fly: a network of stretches on the ground, and the shortest ways through it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from scipy.sparse import csr_array

NO_NODE = -9999
"""As scipy.sparse.csgraph writes it."""


@dataclass(frozen=True, slots=True, eq=False)
class Ways:
    """From where the platform stands. nodes: (n, 2) m ENU. stretches: (m, 2) nodes that are joined, both ways.
    lengths: (m,) m. measured: (l,) nodes where a bearing may be taken, each of them reached.

    reached: (n,) m of the shortest way to each node, infinite where none leads. before: (n,) the node before it there.
    """

    nodes: NDArray[np.float64]
    stretches: NDArray[np.int64]
    lengths: NDArray[np.float64]
    measured: NDArray[np.int64]
    reached: NDArray[np.float64]
    before: NDArray[np.int32]

    @property
    def places(self) -> NDArray[np.float64]:
        """(l, 2) m: the only places where a bearing may be taken."""
        return self.nodes[self.measured]

    def to(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k,) m of the shortest ways to some of the places (k, 2)."""
        return self.reached[self._nodes_of(places)]

    def between(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k, k) m of the shortest ways between some of the places (k, 2)."""
        from scipy.sparse.csgraph import dijkstra  # takes a while to load: only where there are ways

        chosen = self._nodes_of(places)
        both = _network(len(self.nodes), self.stretches, self.lengths)
        both = both + both.T
        # one by one: until a search ends no other thread of the program runs, not even one that answers an abort
        return np.array([dijkstra(both, indices=node)[chosen] for node in chosen]).reshape(len(chosen), -1)

    def path(self, x: float, y: float) -> NDArray[np.float64]:
        """(k, 2) m: the way to one of the places, both ends included."""
        (node,) = self._nodes_of(np.array([[x, y]]))
        chain = [int(node)]
        while (previous := int(self.before[chain[-1]])) != NO_NODE:
            chain.append(previous)
        return self.nodes[chain[::-1]]

    def _nodes_of(self, places: NDArray[np.float64]) -> NDArray[np.int64]:
        index = {(float(x), float(y)): int(node) for (x, y), node in zip(self.places, self.measured, strict=True)}
        return np.array([index[float(x), float(y)] for x, y in places], dtype=np.int64)


def parts(count: int, stretches: NDArray[np.int64]) -> NDArray[np.int32]:
    """(count,) of which part of a network each node is: between two parts no way leads."""
    from scipy.sparse.csgraph import connected_components

    return connected_components(_network(count, stretches, np.ones(len(stretches))), directed=False)[1]


def ways_from(
    start: int,
    nodes: NDArray[np.float64],
    stretches: NDArray[np.int64],
    lengths: NDArray[np.float64],
    wanted: NDArray[np.int64],
) -> Ways:
    """Arrays as in `Ways`. wanted: (k,) nodes where a bearing may be taken, of which those are kept that are reached;
    of two stretches between the same nodes the shorter one counts."""
    from scipy.sparse.csgraph import dijkstra

    stretches, lengths = _once(stretches, lengths)
    network = _network(len(nodes), stretches, lengths)
    (reached,), (before,) = dijkstra(network, directed=False, indices=[start], return_predecessors=True)
    return Ways(nodes, stretches, lengths, wanted[np.isfinite(reached[wanted])], reached, before)


def _once(stretches: NDArray[np.int64], lengths: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """A sparse matrix would add up what is named twice, and know no stretch of no length."""
    ordered = np.sort(stretches.reshape(-1, 2), axis=1)
    by_length = np.argsort(lengths, kind="stable")
    unlike = by_length[ordered[by_length, 0] != ordered[by_length, 1]]
    kept, first = np.unique(ordered[unlike], axis=0, return_index=True)
    return kept, np.maximum(lengths[unlike][first], 1e-6)


def _network(count: int, stretches: NDArray[np.int64], lengths: NDArray[np.float64]) -> csr_array:
    from scipy.sparse import csr_array

    return csr_array((lengths, (stretches[:, 0], stretches[:, 1])), shape=(count, count))
