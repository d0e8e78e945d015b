"""When a page has taken a change in."""

from __future__ import annotations

from typing import Any


def settle(page: Any) -> None:
    """Wait until the page has sent what it waits a moment to send, and has shown the answers."""
    page.wait_for_timeout(400)
    page.wait_for_selector("[aria-busy=true]", state="detached")
    page.wait_for_load_state("networkidle")
    page.wait_for_timeout(100)
