"""Slips that clients make, and the words that they are answered with."""

import json
from typing import Any

import pytest

from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.problems import MOST_BYTES, Refusal
from service.requests.request_reader import Limits
from service.routes import questions

ROUTES = {route.path: route for route in questions()}
ANSWERING = RequestHandler(ROUTES.values(), Budget(), Limits())
TRAJECTORY = {
    "body": {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]},
    "angular_velocity": [0.1, 1.0, 0.1],
    "times": {"start": 0.0, "stop": 1.0, "count": 3},
}
BALL = {"kind": "ball", "mass": 1.0, "radius": 1.0}


def errors(question: Any, path: str = "/v1/rotation/trajectory") -> list[tuple[str, str, str | None]]:
    with pytest.raises(Refusal) as caught:
        ANSWERING.read(ROUTES[path], json.dumps(question).encode())
    body = caught.value.problem.body()
    assert len(body) <= MOST_BYTES
    document = json.loads(body)
    first = document["errors"][0]
    # One form for all: the pointer, what must hold there, and how many more there are.
    more = f", and {len(document['errors']) - 1} more" if len(document["errors"]) > 1 else ""
    assert document["detail"] == f"{first['pointer'] or 'the document'} {first['detail']}{more}"
    return [(entry["pointer"], entry["detail"], entry.get("remedy")) for entry in document["errors"]]


def asked(**changes: Any) -> dict[str, Any]:
    return {key: value for key, value in {**TRAJECTORY, **changes}.items() if value != "left out"}


@pytest.mark.parametrize(
    ("changes", "pointer", "meant"),
    [
        ({"angular_velocty": [1, 2, 3]}, "/angular_velocty", "angular_velocity"),
        ({"angularVelocity": [1, 2, 3]}, "/angularVelocity", "angular_velocity"),
        ({"Times": 1}, "/Times", "times"),
        ({"body": {**BALL, "radius_": 1}}, "/body/radius_", "radius"),
        ({"method": {"kind": "radau", "tolerence": 1e-9}}, "/method/tolerence", "tolerance"),
        ({"body": {"kind": "composite", "parts": [{"body": {**BALL, "mas": 1}}]}}, "/body/parts/0/body/mas", "mass"),
        ({"times": {"start": 0, "stop": 1, "counts": 3}}, "/times/counts", "count"),
    ],
)
def test_a_slip_in_a_key_is_answered_with_the_key_that_was_meant(changes: Any, pointer: str, meant: str) -> None:
    assert (pointer, "is not known here", f"did you mean {meant}?") in errors(asked(**changes))


def test_any_other_key_is_answered_with_the_keys_that_there_are() -> None:
    found = errors(asked(times={"start": 0, "stop": 1, "step": 0.1}))
    assert ("/times/step", "is not known here", "known here: start, stop, count") in found
    found = errors({"body": {**BALL, "h": 1}}, "/v1/bodies/mass-properties")
    assert found == [("/body/h", "is not known here", "known here: radius, kind, mass, density")]


@pytest.mark.parametrize(
    ("kind", "meant"),
    [("principal_moments", "principal-moments"), ("Cuboid", "cuboid"), ("cilinder", "cylinder"), ("box", None),
     (None, None), (3, None), ("k" * 10_000, None)],
)  # fmt: skip
def test_a_kind_that_is_none_is_answered_with_the_kinds(kind: Any, meant: str | None) -> None:
    [(pointer, detail, remedy)] = errors(asked(body={"kind": kind}))
    assert pointer == "/body/kind"
    assert detail.startswith("must be one of 'principal-moments', ")
    assert remedy == (meant and f"did you mean '{meant}'?")


@pytest.mark.parametrize("value", ["runge-kutta-4", 4, ["radau"], True])
def test_a_name_in_place_of_an_object_is_answered_with_how_to_write_it(value: Any) -> None:
    [(pointer, detail, remedy)] = errors(asked(method=value))
    assert (pointer, detail) == ("/method", "must be an object")
    assert remedy is not None
    assert remedy.startswith('write {"kind": ...}, one of closed-form, ')


def test_a_missing_kind_is_answered_with_the_kinds() -> None:
    [(pointer, detail, remedy)] = errors(asked(body={"moments": [1, 2, 3]}))
    assert (pointer, detail) == ("/body", "must have the key 'kind'")
    assert remedy is not None
    assert remedy.endswith("composite, mesh")


@pytest.mark.parametrize(
    ("value", "detail"),
    [
        ([1.0, 2.0], "must have 3 entries, not 2"),
        ([1.0, 2.0, 3.0, 4.0], "must have 3 entries, not 4"),
        ({"x": 1.0, "y": 2.0, "z": 3.0}, "must be an array of 3 entries"),
        (3.0, "must be an array of 3 entries"),
    ],
)
def test_a_vector_of_another_length_is_told_the_right_one(value: Any, detail: str) -> None:
    assert errors(asked(angular_velocity=value)) == [("/angular_velocity", detail, None)]


def test_numbers_in_quotes_and_counts_with_a_point_are_told_how_to_write_them() -> None:
    [(_, detail, remedy), *_] = errors(asked(angular_velocity=["1", "2", "3"]))
    assert (detail, remedy) == (
        "must be a number",
        "write a JSON number: no quotes, no true, false or null; /v1/certified takes decimal strings",
    )
    [(_, detail, remedy)] = errors(asked(times={"start": 0, "stop": 1, "count": 3.0}))
    assert (detail, remedy) == ("must be an integer", 'write a JSON integer: 10, not 10.0, 1e1 or "10"')


def test_a_key_of_another_route_is_told_apart_from_one_that_is_unknown() -> None:
    remedy = "POST /v1/certified/rotation/trajectory answers to any number of digits from 16 to 1000"
    assert errors(asked(digits=30)) == [("/digits", "is not known here", remedy)]


def test_at_most_twenty_faults_are_told_of_many() -> None:
    assert len(errors({**TRAJECTORY, **{f"k{i}": 1 for i in range(1000)}})) == 20
