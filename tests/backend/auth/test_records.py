"""What the database of people cannot hold is refused, and is no silence of it."""

from __future__ import annotations

import asyncio
from uuid import uuid4

import pytest
from entrance import PASSWORD, Clocks, opened, with_admin
from refusals import refusing

from backend.auth.access import Visit
from backend.auth.keeping import Denied
from backend.ports import FactRefused
from backend.reasons.access import CodeUnusable
from backend.store import engine
from backend.store.engine import migrate


@pytest.fixture
def narrow_url(postgres_cluster) -> str:
    """A database that has no letters but those of western Europe."""
    name = f"narrow_{uuid4().hex[:12]}"
    asyncio.run(postgres_cluster._ask(f"CREATE DATABASE {name} ENCODING 'LATIN1' TEMPLATE template0 LOCALE 'C'"))
    return postgres_cluster.url(name).replace("postgresql:", "postgresql+asyncpg:")


async def test_a_name_that_an_older_database_lacks_letters_for_is_refused(
    narrow_url: str, clocks: Clocks, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(engine, "_require_unicode", lambda _: None)
    await migrate(narrow_url)
    access = opened(narrow_url, clocks)
    await with_admin(access)
    code, _ = await access.invitations.make("operator", False, 3600, access.people.by_name[0].person_id)
    with pytest.raises(FactRefused, match="LATIN1"):
        await access.accept_invitation(code, "Ольга", PASSWORD, Visit("a", ""))
    await access.accept_invitation(code, "Olga", PASSWORD, Visit("a", ""))
    with refusing(CodeUnusable("used"), Denied):
        await access.accept_invitation(code, "Ольга", PASSWORD, Visit("a", ""))
    await access.close()
