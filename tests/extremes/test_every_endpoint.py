"""At its extremes every endpoint gives a finite answer or a reason, and a plan says the same beforehand.

Of what the answers say, the other modules of this package are the judges.
"""

from __future__ import annotations

import io
import json
import math

import numpy as np
import pytest

from core.errors import MechanicsError
from service.problems import Refusal
from service.responses.npz import METADATA, archive
from tests.drawn import sampled
from tests.extremes.asking import ANSWERING, ROUTES, ask, faults_of
from tests.extremes.questions import QUESTIONS

every_endpoint = pytest.mark.parametrize("path", ROUTES)


def test_every_endpoint_has_extremes() -> None:
    assert set(QUESTIONS) == set(ROUTES), "put extreme questions to a new endpoint into tests/extremes/questions.py"
    for path, asked in QUESTIONS.items():
        names = [name for name, _ in asked()]
        assert len(names) >= 3, path
        assert len(set(names)) == len(names), path


@every_endpoint
def test_it_gives_a_finite_answer_or_a_reason_and_plans_say_the_same(path: str) -> None:
    """Every question of a sample is asked, and planned.

    `ask` lets no other exception pass, and nothing that is not finite.
    """
    wrong, answered = [], 0
    for name, question in sampled(QUESTIONS[path](), path):
        reply = ask(path, question)
        wrong += [(name, fault) for fault in faults_of(path, question, reply)]
        answered += reply.answered
        unplanned = path in ("/v1/plan", "/v1/assessments", "/v1/variants", "/v1/find")
        plan = None if unplanned else ask("/v1/plan", {"path": path, "request": question}, attempt=-1).of()
        if plan is not None and plan["answerable"] is not None and reply.answered:
            wrong.append((name, f"planned as {plan}, but {reply.problem or 'answered'}"))
    assert wrong == []
    assert answered > 0


@every_endpoint
def test_archives_hold_the_same_numbers(path: str) -> None:
    for name, question in list(QUESTIONS[path]())[::25]:
        route = ROUTES[path]
        try:
            answer = ANSWERING.answer(route, ANSWERING.read(route, json.dumps(question).encode()))
        except (MechanicsError, Refusal):
            continue
        with np.load(io.BytesIO(b"".join(archive(answer)))) as found:
            rest = json.loads(bytes(found[METADATA]) if METADATA in found else b"{}")
            arrays = [found[member] for member in found.files if member != METADATA]
        assert all(np.isfinite(array).all() for array in arrays), name
        assert METADATA not in rest


def test_a_million_samples_in_any_order_are_those_of_few() -> None:
    """Order, sign and repetition of times change no bit, at any number of them."""
    count = 1_000_000
    route = ROUTES["/v1/rotation/trajectory"]
    motion = {
        "body": {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]},
        "angular_velocity": [1e-9, 1.0, 1.1e-9],
        "accuracy": 1e-6,
    }
    span = {"start": -5e8, "stop": 5e8, "count": count}
    many = ANSWERING.answer(route, ANSWERING.read(route, json.dumps(motion | {"times": span}).encode()))
    rows = many["angular_velocity"]
    assert rows.shape == (count, 3)
    assert np.isfinite(rows).all()
    picked = np.random.default_rng(1).integers(0, count, 200)
    times = np.linspace(-5e8, 5e8, count)[picked]
    few = ask(route.path, motion | {"times": [*times.tolist(), *times.tolist()]}).of()["angular_velocity"]
    assert np.array_equal(np.array(few), np.concatenate([rows[picked], rows[picked]]))
    # Invariants of the samples that no sample was made from.
    energy = 0.5 * (rows**2 @ np.array([1.0, 2.0, 3.0]))
    assert np.ptp(energy) <= 40 * 2.0**-53 * energy.max()
    assert math.isclose(float(np.abs(rows[:, 1]).max()), 1.0, rel_tol=1e-15)
