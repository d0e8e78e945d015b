"""A certified question is answered with the fields of the ordinary one, and its values to the stated error."""

from __future__ import annotations

from decimal import Context, Decimal
from typing import Any

import orjson
import pytest

from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.requests.request_reader import Limits
from service.responses.json_rows import written
from service.routes import questions
from service.routes.scene_catalogue import scene_catalogue

ALL = {route.path: route for route in questions()}
CERTIFIED = "/v1/certified/"
ROUTES = {
    path: route for path, route in ALL.items() if path.replace("/v1/", CERTIFIED) in ALL and CERTIFIED not in path
}
ANSWERING = RequestHandler(ALL.values(), Budget(), Limits())
FREE, DESCRIBED = "/v1/rotation/", "/v1/scenes"
EXACT = Context(prec=60)

BODIES: dict[str, dict[str, Any]] = {
    "T-handle": {"kind": "principal-moments", "moments": [795.7921810699588, 713.5092592592592, 395.7829218106996]},
    "coin": {"kind": "principal-moments", "moments": [1.0, 1.0, 2.0]},
    "rod-like": {"kind": "principal-moments", "moments": [0.5, 2.0, 2.0]},
    "ball": {"kind": "ball", "radius": 0.3, "mass": 2.0},
    "oblique": {"kind": "inertia-tensor", "tensor": [[2.0, 0.1, 0.2], [0.1, 2.5, 0.3], [0.2, 0.3, 1.8]]},
    "turned coin": {"kind": "inertia-tensor", "tensor": [[1.5, -0.5, 0.0], [-0.5, 1.5, 0.0], [0.0, 0.0, 2.0]]},
    "points": {
        "kind": "point-masses",
        "masses": [1.0, 2.0, 1.0, 0.5],
        "positions": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.3, 1.0]],
    },
    "pinned": {
        "kind": "point-masses",
        "masses": 0.5,
        "positions": [[0.0, 0.0, 0.1], [1.0, 0.0, 0.0], [0.0, 1.5, 0.0], [0.2, 0.3, 1.0]],
        "about": "origin",
    },
    "cylinder": {"kind": "cylinder", "radius": 0.2, "height": 1.3, "mass": 0.7},
    "line": {"kind": "rod", "length": 1.5, "mass": 0.3},
    "composite": {
        "kind": "composite",
        "parts": [
            {"body": {"kind": "cuboid", "edges": [1.0, 0.2, 0.3], "density": 2.0}, "attitude": [1.0, 0.1, 0.2, 0.3]},
            {"body": {"kind": "ball", "radius": 0.1, "mass": 0.5}, "position": [0.5, 0.1, 0.0]},
        ],
    },
    "unphysical": {"kind": "principal-moments", "moments": [1.0, 2.0, 4.0]},
}
OBLIQUE = [BODIES[name] for name in ("oblique", "turned coin", "points", "pinned", "composite")]
STARTS: dict[str, list[float]] = {
    "tumbling": [1.0, 10.0, 1.0],
    "about z": [0.0, 0.0, -2.0],
    "across": [0.5, 1.0, 0.0],
    "at rest": [0.0, 0.0, 0.0],
}
TIMES = {"times": [0.0, 0.37, -2.0, 50.0], "round": None}


