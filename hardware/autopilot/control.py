"""The live Authority of one vehicle: fed as messages arrive, asked in the instant before every send."""

from __future__ import annotations

from collections.abc import Callable

from hardware.authority import NOBODY, Authority, FailsafeCause, FailsafeNamed, Seen, ServerRestarted, authority_after


class Control:
    """changed: called with the Authority before and after, whenever it has changed."""

    def __init__(self, changed: Callable[[Authority, Authority], None]) -> None:
        self.authority = NOBODY
        self._changed = changed

    @property
    def ours(self) -> bool:
        """A command may be sent. One attribute read: safe from the sending thread."""
        return self.authority.who == "ours"

    def see(self, seen: Seen) -> None:
        """Fold what the vehicle showed or somebody did; `changed` is called before this returns."""
        self._become(authority_after(self.authority, seen))

    def named(self, cause: FailsafeCause | None, at_s: float) -> None:
        """Why a failsafe acts, as the autopilot has just said; None: it said nothing of the kind."""
        if cause is not None:
            self.see(FailsafeNamed(cause, at_s))

    def restore(self, authority: Authority) -> None:
        """Go on from what was known before the server restarted."""
        self._become(authority_after(authority, ServerRestarted()))

    def _become(self, after: Authority) -> None:
        before, self.authority = self.authority, after
        if after != before:
            self._changed(before, after)
