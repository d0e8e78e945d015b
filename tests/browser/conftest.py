"""A service, a Chromium, and pages whose every console message is an error of the test."""

from __future__ import annotations

import json
import urllib.request
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from typing import Any

import pytest

from tests.browser.serving import ARGUMENTS, CHROMIUM, serving

# Without playwright, as in `make test`, there is nothing to collect here.
collect_ignore_glob = [] if find_spec("playwright") else ["test_*.py"]

COMPOSITOR = "GPU stall due to ReadPixels"
"""Written by Chromium whenever it composes a page without a GPU in which WebGL draws: its own way, not the page's."""

FIGURES: list[str] = []
"""What was measured, written at the end."""


def pytest_terminal_summary(terminalreporter: Any) -> None:
    if FIGURES:
        terminalreporter.section("figures")
        for line in FIGURES:
            terminalreporter.write_line(line)


@pytest.fixture(scope="session")
def base() -> Iterator[str]:
    """Address of a service."""
    with serving() as url:
        yield url


@pytest.fixture(scope="session")
def ask(base: str) -> Callable[[str, Any], Any]:
    """Send a question to the service without the page."""

    def send(path: str, question: Any) -> Any:
        body = json.dumps(question).encode()
        request = urllib.request.Request(base + path, body, {"Content-Type": "application/json"})
        return json.load(urllib.request.urlopen(request))

    return send


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    if CHROMIUM is None:
        pytest.skip("no Chromium is installed")
    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield running
        running.close()


@pytest.fixture
def opened(browser: Any, base: str) -> Iterator[Callable[..., Any]]:
    """Open a page and wait until it has answered; at the end, whatever it wrote to its console fails the test."""
    contexts, messages = [], []

    def open_page(
        path: str = "/",
        *,
        expected: tuple[str, ...] = (),
        watch: Any = None,
        before: Any = None,
        wait: bool = True,
        **options: Any,
    ) -> Any:
        options = {"viewport": {"width": 1280, "height": 900}, "reduced_motion": "reduce"} | options
        context = browser.new_context(**options)
        contexts.append(context)
        page = context.new_page()
        page.on(
            "console",
            lambda m: messages.append(m.text) if not any(e in m.text for e in (COMPOSITOR, *expected)) else None,
        )
        page.on("pageerror", lambda error: messages.append(str(error)))
        if watch is not None:
            page.on("response", watch)
        if before is not None:
            before(page)
        # A path alone is one of the service that all tests share.
        page.goto(base + path if path.startswith("/") else path)
        if wait:
            page.wait_for_selector("body[data-ready]", timeout=60_000)
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert messages == []
