"""How much a companion computer may say at once."""

from __future__ import annotations

MAXIMUM_MESSAGE_BYTES = 256 * 1024
