"""Fixtures for the server's rooms."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator

import pytest

from backend.workers import Workers


@pytest.fixture(scope="session")
def workers() -> Iterator[Workers]:
    """One process that reads files for all tests: to start one takes seconds."""
    shared = Workers()
    yield shared
    asyncio.run(shared.close())
