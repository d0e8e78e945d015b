"""A running service, and its answer to each example."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import httpx
import pytest

from examples.ask import ask
from tests.service.conftest import Server


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    running = Server(POLHODE_DATA=str(tmp_path_factory.mktemp("data")))
    running.wait_until_ready()
    yield running.url
    running.stop()


def dismiss(service: str, answer: dict[str, Any]) -> None:
    """Stop a study, which would otherwise compute on every core while other tests run."""
    if "jobID" in answer:
        httpx.delete(f"{service}/v1/studies/{answer['jobID']}", verify=False).raise_for_status()


@pytest.fixture(scope="session")
def answer_of(service: str) -> Callable[[str], dict[str, Any]]:
    @cache
    def answered(name: str) -> dict[str, Any]:
        answer = ask(name, service)
        dismiss(service, answer)
        return answer

    return answered