def asking() -> list[Any]:
    found = []
    for name, body in BODIES.items():
        for start, w in STARTS.items():
            if name == "line" and w[2]:
                continue
            question = {"body": body, "angular_velocity": w}
            found += [
                pytest.param(FREE + "trajectory", question | TIMES, id=f"trajectory of {name} {start}"),
                pytest.param(
                    FREE + "trajectory",
                    question | TIMES | {"attitude": [0.5, 0.1, -0.7, 0.2], "outputs": ["attitude"]},
                    id=f"attitude of {name} {start}",
                ),
                pytest.param(FREE + "precession", question, id=f"precession of {name} {start}"),
            ]
            if name != "line" and start != "at rest":
                more = {"resolution": 2, "points": 12, "separatrix": True}
                found.append(
                    pytest.param(FREE + "energy-ellipsoid", question | more, id=f"ellipsoid of {name} {start}")
                )
        if name != "line":
            found.append(pytest.param(FREE + "stability", {"body": body, "rate": -3.0}, id=f"stability of {name}"))
            grid = {"body": body, "energy": 2.5, "layout": "grid", "resolution": 3, "polhodes": {"count": 3, "seed": 4}}
            found.append(pytest.param(FREE + "energy-ellipsoid", grid | {"points": 8}, id=f"grid of {name}"))
    on_separatrix = {"body": {"kind": "principal-moments", "moments": [14.0, 21.0, 24.0]}}
    for path, more in (("precession", {}), ("trajectory", TIMES), ("energy-ellipsoid", {"resolution": 1, "points": 8})):
        question = on_separatrix | {"angular_velocity": [6.0, 1.0, 7.0]} | more
        found.append(pytest.param(FREE + path, question, id=f"{path} on the separatrix"))
    for disturbance in ([0.1, 0.2], [0.0, 0.0], [0.2, 0.0]):
        question = {"body": BODIES["T-handle"], "rate": 10.0, "disturbance": disturbance}
        found.append(pytest.param(FREE + "stability", question, id=f"flip by {disturbance}"))
        found.append(
            pytest.param(FREE + "stability", question | {"body": BODIES["oblique"]}, id=f"oblique {disturbance}")
        )
    for path, route in ROUTES.items():
        if path.startswith("/v1/scenes/") and path.replace("/v1/", CERTIFIED) in ALL:
            for name, example in route.examples.items():
                found.append(pytest.param(path, dict(example.question), id=f"{path} {name}"))
    return found


def answered(path: str, question: dict[str, Any]) -> Any:
    route = ALL[path]
    return orjson.loads(written(ANSWERING.answer(route, ANSWERING.read(route, orjson.dumps(question)))))


@pytest.mark.parametrize(("path", "question"), asking())
def test_certified_numbers_are_the_doubles_with_more_digits(path: str, question: dict[str, Any]) -> None:
    few = answered(path, question)
    exact = {name: value for name, value in question.items() if name != "round"}
    many = answered(path.replace("/v1/", CERTIFIED), exact | {"digits": 60})
    assert set(many) == set(few) - {"errors"} | {"accuracy"}
    assert [
        (entry["code"], entry.get("pointer")) for entry in many["warnings"] if entry["code"] != "read-as-double"
    ] == [(entry["code"], entry.get("pointer")) for entry in few["warnings"] if entry["code"] not in OF_DOUBLES]
    stated = few.get("accuracy") or {}
    error = max(stated.get("error") or 0.0, ROUNDING)
    apart = ("accuracy", "errors", "work", "signature", "warnings", "angular_velocity", "attitude")
    for name, bounds in few.get("errors", {}).items():
        within(many[name], few[name], bounds, name)
    oblique = question.get("body") in OBLIQUE
    for name in set(few) - set(apart):
        if name == "model":
            # In doubles the reason ends with the parameter of the functions.
            assert few[name].pop("why").startswith(many[name].pop("why"))
            assert many[name] == few[name]
        elif oblique and path.endswith("ellipsoid") and name in ("axes", "polhodes", "separatrix"):
            # Which way an axis that is not a body axis points is not said: a curve may begin on its other side.
            assert shape(many[name]) == shape(few[name])
        elif path.endswith("stability") and name == "equilibria":
            for found, wanted in zip(many[name], few[name], strict=True):
                if few["symmetry"] in ("oblate", "prolate", "spherical") and oblique:
                    errors = {name: bound for name, bound in wanted["errors"].items() if name != "axis"}
                    found, wanted = found | {"axis": None}, wanted | {"axis": None, "errors": errors}
                compare(found, wanted, error, name)
        else:
            compare(many[name], few[name], error, name)
    for name, bound in (("angular_velocity", error), ("attitude", stated.get("attitude_error"))):
        if name in few:
            size = max(max(abs(x) for x in row) for row in few[name]) if name == "angular_velocity" else 1.0
            for row, rough in zip(many[name], few[name], strict=True):
                assert max(abs(number(x) - Decimal(y)) for x, y in zip(row, rough, strict=True)) <= 2.0 * bound * size


ROUNDING = 4e-14
"""Relative error of what is derived from a body whose axes are oblique: figures state none of their own."""

