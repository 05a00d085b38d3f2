"""Numbers and rows of Markdown tables."""

from __future__ import annotations

from collections.abc import Sequence


def number(value: float, decimals: int | None = None) -> str:
    """Thousands apart; without `decimals` four digits that count, of whole numbers all."""
    if decimals is None and (isinstance(value, int) or abs(value) >= 1000.0):
        decimals = 0
    return f"{value:.4g}" if decimals is None else f"{round(value, decimals) + 0.0:,.{decimals}f}"


def row(cells: Sequence[str]) -> str:
    escaped = (cell.replace("|", "\\|") for cell in cells)
    return f"| {' | '.join(escaped)} |"


def rule(columns: int) -> str:
    return "|" + "---|" * columns
