"""The studies in examples/studies, run small: what they are about comes out, against formulas of their own."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.special import ellipk

from core.systems.budget import Budget
from service.requests.request_reader import Limits, Reader
from service.routes import questions
from service.routes.studies.members import Block
from service.routing import StudyRoute

FOLDER = Path(__file__).parents[2] / "examples" / "studies"
ROUTE = next(route for route in questions() if isinstance(route, StudyRoute))
READ = Reader(ROUTE.question, Limits()).read


def example(name: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((FOLDER / f"{name}.json").read_text())
    return found


def run(request: dict[str, Any]) -> Block:
    question = READ(json.dumps(request).encode())
    members = ROUTE.members(question, Budget())
    found: Block = members.block(0, members.design.members)
    assert not found.failure_names
    return found


@pytest.mark.parametrize("file", sorted(FOLDER.glob("*.json")), ids=lambda file: file.stem)
def test_every_example_is_a_study(file: Path) -> None:
    plan = ROUTE.handle(READ(file.read_bytes()), Budget())
    assert plan["count"] >= 800


def test_the_tennis_racket_map() -> None:
    """Half a period is 2 K(m)/p (Landau and Lifshitz, section 37), with K by scipy; every racket turns over."""
    request = example("tennis-racket-map")
    for axis in request["vary"]:
        axis["count"] = 12
    found = run(request)
    x, y, z = request["question"]["request"]["angular_velocity"]
    for (a, b), (interval, least, largest, turned) in zip(found.inputs.tolist(), found.figures.tolist(), strict=True):
        c = 1.0
        energy, momentum = a * x * x + b * y * y + c * z * z, a * a * x * x + b * b * y * y + c * c * z * z
        if momentum < energy * b:
            a, c = c, a
        p = math.sqrt((c - b) * (momentum - energy * a) / (a * b * c))
        m = (b - a) * (energy * c - momentum) / ((c - b) * (momentum - energy * a))
        assert interval == pytest.approx(2.0 * ellipk(m) / p, rel=1e-9)
        assert least + largest == pytest.approx(math.pi)
        assert least < 0.05
        assert turned > 2.0 * math.pi
    # The wider the middle moment is from its neighbours, the sooner the racket turns over.
    intervals = found.figures[:, 0].reshape(12, 12)
    assert (intervals[:, 0] < intervals[:, -1]).all()


def test_the_spread_of_an_attitude_is_within_the_error_that_one_answer_states() -> None:
    request = example("attitude-spread")
    request["count"] = 64
    found = run(request)
    inner = request["question"]["request"]
    request["vary"] = [{"pointer": "/body/moments/0", "values": [inner["body"]["moments"][0]]}]
    del request["count"], request["seed"]
    middle = run(request | {"design": "product"}).figures[0]
    attitudes, velocities = found.figures[:, :4], found.figures[:, 4:7]
    angles = 2.0 * np.arccos(np.minimum(1.0, np.abs(attitudes @ middle[:4])))
    stated = middle[8]
    assert 0.1 * stated < angles.max() <= stated
    apart = np.linalg.norm(velocities - middle[4:7], axis=1) / np.linalg.norm(middle[4:7])
    assert 0.1 * middle[7] < apart.max() <= 1.1 * middle[7]


def test_errors_fall_with_the_order_of_a_method_for_every_body() -> None:
    request = example("work-precision")
    request["vary"][0]["count"] = 3
    errors = run(request).figures[:, :8].reshape(3, 5, 8)
    kinds = sorted(method["kind"] for method in request["question"]["request"]["methods"])
    orders = {"explicit-euler": 1, "implicit-midpoint": 2, "symmetric-splitting": 2, "discrete-moser-veselov": 2}
    for kind, order in (orders | {"runge-kutta-4": 4}).items():
        # From one setting to the next the step is a quarter.
        slopes = np.log2(errors[:, 0, kinds.index(kind)] / errors[:, 1, kinds.index(kind)]) / 2.0
        assert slopes == pytest.approx(order, abs=0.2), kind
    for kind in ("dormand-prince-853", "lsoda", "radau"):
        assert (np.diff(errors[:, :, kinds.index(kind)]) < 0.0).all(), kind
