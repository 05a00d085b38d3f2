"""How long the vehicle has been silent."""

from __future__ import annotations


class Silence:
    """How long nothing was heard, in seconds of the wall in which it would have been noticed.

    A radio link and its messages live in the wall's time, however fast a simulation runs; and a look that came late
    because this program stood still counts for `longest_look_s` only: what waits to be read was heard.
    """

    def __init__(self, longest_look_s: float = 0.5) -> None:
        self._longest_look_s = longest_look_s
        self.seconds = 0.0

    def heard(self) -> None:
        """Something came in: the count starts again."""
        self.seconds = 0.0

    def look(self, elapsed_s: float) -> None:
        """Nothing new; elapsed_s: of the wall, since the last look."""
        self.seconds += min(max(elapsed_s, 0.0), self._longest_look_s)
