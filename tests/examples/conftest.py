"""A running service, and its answer to each example."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import pytest

from examples.ask import ask
from tests.service.conftest import Server


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    running = Server(POLHODE_DATA=str(tmp_path_factory.mktemp("data")))
    running.wait_until_ready()
    yield running.url
    running.stop()


@pytest.fixture(scope="session")
def answer_of(service: str) -> Callable[[str], dict[str, Any]]:
    return cache(lambda name: ask(name, service))
