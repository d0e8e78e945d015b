"""Derivatives of figures of answers against closed forms."""

from __future__ import annotations

from math import cos, sin, sqrt
from typing import Any

import numpy as np
import pytest

from core.assessment.figures import steps_of
from core.errors import InvalidParameter, NotApplicable
from core.sensitivities.figure import figure_of
from core.sensitivities.sensitivities import Inputs, Sensitivity, sensitivities, sensitivity
from core.systems.budget import Budget
from service.requests.request_reader import Limits, Reader
from service.routes.assessments.route_source import RouteSource
from service.routes.described_scenes import DESCRIBED_SCENES
from service.routes.rotation.trajectory import ROTATION
from service.routing import PostRoute

BALL: dict[str, Any] = {
    "gravity": [0, "-g"],
    "let": {"g": 9.81, "h": 1.25},
    "bodies": {"ball": {"mass": 1, "at": [0, "h"], "velocity": [1, 0]}},
    "connections": [
        {"kind": "contact", "name": "floor", "place": "ball", "on": {"at": [0, 0], "normal": [0, 1]}}
        | {"restitution": 0.8}
    ],
    "times": [0.25, 1.25, 1.4],
    "outputs": ["trajectory"],
}
"""Thrown forward from a height, it touches the floor twice."""
SECOND = {"event": {"kind": "touch", "name": "floor", "nth": 2}}


def inputs(request: dict[str, Any], route: PostRoute = DESCRIBED_SCENES[0]) -> Inputs:
    reader = Reader[Any](route.question, Limits(10**4, 10**6, 10**4, 10**4), route.elsewhere)
    return Inputs(RouteSource(route, reader.read, Budget()), request)


def found(request: dict[str, Any], of: Any, to: str) -> Sensitivity:
    return sensitivity(inputs(request), figure_of(of, ()), steps_of(to))


def test_a_bouncing_ball_against_its_closed_form() -> None:
    g, h, e = 9.81, 1.25, 0.8
    first = sqrt(2.0 * h / g)
    # t = (1 + 2 e) sqrt(2 h/g); after the first impact y = e g t1 s - g s^2/2 at s = 1.25 - t1.
    s = 1.25 - first
    by_h = first / (2.0 * h)
    cases: list[tuple[Any, str, float, str]] = [
        (SECOND, "/let/h", (1.0 + 2.0 * e) * by_h, "s/m"),
        (SECOND, "/let/g", -(1.0 + 2.0 * e) * first / (2.0 * g), "s/(m/s^2)"),
        (SECOND, "/connections/0/restitution", 2.0 * first, "s"),
        (
            "/trajectory/columns/ball.position/values/1/1",
            "/let/h",
            e * g * by_h * s - e * g * first * by_h + g * s * by_h,
            "m/m",
        ),
    ]
    asked = inputs(BALL)
    for of, to, true, unit in cases:
        one = sensitivity(asked, figure_of(of, ()), steps_of(to))
        assert one.value == pytest.approx(true, abs=one.error)
        assert one.error < 1e-9
        assert one.unit == unit


def test_whole_columns_and_by_the_times() -> None:
    asked = inputs(BALL)
    of = figure_of("/trajectory/columns/ball.position/values", ())
    by_height, by_time = sensitivities(asked, [of], [steps_of("/let/h"), steps_of("/times/0")])
    assert isinstance(by_height.value, np.ndarray)
    assert by_height.value[0] == pytest.approx([0.0, 1.0], abs=by_height.error)
    assert isinstance(by_time.value, np.ndarray)
    assert by_time.value == pytest.approx(np.array([[1.0, -9.81 / 4.0], [0.0, 0.0], [0.0, 0.0]]), abs=by_time.error)
    assert by_time.unit == "m/s"


def test_a_free_body_against_its_period() -> None:
    # About the axis of symmetry the period is 2 pi/|(C - A) r/A|.
    body = {"kind": "principal-moments", "moments": [2.0, 2.0, 3.0]}
    request = {"body": body, "angular_velocity": [1.0, 0.5, 2.0], "times": [1.0]}
    asked = inputs(request, ROTATION[0])
    one = sensitivity(asked, figure_of("/angular_velocity", ()), steps_of("/angular_velocity/0"))
    # w = (a cos k t - b sin k t, a sin k t + b cos k t, r) with k = (C - A) r/A.
    assert isinstance(one.value, np.ndarray)
    assert one.value[0] == pytest.approx([cos(1.0), sin(1.0), 0.0], abs=1e-10)
    assert one.unit == "rad s^-1/(rad s^-1)"


@pytest.mark.parametrize(
    ("of", "to", "field", "rule"),
    [
        ("/nothing", "/let/h", "of", "lead to a figure"),
        ("/model/name", "/let/h", "of", "no derivative"),
        ({"count": "/events"}, "/let/h", "of", "is a count"),
        ({"event": {"kind": "slip"}}, "/let/h", "of", "lead to a figure"),
        ("/period", "/let/q", "to", "lead to a number"),
        ("/period", "/gravity/1", "to", "lead to a number"),
        ("/energy/total", "/accuracy", "to", "is a setting"),
    ],
)
def test_what_is_no_figure_or_no_number_is_refused(of: Any, to: str, field: str, rule: str) -> None:
    request = BALL | {"accuracy": 1e-9, "outputs": ["energy", "trajectory"]}
    with pytest.raises(InvalidParameter, match=rule) as refusal:
        found(request, of, to)
    assert refusal.value.path == (field,)


def test_what_happens_after_an_event_does_not_matter_to_its_time() -> None:
    # The third touch, at (1 + 2 e + 2 e^2) sqrt(2 h/g) = 0.5, is at the last of the times.
    request = BALL | {"let": {"g": 10, "h": 0.2}, "times": [0.5]}
    request["connections"] = [BALL["connections"][0] | {"restitution": 0.5}]
    one = found(request, SECOND, "/let/h")
    assert one.value == pytest.approx(1.0, abs=one.error)
    with pytest.raises(NotApplicable, match="other events"):
        found(request, "/trajectory/columns/ball.position/values/0/1", "/let/h")


def test_where_other_events_happen_there_is_no_derivative() -> None:
    # At rest on the floor: higher it falls, lower it would overlap.
    resting = BALL | {"let": {"g": 9.81, "h": 0}, "times": [1.0]}
    with pytest.raises(NotApplicable, match="no derivative by /let/h here"):
        found(resting, "/trajectory/columns/ball.position/values/0/1", "/let/h")


@pytest.mark.parametrize(
    ("of", "to", "path"),
    [([SECOND, SECOND], ["/let/g"], ("of", 1)), ([SECOND], ["/let/g", "/let/h", "/let/g"], ("to", 2))],
)
def test_what_is_named_twice_is_refused(of: list[Any], to: list[str], path: tuple[str, int]) -> None:
    with pytest.raises(InvalidParameter, match="named once") as refused:
        sensitivities(inputs(BALL), [figure_of(one, ()) for one in of], [steps_of(one) for one in to])
    assert refused.value.path == path
