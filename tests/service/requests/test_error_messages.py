"""Slips that clients make, and the words that they are answered with."""

import json
from typing import Any

import pytest

from core.errors import InvalidParameter
from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.problems import LONGEST_REMEDY, MOST_BYTES, Refusal, problem_of
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
    # One form for all: the pointer, what must hold there, a brief remedy, and how many more there are.
    more = f", and {len(document['errors']) - 1} more" if len(document["errors"]) > 1 else ""
    remedy = first.get("remedy", "known here")
    advice = "" if remedy.startswith("known here") or len(remedy) > LONGEST_REMEDY else f" ({remedy})"
    assert document["detail"] == f"{first['pointer'] or 'the document'} {first['detail']}{advice}{more}"
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
    found = errors(asked(times={"start": 0, "stop": 1, "number": 10}))
    assert ("/times/number", "is not known here", "known here: start, stop, count") in found
    found = errors({"body": {**BALL, "h": 1}}, "/v1/bodies/mass-properties")
    assert found == [("/body/h", "is not known here", "known here: radius, kind, mass, density")]


@pytest.mark.parametrize(
    ("kind", "meant"),
    [("principal_moments", "principal-moments"), ("Cuboid", "cuboid"), ("cilinder", "cylinder"), ("box", "cuboid"),
     ("sphere", "ball"), ("Disk", "disc"), ("prism", None),
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
def test_a_vector_of_another_length_is_answered_with_the_right_one(value: Any, detail: str) -> None:
    assert errors(asked(angular_velocity=value)) == [("/angular_velocity", detail, None)]


def test_numbers_in_quotes_and_counts_with_a_point_are_answered_with_how_to_write_them() -> None:
    [(_, detail, remedy), *_] = errors(asked(angular_velocity=["1", "2", "3"]))
    assert (detail, remedy) == (
        "must be a number",
        "write a JSON number: no quotes, no true, false or null; /v1/certified takes decimal strings",
    )
    [(_, detail, remedy)] = errors(asked(times={"start": 0, "stop": 1, "count": 3.0}))
    assert (detail, remedy) == ("must be an integer", 'write a JSON integer: 10, not 10.0, 1e1 or "10"')


def test_a_key_of_another_route_is_distinguished_from_one_that_is_unknown() -> None:
    remedy = "POST /v1/certified/rotation/trajectory answers to any number of digits from 16 to 1000"
    assert errors(asked(digits=30)) == [("/digits", "is not known here", remedy)]


def test_at_most_twenty_faults_are_reported_of_many() -> None:
    assert len(errors({**TRAJECTORY, **{f"k{i}": 1 for i in range(1000)}})) == 20


CHAIN = {
    "masses": [1.0, 2.0],
    "slopes": [0.5, 0.6],
    "gravity": 9.81,
    "length": 1.0,
    "linear_density": 1.0,
    "position": 0.5,
}
ROD = {"hole_radius": 1.0, "length": 1.0, "mass": 1.0, "gravity": 9.81}
IN_RADIANS = "angles are in radians: 30 degrees is 0.5236"


def test_angles_in_degrees_are_reported_to_be_radians() -> None:
    found = errors({**CHAIN, "slopes": [30, 50]}, "/v1/scenes/chain-on-wedge")
    assert found == [(f"/slopes/{k}", "must be at most 1.5708 rad", IN_RADIANS) for k in (0, 1)]
    found = errors({**ROD, "angle": 30.0}, "/v1/scenes/rod-in-hole")
    assert found == [("/angle", "must be at most 3.14159 rad", IN_RADIANS)]


def test_angles_in_degrees_are_reported_to_be_radians_beside_digits() -> None:
    route = ROUTES["/v1/certified/scenes/chain-on-wedge"]
    question = ANSWERING.read(route, json.dumps({**CHAIN, "slopes": ["30", "50"], "digits": 20}).encode())
    with pytest.raises(InvalidParameter) as caught:
        ANSWERING.answer(route, question)
    document = json.loads(problem_of(caught.value).body())
    assert document["detail"] == f"/slopes/0 must be at most 1.5708 rad ({IN_RADIANS})"
    assert document["errors"] == [
        {"pointer": "/slopes/0", "detail": "must be at most 1.5708 rad", "remedy": IN_RADIANS}
    ]


def test_a_bound_is_reported_with_its_unit() -> None:
    found = errors(asked(body={"kind": "principal-moments", "moments": [-1.0, 1.0, 1.0]}))
    assert found == [("/body/moments/0", "must be at least 0 kg m^2", None)]
    found = errors(asked(accuracy=2.0))
    assert found == [("/accuracy", "must be less than 1", None)]


@pytest.mark.parametrize(
    ("question", "path", "pointer", "meant"),
    [
        (asked(outputs=["omega"]), "/v1/rotation/trajectory", "/outputs/0", "angular_velocity"),
        (asked(outputs=["time", "quaternion"]), "/v1/rotation/trajectory", "/outputs/1", "attitude"),
        (asked(outputs=["omega"], digits=20), "/v1/certified/rotation/trajectory", "/outputs/0", "angular_velocity"),
        ({**CHAIN, "outputs": ["tension"]}, "/v1/scenes/chain-on-wedge", "/outputs/0", "apex_tension"),
        ({**CHAIN, "outputs": ["liftoff"]}, "/v1/scenes/chain-on-wedge", "/outputs/0", "lift_off"),
        ({**ROD, "hole": "halfcylinder"}, "/v1/scenes/rod-in-hole", "/hole", "half-cylinder"),
        (asked(method={"kind": "euler", "step": 0.1}), "/v1/rotation/trajectory", "/method/kind", "explicit-euler"),
        (asked(method={"kind": "RK4", "step": 0.1}), "/v1/rotation/trajectory", "/method/kind", "runge-kutta-4"),
        (asked(method={"kind": "dop853"}), "/v1/rotation/trajectory", "/method/kind", "dormand-prince-853"),
    ],
)
def test_a_value_that_is_none_is_answered_with_the_value_that_was_meant(
    question: Any, path: str, pointer: str, meant: str
) -> None:
    found = errors(question, path)
    assert (found[0][0], found[0][2]) == (pointer, f"did you mean '{meant}'?")


@pytest.mark.parametrize("value", [7, None, ["omega"], "o" * 10_000])
def test_a_value_that_resembles_none_is_answered_with_the_values_alone(value: Any) -> None:
    [(pointer, detail, remedy)] = errors(asked(outputs=[value]))
    assert (pointer, detail, remedy) == ("/outputs/0", "must be 'time', 'angular_velocity' or 'attitude'", None)


def test_the_headline_names_the_fault_that_explains_the_others() -> None:
    found = errors(asked(angular_velocity="left out", omega=[1, 2, 3], accuracy=2.0, unheard_of=1))
    assert [pointer for pointer, _, _ in found] == ["/omega", "/accuracy", "/angular_velocity", "/unheard_of"]
    assert found[0][2] == "did you mean angular_velocity?"
    found = errors(asked(**{f"k{i}": 1 for i in range(30)}, Times=[0.0], times="left out"))
    assert found[0] == ("/Times", "is not known here", "did you mean times?")


@pytest.mark.parametrize(
    ("span", "key", "remedy"),
    [
        ({"start": 0, "stop": 10, "step": 0.1}, "step", "count = 101"),
        ({"stop": 10, "dt": 0.1}, "dt", "count = 101"),
        ({"start": 0.0, "stop": 1.0, "step": 0.3}, "step", "count = 4, 0.333333 s apart"),
        ({"start": 5.0, "stop": 0.0, "step": -0.5}, "step", "count = 11"),
    ],
)
@pytest.mark.parametrize("certified", [False, True])
def test_times_by_a_step_are_answered_with_their_number(span: Any, key: str, remedy: str, certified: bool) -> None:
    if certified:
        found = errors(asked(times=span, digits=20), "/v1/certified/rotation/trajectory")
    else:
        found = errors(asked(times=span))
    assert found[0][0] == f"/times/{key}"
    assert found[0][2] == f"give the number of times with both ends in its place: {remedy}"


@pytest.mark.parametrize("step", [0, "x", None, [1], 1e-300, -1.0])
def test_times_by_a_step_that_makes_no_number_are_answered_with_the_formula(step: Any) -> None:
    found = errors(asked(times={"start": 0, "stop": 10, "step": step}))
    assert found[0][2] == "give count, the number of times with both ends: count = (stop - start)/step + 1"


@pytest.mark.parametrize("key", ["torque", "Torques", "external_torque", "gravity", "friction"])
@pytest.mark.parametrize("path", ["/v1/rotation/trajectory", "/v1/rotation/precession", "/v1/rotation/stability"])
def test_a_torque_is_answered_with_that_only_torque_free_motion_is_answered(key: str, path: str) -> None:
    question = {"body": TRAJECTORY["body"], key: [0.0, 0.0, 1.0]}
    pointer, detail, remedy = errors(question, path)[0]
    assert (pointer, detail) == (f"/{key}", "is not known here: only torque-free motion is answered")
    assert "POST /v1/scenes" in str(remedy)


def test_a_torque_on_a_scene_is_any_unknown_key() -> None:
    found = errors({**ROD, "torque": 1.0}, "/v1/scenes/rod-in-hole")
    assert found[0][1] == "is not known here"


def test_an_array_or_a_name_in_place_of_an_object_is_answered_with_what_the_object_has() -> None:
    scene = {"gravity": [0, -9.81], "bodies": [{"mass": 1, "at": [0, 1]}], "times": [0, 1]}
    assert errors(scene, "/v1/scenes") == [
        ("/bodies", "must be an object", 'write {"name": {...}}: its keys are the names of the bodies')
    ]
    sought = {
        "question": {"path": "/v1/scenes", "request": {}},
        "vary": "h",
        "until": {"figure": "/period", "equals": 8},
    }
    [(pointer, detail, remedy)] = errors(sought, "/v1/find")
    assert (pointer, detail) == ("/vary", "must be an object or an array")
    assert remedy == "give an object, or an array of objects, with the keys pointer, between, scale"
    assert errors(asked(times="h")) == [
        ("/times", "must be an object or an array", "give numbers in an array, or start, stop and count in an object")
    ]
