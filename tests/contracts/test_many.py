"""Every route that answers many questions at once: the same bits, failures and warnings as one by one."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from core.errors import Path
from core.systems.budget import Budget
from service.requests.request_reader import Limits, Reader
from service.routes import questions
from service.routes.studies import studying
from service.routing import Columns, ManyFigures, PostRoute
from tests.drawn import sampled

ROUTES = {route.path: route for route in questions() if route.many is not None}

HANGING = {"kind": "pin", "a": "one.top", "b": [0, 0]}
REQUESTS: dict[str, dict[str, Any]] = {
    "/v1/rotation/precession": {
        "body": {"kind": "principal-moments", "moments": [1.0, 1.5, 2.0]},
        "angular_velocity": [0.1, 1.0, 0.2],
    },
    # Two rods, of which the angles have names.
    "/v1/scenes": {
        "gravity": [0, -9.81],
        "let": {"a": 0.3, "b": 1.2, "spin": 0.5},
        "bodies": {
            "one": {
                "mass": 1,
                "inertia": 0.08,
                "at": ["cos(a)/2", "sin(a)/2"],
                "angle": "a",
                "angular_velocity": "spin",
                "places": {"top": [-0.5, 0], "end": [0.5, 0]},
            },
            "two": {
                "mass": 1,
                "inertia": 0.08,
                "at": ["cos(a)+cos(b)/2", "sin(a)+sin(b)/2"],
                "angle": "b",
                "angular_velocity": 0,
                "places": {"top": [-0.5, 0]},
            },
        },
        "connections": [HANGING, {"kind": "pin", "a": "two.top", "b": "one.end"}],
        "times": [0.0, 1.5, 0.75],
    },
}
RANGES: dict[str, list[list[dict[str, Any]]]] = {
    "/v1/rotation/precession": [
        # Bodies of every kind: impossible, symmetric, and with two moments of 0.
        [{"pointer": f"/body/moments/{k}", "values": [0.0, 1.0, 1.5, 2.0, 2.5, 9.0]} for k in range(3)],
        # Starts along axes, on the separatrix and next to it.
        [{"pointer": f"/angular_velocity/{k}", "values": [0.0, -0.5, 0.1, 1.0, 1e200, 3]} for k in range(3)],
        [
            {"pointer": "/body/moments/0", "min": 1.0, "max": 2.0, "count": 15, "also": ["/angular_velocity/1"]},
            {"pointer": "/angular_velocity/0", "distribution": "normal", "mean": 0.0, "deviation": 1.0, "count": 15},
        ],
    ],
    "/v1/scenes": [
        # States at the start.
        [
            {"pointer": "/let/a", "min": -3.0, "max": 3.0, "count": 4},
            {"pointer": "/let/b", "min": -3.0, "max": 3.0, "count": 3},
            {"pointer": "/let/spin", "values": [0.0, 7.5]},
        ],
        # Other numbers, among them what cannot be: a body without mass, and angles that no double holds.
        [
            {"pointer": "/bodies/one/mass", "values": [0.0, 0.5, 2.0, -1.0, 1e-3]},
            {"pointer": "/let/a", "values": [0.0, 1.0, 1e40]},
        ],
    ],
}
FIGURES = {
    "/v1/rotation/precession": [
        *(f"/{name}" for name in ("body_rate", "space_rate", "period", "flip_interval", "precession_per_period")),
        *(f"/{name}" for name in ("mean_precession_rate", "axis_to_angular_momentum", "tumbles", "axis/2")),
        *("/middle_axis_tilt/0", "/middle_axis_tilt/1", "/axis_to_angular_velocity", "/axis/0", "/axis/1"),
        "/angular_momentum_to_angular_velocity",
    ],
    "/v1/scenes": [
        *("/accuracy/error", "/trajectory/columns/two.angle/values/1", "/trajectory/columns/one.angle/error"),
        *(f"/trajectory/columns/two.{name}/values/2/1" for name in ("position", "velocity")),
        "/trajectory/columns/one.angular_velocity/values/1",
    ],
}
TOGETHER = {"/v1/rotation/precession": [120, 200, 223], "/v1/scenes": [24, 8]}
"""How many members of each set are answered together: of scenes all that can be, of 125, 216 and 225 bodies most."""
CASES = [(path, k) for path, sets in RANGES.items() for k in range(len(sets))]


def test_every_such_route_is_tested() -> None:
    assert set(ROUTES) == set(RANGES) == set(FIGURES) == set(TOGETHER)


def block(route: PostRoute, study: dict[str, Any]) -> Any:
    about = studying((route,))
    question = Reader(about.question, Limits()).read(json.dumps(study).encode())
    members = about.members(question, Budget())
    assert members.together is (route.many is not None)
    return members.block(0, members.design.members)


def named(labels: Any, names: tuple[str, ...]) -> list[str]:
    return [names[k - 1] if k else "" for k in labels.tolist()]


@pytest.mark.parametrize(("path", "k"), CASES)
def test_many_have_the_bits_of_each_alone(path: str, k: int) -> None:
    route = ROUTES[path]
    study = {
        "question": {"path": path, "request": REQUESTS[path]},
        "vary": RANGES[path][k],
        "quantities": FIGURES[path],
    }
    counts = []

    def counted(request: Any, columns: Columns, figures: Sequence[Path]) -> ManyFigures | None:
        assert route.many is not None
        found = route.many(request, columns, figures)
        counts.append(0 if found is None else int(found.answered.sum()))
        return found

    many, alone = block(replace(route, many=counted), study), block(replace(route, many=None), study)
    # The first question is whether members are answered together at all.
    assert sum(counts[1:]) == TOGETHER[path][k]
    assert many.inputs.tobytes() == alone.inputs.tobytes()
    for found in (many, alone):
        found.figures[np.isnan(found.figures)] = np.nan
    assert many.figures.tobytes() == alone.figures.tobytes()
    assert named(many.failures, many.failure_names) == named(alone.failures, alone.failure_names)
    assert named(many.warnings, many.warning_names) == named(alone.warnings, alone.warning_names)
    assert np.isfinite(many.figures).any(axis=1).any()


def test_a_fault_in_answering_many_is_logged_and_costs_no_result(caplog: pytest.LogCaptureFixture) -> None:
    path = "/v1/rotation/precession"
    study = {
        "question": {"path": path, "request": REQUESTS[path]},
        "quantities": FIGURES[path],
        "vary": RANGES[path][2],
    }

    def faulty(request: Any, columns: Columns, figures: Sequence[Path]) -> ManyFigures | None:
        raise ZeroDivisionError

    about = studying((replace(ROUTES[path], many=faulty),))
    asked = Reader(about.question, Limits()).read(json.dumps(study).encode())
    found = about.members(asked, Budget()).block(0, 20)
    assert "could not be answered together" in caplog.text
    assert found.figures.tobytes() == block(replace(ROUTES[path], many=None), study).figures[:20].tobytes()


def test_what_is_not_answered_at_once_is_answered_one_by_one() -> None:
    """Other bodies, a measurement, and figures that are no numbers of the precession."""
    route = ROUTES["/v1/rotation/precession"]
    assert route.many is not None
    moments = {"body": {"kind": "principal-moments", "moments": [1.0, 1.5, 2.0]}, "angular_velocity": [0.1, 1.0, 0.2]}
    columns = {("angular_velocity", 0): np.array([0.1, 0.2])}
    assert route.many(moments, columns, [("flip_interval",)]) is not None
    box = {"body": {"kind": "cuboid", "sides": [1.0, 2.0, 3.0], "mass": 1.0}, "angular_velocity": [0.1, 1.0, 0.2]}
    assert route.many(box, columns, [("flip_interval",)]) is None
    assert route.many(moments | {"measure": {"duration": 1.0}}, columns, [("flip_interval",)]) is None
    assert route.many(moments, columns, [("measured", "period")]) is None
    assert route.many(moments, {("body", "moments"): np.array([1.0])}, [("flip_interval",)]) is None


def numbers_in(document: Any, path: Path = ()) -> Iterator[tuple[Path, float]]:
    """Yield the numbers of a request with their places."""
    inner = (
        document.items() if isinstance(document, dict) else enumerate(document) if isinstance(document, list) else ()
    )
    for step, value in inner:
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            yield (*path, step), float(value)
        yield from numbers_in(value, (*path, step))


EXAMPLES = [json.loads(json.dumps(example.question)) for example in ROUTES["/v1/scenes"].examples.values()]
VARIED = [(k, place, number) for k, request in enumerate(EXAMPLES) for place, number in numbers_in(request)]


@pytest.mark.parametrize(("k", "place", "number"), sampled(VARIED, "varied numbers of examples"))
def test_any_number_of_a_scene_may_vary(k: int, place: Path, number: float) -> None:
    """Whatever its set-up does with it is recorded, or is known not to be."""
    many = ROUTES["/v1/scenes"].many
    assert many is not None
    found = many(EXAMPLES[k], {place: np.array([number])}, [("accuracy", "error")])
    assert found is None or found.figures.shape == (1, 1)
