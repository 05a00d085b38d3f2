"""The page is served with the caching that lets a new build show at once."""

from __future__ import annotations

import shutil

import pytest
from starlette.staticfiles import StaticFiles


async def test_the_page_and_its_deep_links_are_never_taken_from_a_cache(client):
    for path in ("/", "/missions/abc", "/index.html"):
        reply = await client.get(path)
        assert reply.status_code == 200
        assert "<title>Crossfix</title>" in reply.text
        assert reply.headers["cache-control"] == "no-cache"
        assert (await client.get(path, headers={"if-none-match": reply.headers["etag"]})).status_code == 304


async def test_hashed_assets_are_kept(client):
    reply = await client.get("/assets/app-1a2b.js")
    assert "immutable" in reply.headers["cache-control"]


@pytest.mark.parametrize("path", ["/assets/gone.js", "/favicon.ico", "/%2e%2e/secret.txt", "/..%2fsecret.txt"])
async def test_a_missing_file_is_not_the_page(client, settings, path):
    (settings.page_dir.parent / "secret.txt").write_text("hidden words")
    reply = await client.get(path)
    assert reply.status_code == 404
    assert "hidden words" not in reply.text


async def test_ranges_are_served(client):
    reply = await client.get("/index.html", headers={"range": "bytes=0-3"})
    assert (reply.status_code, reply.content) == (206, b"<!do")


async def test_without_a_build_it_says_what_to_do(client, settings):
    shutil.rmtree(settings.page_dir)
    reply = await client.get("/")
    assert reply.status_code == 503
    assert "make build" in reply.text
    assert (await client.get("/api/health")).status_code == 200


async def test_a_file_that_vanishes_while_it_is_asked_for_is_a_plain_404(client, settings, monkeypatch):
    lookup = StaticFiles.lookup_path

    def rebuilt_meanwhile(self, path):
        found = lookup(self, path)
        (settings.page_dir / path).unlink()
        return found

    monkeypatch.setattr(StaticFiles, "lookup_path", rebuilt_meanwhile)
    reply = await client.get("/assets/app-1a2b.js")
    assert reply.status_code == 404
    assert reply.json()["reason"] == {"what": "file", "which": "/assets/app-1a2b.js", "code": "nothing_there"}
