"""Questions put to the answering layer in this process, and what must hold of whatever comes back."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

from pydantic import TypeAdapter

from core.errors import MechanicsError
from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.problem_types import REGISTRY
from service.problems import Problem, Refusal, problem_of
from service.requests.request_reader import Limits
from service.responses.json_rows import written
from service.routes import questions
from service.routing import PostRoute

ROUTES: dict[str, PostRoute] = {route.path: route for route in questions()}
BUDGET = Budget(samples=2_000_000, evaluations=5_000)
ANSWERING = RequestHandler(ROUTES.values(), BUDGET, Limits())

Asked = dict[str, Any]


@dataclass(frozen=True)
class Reply:
    """An answer as its reader gets it, or the problem that it was refused with."""

    answer: Any
    problem: Problem | None

    @property
    def answered(self) -> bool:
        return self.problem is None

    @property
    def codes(self) -> set[str]:
        """Codes of the warnings, or of the refusal."""
        if self.problem is not None:
            return {self.problem.type.code}
        return {notice["code"] for notice in self.answer["warnings"]}

    def of(self) -> Any:
        """Return the answer, which there must be."""
        assert self.problem is None, self.problem
        return self.answer


def ask(path: str, question: Asked, attempt: int = 0) -> Reply:
    """Read, answer and write a question, as the service does; nothing but a refusal may come in between.

    Parameters
    ----------
    attempt : int
        As in `RequestHandler.answer`.
    """
    route = ROUTES[path]
    try:
        read = ANSWERING.read(route, json.dumps(question).encode())
        answer = ANSWERING.answer(route, read, attempt)
    except Refusal as refusal:
        return Reply(None, refusal.problem)
    except MechanicsError as error:
        return Reply(None, problem_of(error))
    # `written` raises for whatever is not finite; null stands for what was left out on purpose.
    return Reply(json.loads(written(answer), parse_constant=_refuse), None)


def certified(path: str, question: Asked, digits: int) -> Reply:
    """Return the reply to a question asked of the certified route."""
    return ask(path.replace("/v1/", "/v1/certified/"), question | {"digits": digits})


def _refuse(name: str) -> None:
    raise AssertionError(f"{name} in an answer")


@cache
def fields_of(path: str) -> frozenset[str]:
    """Return the names of all fields, at any depth, that a question to an endpoint may have."""
    return frozenset(_fields_within(TypeAdapter(ROUTES[path].question).json_schema()))


def _fields_within(schema: Any) -> Iterator[str]:
    if isinstance(schema, dict):
        yield from schema.get("properties", {})
    for entry in schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ():
        yield from _fields_within(entry)


def pointed_at(path: str, question: Any, pointer: str) -> bool:
    """Return whether a JSON pointer leads into a question, or to the place of a field that was left out."""
    repeated = "/question/request"
    if pointer.startswith(repeated + "/") and isinstance(question, dict) and isinstance(question.get("question"), dict):
        asked = question["question"]
        return pointed_at(asked["path"], asked["request"], pointer.removeprefix(repeated))
    steps = [step.replace("~1", "/").replace("~0", "~") for step in pointer.split("/")[1:]]
    for i, step in enumerate(steps):
        if isinstance(question, dict):
            if step not in question:
                return i == len(steps) - 1 and step in fields_of(path)
            question = question[step]
        elif isinstance(question, list):
            if not step.isdigit() or int(step) >= len(question):
                return False
            question = question[int(step)]
        else:
            return False
    return True


def faults_of(path: str, question: Asked, reply: Reply) -> list[str]:
    """Return what is wrong with the form of a reply: codes, texts and pointers of its refusal or its warnings."""
    problem = reply.problem
    if problem is None:
        told = reply.answer["warnings"]
        faults = [f"no reason: {one}" for one in told if not one["code"] or len(one["detail"]) < 20]
        astray = [one for one in told if not pointed_at(path, question, one.get("pointer", ""))]
        return faults + [f"{one['pointer']} leads nowhere" for one in astray]
    faults = [] if problem.type.code in REGISTRY and problem.type.status == 422 else [f"status {problem.type}"]
    if len(problem.detail) < 20:
        faults.append(f"no reason: {problem.detail!r}")
    if not problem.faults and problem.type.code != "not-applicable":
        faults.append(f"nowhere in particular: {problem.detail}")
    faults += [f"{f.pointer} leads nowhere" for f in problem.faults if not pointed_at(path, question, f.pointer)]
    return faults
