"""What the processes do for one request: a price, an answer, or the reason why there is none."""

from __future__ import annotations

import json
from typing import Any

import pytest

from core.systems.budget import Budget
from service.execution.worker import Failed, Task, Terms, answer, price
from service.problems import Problem
from service.requests.request_reader import Limits
from service.responses.json_stream import Document
from tests.service.conftest import TOYS
from tests.service.toy_routes import GOOD

TERMS = Terms(TOYS, Budget(samples=1000), Limits())


def task(npz: bool = False, media: str | None = None, **changes: Any) -> Task:
    return Task("/v1/toy", json.dumps(GOOD | changes).encode(), npz, media, 1.0)


def test_a_request_is_priced_without_being_answered() -> None:
    assert price(TERMS, task(behaviour="fail")) == pytest.approx(3e-8)
    assert price(TERMS, task(behaviour="die", angular_velocity=[2.0, 1.0, 1.0])) == 2.0


def test_a_request_is_answered_in_its_media_type() -> None:
    document, packed = answer(TERMS, task()), answer(TERMS, task(media="application/x-npz"))
    assert isinstance(document, Document)
    assert json.loads(document.whole())["time"] == [0.0, 0.5, 1.0]
    assert isinstance(packed, Document)
    assert packed.whole().startswith(b"PK")


@pytest.mark.parametrize("work", [price, answer])
def test_what_is_wrong_with_a_request_is_its_problem(work: Any) -> None:
    for wrong, code in (
        (task(more=1), "invalid-parameter"),
        (task(times=[0.0] * 1001), "budget-exceeded"),
        (task(npz=True), "invalid-archive"),
    ):
        found = work(TERMS, wrong)
        assert isinstance(found, Problem)
        assert found.type.code == code


def test_a_fault_of_the_service_comes_with_its_traceback() -> None:
    found = answer(TERMS, task(behaviour="fail"))
    assert isinstance(found, Failed)
    assert "secret of the service" in found.traceback


def test_where_memory_is_lacking_it_is_told_so(monkeypatch: pytest.MonkeyPatch) -> None:
    def lacking(*arguments: Any) -> Any:
        raise MemoryError

    monkeypatch.setattr("service.execution.worker.composed", lacking)
    found = answer(TERMS, task())
    assert isinstance(found, Problem)
    assert (found.type.code, dict(found.headers)["Retry-After"]) == ("no-room", "1")
