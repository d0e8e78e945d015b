"""No question of any endpoint holds the event loop: what is answered there is bounded by counts, whatever is asked.

Beside the work that the loops of core count, the interpreter counts calls: a loop that counts nothing shows there. The
environment variable POLHODE_FUZZ is the number of questions for each endpoint; with it every run has another seed.
"""

from __future__ import annotations

import gc
import json
import os
import random
import sys
from collections.abc import Callable
from contextlib import suppress
from types import FrameType
from typing import Any

import pytest
from pydantic import TypeAdapter

from core.errors import MechanicsError
from service.execution.admission import Compute
from service.execution.executor import Executor
from service.execution.request_handler import RequestHandler
from service.observability.metrics import Metrics
from service.problems import Refusal
from service.routes import questions
from service.routing import TABLE, PostRoute
from service.settings import Settings
from tests.extremes.questions import QUESTIONS

COUNT = int(os.environ.get("POLHODE_FUZZ", "0"))
SEED = random.SystemRandom().randrange(10**9) if COUNT else 20261122
SETTINGS = Settings()
COMPUTE = Compute(SETTINGS, Metrics(), TABLE)
ROUTES = [route for route in questions() if route.small is not PostRoute.small]

MOST_CALLS = 120_000
"""Of Python and C functions for one request: about 20 ms."""

SIZES = (0, 1, 2, 7, 63, 64, 255, 256, 257, 1000, 10**5, 10**6, 10**9)
NUMBERS = (0.0, -0.0, 5e-324, 1e-300, 1e-57, 1e-19, 1e-3, 0.5, 0.999999, 1.0, 3.0, 269.0, 1e20, 1e57, 1e154, 1.7e308)
METHODS: tuple[dict[str, Any], ...] = (
    {"kind": "closed-form"},
    {"kind": "explicit-euler", "step": 269.0},
    {"kind": "symmetric-splitting", "step": 1e-6},
    {"kind": "dormand-prince-853", "tolerance": 1e-12},
    {"kind": "radau", "tolerance": 1e-9},
)
ADDED: dict[str, Callable[[random.Random], Any]] = {
    "times": lambda chance: {"start": 0.0, "stop": chance.choice(NUMBERS), "count": chance.choice(SIZES)},
    "round": lambda chance: chance.choice([1, 15, 16, "meaningful"]),
    "method": lambda chance: chance.choice(METHODS),
    "digits": lambda chance: chance.choice([16, 50, 1000]),
    "resolution": lambda chance: chance.choice(SIZES),
    "points": lambda chance: chance.choice(SIZES),
    "polhodes": lambda chance: {"count": chance.choice(SIZES), "seed": 1},
    "count": lambda chance: chance.choice(SIZES),
    "sample": lambda chance: {"energy": chance.choice(NUMBERS), "count": chance.choice(SIZES)},
    "separatrix": lambda chance: True,
    "attitude": lambda chance: [1.0, 2.0, 3.0, 4.0],
    "accuracy": lambda chance: 0.5,
    "input_uncertainty": lambda chance: 1e-6,
    "restitution": lambda chance: chance.choice([0.0, 0.9, 0.999999, 1.0]),
    "friction": lambda chance: {"kinetic": [0.1, 0.1], "static": [0.12, 0.12]},
    "velocities": lambda chance: [chance.choice(NUMBERS), -chance.choice(NUMBERS)],
    "spins": lambda chance: [chance.choice(NUMBERS), chance.choice(NUMBERS)],
}
"""Fields that make questions long, and what they may be."""


class Calls:
    """Counts the calls of functions, compiled ones apart, while it is entered."""

    def __init__(self) -> None:
        self.count = 0

    def __enter__(self) -> Calls:
        def counting(frame: FrameType, event: str, argument: Any) -> None:
            self.count += event in ("call", "c_call")

        # Collecting garbage calls what others have left to be finalised.
        gc.disable()
        sys.setprofile(counting)
        return self

    def __exit__(self, *error: object) -> None:
        sys.setprofile(None)
        gc.enable()


def numbers(node: Any) -> list[tuple[Any, Any]]:
    """Return container and key of every number of a document."""
    keys = list(node) if isinstance(node, dict) else list(range(len(node))) if isinstance(node, list) else []
    found = [(node, key) for key in keys if isinstance(node[key], float)]
    return found + [place for key in keys for place in numbers(node[key])]


def extreme(chance: random.Random, question: dict[str, Any], fields: set[str]) -> dict[str, Any]:
    """Return a question with some of its numbers at extremes, and with more asked for."""
    found: dict[str, Any] = json.loads(json.dumps(question))
    places = numbers(found)
    for container, key in chance.sample(places, min(len(places), chance.choice([0, 0, 1, 2]))):
        container[key] = chance.choice(NUMBERS) * chance.choice([1.0, 1.0, -1.0])
    for name in chance.sample(sorted(fields), min(len(fields), chance.choice([0, 1, 2, 4]))):
        found[name] = ADDED[name](chance)
    return found


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("route", ROUTES, ids=lambda route: route.operation_id)
def test_no_question_holds_the_event_loop(route: PostRoute) -> None:
    chance = random.Random(f"{SEED} {route.path}")
    handler = RequestHandler([route], COMPUTE.terms.budget, COMPUTE.terms.limits)
    executor = Executor(handler, COMPUTE, Metrics(), SETTINGS)
    # What is imported or cached at the first question is no work of the others.
    handler.warm(work=SETTINGS.inline_work)
    known = [*QUESTIONS[route.path](), *((name, dict(one.question)) for name, one in route.examples.items())]
    fields = {name for name in ADDED if f'"{name}"' in json.dumps(TypeAdapter(route.question).json_schema())}
    answered = 0
    for _ in range(COUNT or 60):
        name, known_question = chance.choice(known)
        question = extreme(chance, known_question, fields)
        body = json.dumps(question).encode()
        if len(body) > SETTINGS.inline_bytes:
            continue
        with Calls() as calls, suppress(Refusal, MechanicsError):
            answered += executor.answer_inline(route, body) is not None
        assert calls.count < MOST_CALLS, (SEED, name, body[:2000])
    assert answered > 0
