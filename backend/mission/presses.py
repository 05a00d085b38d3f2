"""Of the orders that one page gives a craft the last one counts, in whichever order they arrive."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Collection
from uuid import UUID

from backend.commands import Abort, Command, Hold, Land, Press, Resume, Return

STEERING = (Hold, Return, Land, Resume, Abort)
MOST_PAGES = 1_000


class Presses:
    """Which press of each page was accepted last, by craft. Gone with the server, like orders on their way to it."""

    def __init__(self) -> None:
        self._accepted: OrderedDict[UUID, dict[str, int]] = OrderedDict()

    def is_late(self, press: Press | None, command: Command, crafts: Collection[str]) -> bool:
        """Have all of these craft accepted a later order of the same page? An abort never comes too late."""
        if press is None or not crafts or not isinstance(command, (Hold, Return, Land, Resume)):
            return False
        known = self._accepted.get(press.page, {})
        return all(known.get(craft_id, 0) > press.number for craft_id in crafts)

    def accepted(self, press: Press | None, command: Command, crafts: Collection[str]) -> None:
        """Before anything else is taken in: the next order may be an older one."""
        if press is None or not isinstance(command, STEERING):
            return
        known = self._accepted.setdefault(press.page, {})
        self._accepted.move_to_end(press.page)
        known.update({craft_id: max(press.number, known.get(craft_id, 0)) for craft_id in crafts})
        while len(self._accepted) > MOST_PAGES:
            self._accepted.popitem(last=False)
