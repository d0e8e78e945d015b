"""Answers that do not pass their check are withheld, counted, logged, and kept where the operator wants that."""

from __future__ import annotations

import logging
from pathlib import Path

import orjson
import pytest

from service.observability.failed_checks import FailedChecks
from service.observability.metrics import Metrics
from service.problem_types import REGISTRY
from service.problems import Problem
from service.routes.operations import operations
from tests.service.conftest import client_of, inline_toys
from tests.service.toy_routes import GOOD

pytestmark = pytest.mark.anyio

WRONG = GOOD | {"behaviour": "wrong"}


async def test_an_answer_that_fails_its_check_is_withheld_and_its_request_kept(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    folder = tmp_path / "failed"
    service = inline_toys(failed_requests=str(folder))
    service.warm = True
    async with client_of(service) as client:
        with caplog.at_level(logging.ERROR, logger="polhode"):
            response = await client.post("/v1/toy", json=WRONG, headers={"x-request-id": "mine-1"})
        problem = response.json()
        assert (response.status_code, problem["code"]) == (500, "self-check-failed")
        assert (problem["law"], problem["connection"], problem["time"]) == ("energy", "rod", 1.5)
        assert (problem["residual"], problem["allowed"]) == (1e-3, 1e-12)
        kept = folder / f"{problem['request_id']}.json"
        assert orjson.loads(kept.read_bytes()) == WRONG
        (record,) = [one for one in caplog.records if one.message == "answer withheld"]
        assert vars(record)["check_law"] == "energy"
        counted = (await client.get("/metrics")).text
        assert 'polhode_problems_total{code="self-check-failed"} 1.0' in counted
        assert 'polhode_failed_checks_total{law="energy",operation="ask_toy"} 1.0' in counted


async def test_other_problems_leave_nothing(tmp_path: Path) -> None:
    FailedChecks(str(tmp_path), Metrics()).record("a", "b", b"{}", Problem(REGISTRY["invalid-parameter"], "bad"))
    assert not list(tmp_path.iterdir())


async def test_a_folder_that_cannot_be_written_is_logged(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    FailedChecks(str(blocked), Metrics()).record("a", "b", b"{}", Problem(REGISTRY["self-check-failed"], "bad"))
    assert any(one.message == "a request cannot be kept" for one in caplog.records)


@pytest.mark.parametrize(
    ("audit", "expected"), [(True, b'{"status":"ready"}'), (False, b'{"status":"ready","audit":"off"}')]
)
async def test_readiness_says_that_nothing_is_checked(audit: bool, expected: bytes) -> None:
    routes = operations(ready=lambda: True, metrics=Metrics(), audit=audit)
    (ready,) = [route for route in routes if route.path == "/readyz"]
    assert ready.content().body == expected