OF_DOUBLES = (
    "phase-lost",
    "moments-equal-within-rounding",
    "moments-nearly-equal",
    "moment-below-rounding",
    "out-of-range",
)


def compare(many: Any, few: Any, error: float, where: str) -> None:
    """Hold an answer in numerals against one in doubles."""
    if isinstance(few, dict):
        stated = {"value": few["error"]} if "error" in few else few.get("errors", {})
        assert set(many) == set(few) - {"error", "errors"}, where
        for name, value in few.items():
            if name not in ("error", "errors"):
                compare(many[name], value, error, f"{where}/{name}")
                within(many[name], value, stated.get(name), f"{where}/{name}")
    elif isinstance(few, list):
        assert len(many) == len(few), where
        # A component that vanishes is only as right as the others are large.
        size = max((abs(x) for x in few if isinstance(x, float)), default=0.0)
        for x, y in zip(many, few, strict=True):
            if isinstance(y, float):
                assert abs(number(x) - Decimal(y)) <= Decimal(error) * Decimal(size or 1.0), (where, x, y)
            else:
                compare(x, y, error, where)
    elif isinstance(few, float):
        assert abs(number(many) - Decimal(few)) <= Decimal(error) * max(abs(Decimal(few)), Decimal("1e-12")), where
    elif where == "flip/reason":
        assert few.startswith(many)
    else:
        assert many == few, where


def within(many: Any, few: Any, bounds: Any, where: str) -> None:
    """Hold the stated error of a figure, or those of its entries, against its proven digits; of a vector its length."""
    if isinstance(bounds, list):
        for entry in zip(many, few, bounds, strict=True):
            within(*entry, where)
    elif bounds is not None:
        pairs = list(zip(many, few, strict=True)) if isinstance(few, list) else [(many, few)]
        wrong = EXACT.sqrt(sum((EXACT.subtract(number(x), Decimal(y)) ** 2 for x, y in pairs), Decimal(0)))
        # The last of 25 proven digits is rounded.
        assert wrong <= Decimal(bounds) + Decimal("1e-24") * max(abs(Decimal(y)) for _, y in pairs), where


def number(numeral: str) -> Decimal:
    assert isinstance(numeral, str)
    return EXACT.create_decimal(numeral)


def shape(value: Any) -> Any:
    """Return the keys and lengths of a value, without its numbers."""
    if isinstance(value, dict):
        return {name: shape(entry) for name, entry in value.items()}
    return [shape(entry) for entry in value] if isinstance(value, list) else isinstance(value, bool)


SCENES = ("massive-pulley", "yo-yo", "bead-on-hoop", "lagrange-top", "two-masses-two-springs", "dumbbell")
FOR_ALL_OF_IT = {"period", "errors", "phases", "events"}
"""What is answered about described scenes in doubles alone."""


@pytest.mark.parametrize("name", SCENES)
def test_described_scenes_with_proven_digits_are_the_doubles(name: str) -> None:
    question = dict(scene_catalogue()[name].question) | {"times": [0.0, 0.01, -0.005]}
    question.pop("outputs", None)
    few, many = answered(DESCRIBED, question), answered(CERTIFIED + "scenes", question | {"digits": 25})
    assert set(few) - FOR_ALL_OF_IT == set(many)
    for figure in ("accelerations", "forces", "energy"):
        compare(many[figure], few[figure], 1e-15, figure)
    assert many["trajectory"]["rows"] == few["trajectory"]["rows"]
    for column, found in few["trajectory"]["columns"].items():
        proven = many["trajectory"]["columns"][column]
        assert proven["unit"] == found["unit"]
        for row, rough in zip(proven["values"], found["values"], strict=True):
            pairs = zip(row, rough, strict=True) if isinstance(rough, list) else [(row, rough)]
            assert max(abs(number(x) - Decimal(y)) for x, y in pairs) <= Decimal(found["error"])


def test_every_certified_question_is_sent() -> None:
    assert {param.values[0] for param in asking()} | {DESCRIBED} == set(ROUTES)
    assert {path.replace("/v1/", CERTIFIED) for path in ROUTES} == {path for path in ALL if CERTIFIED in path}
    assert len(ROUTES) == 8
