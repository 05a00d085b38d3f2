"""What the server says when it has started."""

from __future__ import annotations

from backend.cli.serve import who_may_enter


def test_the_first_admin_is_made_by_a_link_that_names_the_code() -> None:
    said = who_may_enter("waiting", "https://192.168.1.10", "AB12-CD34-EF56-GH78")
    assert "first admin" in said, "docs/install-for-a-team.md looks for these words"
    assert said.split()[-1] == "https://192.168.1.10/#/first-admin/AB12-CD34-EF56-GH78"
