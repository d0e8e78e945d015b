"""From the bytes of a question to the fields of its answer."""

from __future__ import annotations

import dataclasses
import json
import subprocess
import sys
from typing import Any

import orjson
import pytest

from core.errors import AccuracyUnreachable, BudgetExceeded
from core.notices import Notice
from core.systems.budget import Budget
from core.work import spend
from service import VERSION
from service.execution.request_handler import RequestHandler
from service.problems import Refusal
from service.requests.request_reader import Limits
from service.responses.json_rows import written
from service.routing import Example, PostRoute, never
from tests.service.conftest import ROOT
from tests.service.toy_routes import GOOD, TOY, Ask

OTHER = dataclasses.replace(TOY, path="/v1/other", handle=lambda question, budget: {"other": budget.samples})

METHOD = json.dumps(
    {
        "body": {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]},
        "angular_velocity": [0.1, 1.0, 0.1],
        "times": [0.0, 1.0],
        "method": {"kind": "KIND", "tolerance": 1e-6},
    }
)


def answering(*routes: PostRoute, **limits: int) -> RequestHandler:
    return RequestHandler(routes or (TOY, OTHER), Budget(samples=5), Limits()._replace(**limits))


def body(**changes: Any) -> bytes:
    return json.dumps(GOOD | changes).encode()


class TestRead:
    def test_a_question_is_read_as_its_route_has_it(self) -> None:
        question = answering().read(TOY, body())
        assert isinstance(question, Ask)
        assert question.angular_velocity == (0.1, 1.0, 0.1)

    def test_limits_are_those_of_the_service(self) -> None:
        assert answering().read(TOY, body())
        with pytest.raises(Refusal):
            answering(nesting=1).read(TOY, body())

    @pytest.mark.parametrize("bad", [b"", b"{", b"[]", b"{}", body(more=1), body(behaviour="unheard of")])
    def test_what_is_no_question_is_refused(self, bad: bytes) -> None:
        with pytest.raises(Refusal) as caught:
            answering().read(TOY, bad)
        assert 400 <= caught.value.problem.type.status < 500

    def test_a_route_that_is_not_in_the_table_is_a_fault_of_the_service(self) -> None:
        with pytest.raises(KeyError):
            answering(OTHER).read(TOY, body())


class TestAnswer:
    def answer(self, handle: Any = None, **changes: Any) -> dict[str, Any]:
        route = TOY if handle is None else dataclasses.replace(TOY, handle=handle)
        asked = answering(route)
        return asked.answer(route, asked.read(route, body(**changes)))

    def test_signature_and_warnings_come_first_and_the_rest_as_the_handler_has_it(self) -> None:
        answer = self.answer()
        assert list(answer) == ["signature", "warnings", "time", "position", "nothing"]
        assert (answer["signature"], answer["warnings"]) == ({"source": "polhode", "version": VERSION}, [])

    def test_what_exceeds_the_budget_is_refused(self) -> None:
        with pytest.raises(BudgetExceeded) as caught:
            self.answer(times=[0.0] * 6)
        assert (caught.value.needed, caught.value.limit) == (6, 5)

    def test_every_route_has_the_budget(self) -> None:
        asked = answering()
        assert asked.answer(OTHER, asked.read(OTHER, body()))["other"] == 5

    def test_notices_are_written_with_pointers_into_the_question(self) -> None:
        def noticing(question: Any, budget: Budget) -> dict[str, Any]:
            return {
                "a": 1,
                "warnings": (
                    Notice("near", "too near", ("body", "a/b~c", 0)),
                    Notice("far", "too far"),
                ),
            }

        answer = self.answer(noticing)
        assert answer["warnings"] == [
            {"code": "near", "detail": "too near", "pointer": "/body/a~1b~0c/0"},
            {"code": "far", "detail": "too far"},
        ]
        assert list(answer) == ["signature", "warnings", "a"]

    def test_the_mechanics_errors_pass_through(self) -> None:
        with pytest.raises(AccuracyUnreachable):
            self.answer(behaviour="unreachable")
        with pytest.raises(RuntimeError):
            self.answer(behaviour="fail")

    def test_equal_questions_have_equal_answers(self) -> None:
        """Also from another process, which has its own."""
        assert written(self.answer(behaviour="warn")) == written(self.answer(behaviour="warn"))


class TestWarm:
    def test_every_example_is_answered_once(self) -> None:
        seen: list[Any] = []

        def noting(question: Any, budget: Budget) -> dict[str, Any]:
            seen.append(question)
            return {}

        examples = {str(k): Example("", GOOD | {"times": [float(k)]}) for k in range(3)}
        one = dataclasses.replace(TOY, handle=noting, examples=examples)
        two = dataclasses.replace(one, path="/v1/scenes", examples={"small": Example("", GOOD)})
        answering(one, two).warm()
        assert [question.times for question in seen[:3]] == [[0.0], [1.0], [2.0]]
        assert orjson.loads(seen[3].model_dump_json())["times"] == GOOD["times"]
        assert len(seen) == 4
        answering(one, two).warm(scenes_first=True)
        assert seen[4].times == seen[3].times
        assert [question.times for question in seen[5:]] == [[0.0], [1.0], [2.0]]

    def test_where_work_is_limited_questions_are_begun_of_which_some_are_small(self) -> None:
        seen: list[str] = []

        def noting(question: Any, budget: Budget) -> dict[str, Any]:
            seen.append("begun")
            spend(11.0)
            seen.append("done")
            return {}

        begun = dataclasses.replace(TOY, handle=noting)
        answering(begun, dataclasses.replace(begun, path="/v1/large", small=never)).warm(work=10.0)
        assert seen == ["begun"]

    @pytest.mark.parametrize("example", [{}, GOOD | {"behaviour": "fail"}])
    def test_an_example_that_is_not_answered_stops_the_start(self, example: dict[str, Any]) -> None:
        with pytest.raises((Refusal, RuntimeError)):
            answering(dataclasses.replace(TOY, examples={"bad": Example("", example)})).warm()


def test_nothing_is_imported_for_a_question_where_work_is_limited() -> None:
    """In a process of its own, which has imported nothing for other tests: SciPy is left to compute processes."""
    program = f"""
import sys
from contextlib import suppress
from core.systems.budget import Budget
from core.work import WorkLimitReached, work_limit
from service.execution.request_handler import RequestHandler
from service.requests.request_reader import Limits
from service.routing import TABLE
from pkgutil import resolve_name
answering = RequestHandler(resolve_name(TABLE)(), Budget(), Limits())
answering.warm(work=2000)
before = set(sys.modules)
(route,) = (route for route in resolve_name(TABLE)() if route.path == "/v1/rotation/trajectory")
for kind in ("lsoda", "radau"):
    with suppress(WorkLimitReached), work_limit(2000):
        answering.answer(route, answering.read(route, {METHOD!r}.replace("KIND", kind).encode()))
print(*(set(sys.modules) - before))
"""
    found = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=ROOT)
    assert found.stdout.split() == []
