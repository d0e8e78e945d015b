"""Every answer with samples over time can be had as a figure; the figure shows the numbers of the JSON answer."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from functools import cache
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.systems.budget import Budget
from service.requests.declared_units import has_field
from service.requests.request_reader import Limits, Reader
from service.responses.linear_svg import LEFT, WIDTH
from service.responses.motion_svg import Column, numbers, over_time
from service.responses.svg import SVG
from service.routes import questions
from service.routing import Answer, PostRoute
from tests.service.conftest import client_of, inline_service

NAMESPACE = {"svg": "http://www.w3.org/2000/svg"}


def with_samples() -> Iterator[PostRoute]:
    """Yield the routes that answer samples over time."""
    for route in questions():
        if has_field(route.answer, "trajectory") or has_field(route.answer, "time"):
            yield route


def answered(route: PostRoute, question: Any) -> Answer:
    return route.handle(Reader(route.question, Limits()).read(json.dumps(question).encode()), Budget())


@cache
def examples() -> list[tuple[PostRoute, str]]:
    return [(route, name) for route in with_samples() for name in route.examples]


def columns_of(answer: Answer) -> dict[str, Any]:
    """Return every column over time by its name, without the paths of a described scene in the plane."""
    if "trajectory" in answer:
        motion = answer["trajectory"]
        if "columns" not in motion:
            return {name: values for name, values in motion.items() if name != "time" and values is not None}
        return {
            name: column["values"]
            for name, column in motion["columns"].items()
            if not (name.endswith(".position") and np.shape(column["values"])[1] == 2)
        }
    return {name: answer[name] for name in ("angular_velocity", "attitude") if name in answer} | answer.get(
        "residuals", {}
    )


def curves(document: bytes) -> list[str]:
    figure = ElementTree.fromstring(document)
    return [curve.attrib["points"] for curve in figure.findall("svg:polyline", NAMESPACE)]


def test_the_routes_with_samples() -> None:
    paths = {route.path for route in with_samples()}
    assert {
        "/v1/rotation/trajectory",
        "/v1/rotation/ensemble",
        "/v1/scenes",
        "/v1/certified/scenes/rod-in-hole",
    } <= paths
    assert len(paths) >= 10


@pytest.mark.parametrize("route", [*with_samples()], ids=lambda route: route.path)
def test_each_of_them_has_a_figure(route: PostRoute) -> None:
    assert SVG in route.representations


@pytest.mark.parametrize(("route", "name"), examples(), ids=lambda part: getattr(part, "operation_id", part))
def test_examples_are_drawn_with_every_column(route: PostRoute, name: str) -> None:
    answer = answered(route, route.examples[name].question)
    if has_field(route.answer, "trajectory") and answer.get("trajectory") is None:
        with pytest.raises(InvalidParameter, match="times") as refused:
            route.representations[SVG](answer)
        assert refused.value.remedy
        return
    drawn = curves(route.representations[SVG](answer))
    components = sum(int(np.asarray(values).size / len(values)) for values in columns_of(answer).values())
    if "members" in answer:
        components = 3 * len(answer["members"])
    assert len(drawn) >= components > 0
    paths = sum(name.endswith(".position") for name in (answer.get("trajectory") or {}).get("columns", {}))
    assert len(drawn) <= components + paths


def test_a_curve_has_the_samples_in_the_order_of_time() -> None:
    route = next(route for route in questions() if route.path == "/v1/rotation/trajectory")
    times = [3.0, 0.0, 1.0, 2.0]
    body = {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]}
    answer = answered(route, {"body": body, "angular_velocity": [0.1, 2.0, 0.1], "times": times})
    places = [tuple(map(float, point.split(","))) for point in curves(route.representations[SVG](answer))[1].split()]
    assert [x for x, _ in places] == pytest.approx([LEFT + WIDTH * t / 3.0 for t in range(4)], abs=0.06)
    middle = answer["angular_velocity"][np.argsort(times), 1]
    # Heights fall linearly with the values.
    slope = (places[-1][1] - places[0][1]) / (middle[-1] - middle[0])
    assert slope < 0.0
    assert [y - places[0][1] for _, y in places] == pytest.approx((middle - middle[0]) * slope, abs=0.2)


def test_labels_name_components_and_units() -> None:
    time = np.array([0.0, 1.0])
    panels = over_time(
        time,
        [
            Column("spins", "rad s^-1", np.zeros((2, 2)), "12"),
            Column("rate", "rad s^-1", np.ones(2)),
            Column("attitude", "1", np.ones((2, 4))),
        ],
    )
    assert [panel.up for panel in panels] == ["rad/s", "1"]
    assert [line.label for panel in panels for line in panel.lines] == [
        "spins.1",
        "spins.2",
        "rate",
        *(f"attitude.{axis}" for axis in "wxyz"),
    ]


def test_decimal_strings_are_drawn_unless_doubles_do_not_hold_them() -> None:
    assert numbers(["1.5", "-2e-400"]).tolist() == [1.5, 0.0]
    with pytest.raises(InvalidParameter, match="doubles"):
        numbers(["1e400"])


@pytest.mark.anyio
async def test_it_is_negotiated_and_refused_with_a_remedy() -> None:
    async with client_of(inline_service()) as client:
        question = {
            "body": {"kind": "principal-moments", "moments": [1, 2, 3]},
            "angular_velocity": [0.1, 2, 0.1],
            "times": {"start": 0, "stop": 10, "count": 50},
        }
        path, accept = "/v1/rotation/trajectory", {"accept": SVG}
        figure = await client.post(path, json=question, headers=accept)
        assert (figure.status_code, figure.headers["content-type"]) == (200, SVG)
        assert re.search(r"Free rotation: circulation about the axis of largest moment", figure.text)
        refused = await client.post(path, json=question | {"outputs": ["angular_velocity"]}, headers=accept)
        (error,) = refused.json()["errors"]
        assert (refused.status_code, error["pointer"]) == (422, "/outputs")
        assert error["remedy"]
