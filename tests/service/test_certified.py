"""Certified questions: answers against independent solutions, strings and doubles as they are, every refusal."""

from __future__ import annotations

from fractions import Fraction
from math import isclose
from typing import Any

import httpx
import mpmath
import orjson
import pytest
from mpmath import mp, mpf

from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.requests.request_reader import Limits
from service.routes import questions
from tests.oracles.free_rotation import flip_interval, period, reference_angular_velocity, reference_attitude
from tests.service.conftest import PATIENCE, Server, client_of, inline_service

SERVICE = inline_service()
TRAJECTORY, PRECESSION, STABILITY, ELLIPSOID = (
    f"/v1/certified/rotation/{name}" for name in ("trajectory", "precession", "stability", "energy-ellipsoid")
)
ROD = "/v1/certified/scenes/rod-in-hole"
HANDLE = (795.7921810699588, 713.5092592592592, 395.7829218106996)
START = (1.0, 10.0, 1.0)
TIMES = [0.0, 0.1, -3.0, 20.0, 1e6]
BODY = {"kind": "principal-moments", "moments": HANDLE}
QUESTION: dict[str, Any] = {"body": BODY, "angular_velocity": START, "times": TIMES, "digits": 50}
LENGTHS: dict[str, Any] = {"hole_radius": "1", "length": "1", "mass": "1", "gravity": "9.8125", "digits": 30}

pytestmark = pytest.mark.anyio


async def asked(path: str, question: Any) -> Any:
    async with client_of(SERVICE) as client:
        return await client.post(path, json=question)


async def answer(path: str, question: Any) -> Any:
    response = await asked(path, question)
    assert response.status_code == 200, response.text
    return response.json()


def ordinary(path: str) -> str:
    """Return the path of the same question in doubles."""
    return path.replace("/v1/certified/", "/v1/")


def farthest(found: list[list[str]], true: Any) -> mpf:
    return max(abs(mpf(x) - y) for row, want in zip(found, true, strict=True) for x, y in zip(row, want, strict=True))


async def test_fifty_digits_of_the_t_handle() -> None:
    found = await answer(TRAJECTORY, QUESTION | {"attitude": [1.0, 0.0, 0.0, 0.0]})
    with mp.workdps(70):
        rates = reference_angular_velocity(HANDLE, START, TIMES, 55)
        assert farthest(found["angular_velocity"], rates) <= mpf("5.1e-49")
        assert farthest(found["attitude"], reference_attitude(HANDLE, START, TIMES, digits=55)) <= mpf("5.1e-51")
        for name, true in (("period", period), ("flip_interval", flip_interval)):
            wanted = true(HANDLE, START, 55)
            assert wanted is not None
            assert abs(mpf(found[name]) / wanted - 1) <= mpf(found["accuracy"]["error"])
        energy = sum(mpf(i) * mpf(w) ** 2 for i, w in zip(HANDLE, START, strict=True)) / 2
        momentum = mp.sqrt(sum((mpf(i) * mpf(w)) ** 2 for i, w in zip(HANDLE, START, strict=True)))
        assert abs(mpf(found["energy"]) / energy - 1) <= mpf("5.1e-50")
        assert abs(mpf(found["angular_momentum"]) / momentum - 1) <= mpf("5.1e-50")
    assert found["accuracy"] == {"requested": 50, "error": "5.1e-50", "how": "ball arithmetic"}
    assert found["work"]["samples"] == len(TIMES)
    assert found["time"][1].startswith("0.1000000000000000055511151231257827")


async def test_one_tenth_is_not_the_double_nearest_to_it() -> None:
    string = await answer(TRAJECTORY, QUESTION | {"times": ["0.1"], "digits": 30})
    double = await answer(TRAJECTORY, QUESTION | {"times": [0.1], "digits": 30})
    assert string["time"] == ["0.100000000000000000000000000000"]
    assert double["time"] == ["0.100000000000000005551115123126"]
    with mp.workdps(40):
        gap = [
            mpf(a) - mpf(b) for a, b in zip(double["angular_velocity"][0], string["angular_velocity"][0], strict=True)
        ]
        late = mpf(0.1) - mpf(1) / 10
        a, b, c = map(mpf, HANDLE)
        x, y, z = map(mpf, string["angular_velocity"][0])
        # Euler's equations say how far the body has turned on in the time between the two.
        for found, rate in zip(gap, ((b - c) * y * z / a, (c - a) * z * x / b, (a - b) * x * y / c), strict=True):
            assert abs(found / (late * rate) - 1) < mpf("1e-10")
    exact = await answer(TRAJECTORY, QUESTION | {"body": {"kind": "cuboid", "edges": ["0.1", 0.2, 0.3], "mass": 1}})
    other = await answer(TRAJECTORY, QUESTION | {"body": {"kind": "cuboid", "edges": [0.1, 0.2, 0.3], "mass": 1}})
    assert isclose(float(exact["energy"]), float(other["energy"]), rel_tol=1e-15)
    assert exact["energy"] != other["energy"]


async def test_the_answer_is_the_one_in_doubles_with_more_digits() -> None:
    for body, start in (
        (BODY, START),
        ({"kind": "principal-moments", "moments": [1.0, 1.0, 2.0]}, [1.0, 1.0, 1.0]),
        ({"kind": "principal-moments", "moments": [1.0, 2.0, 2.0]}, [-1.0, 0.5, 0.25]),
        ({"kind": "inertia-tensor", "tensor": [[2, 0.1, 0.2], [0.1, 2.5, 0.3], [0.2, 0.3, 1.8]]}, [0.3, 1.0, 0.2]),
        ({"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]}, [0.0, 0.0, 2.0]),
        ({"kind": "principal-moments", "moments": [2.0, 2.0, 2.0]}, [0.5, 1.0, 2.0]),
        ({"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]}, [0.0, 0.0, 0.0]),
    ):
        question = {"body": body, "angular_velocity": start}
        times = {"times": {"start": 0.0, "stop": 8.0, "count": 9}, "attitude": [0.0, 1.0, 0.0, 0.0]}
        for path, asking in ((PRECESSION, {}), (TRAJECTORY, times)):
            many = await answer(path, question | asking | {"digits": 20})
            few = await answer(ordinary(path), question | asking)
            names = [
                name for name in many if name not in ("signature", "warnings", "accuracy", "work", "model", "absent")
            ]
            for name in names:
                assert close(many[name], few[name]), (name, many[name], few[name])
            if path == TRAJECTORY:
                assert many["model"]["regime"] == few["model"]["regime"]
            else:
                assert set(many["absent"]) == {name for name in many["absent"] if few[name] is None}


def close(many: Any, few: Any) -> bool:
    if isinstance(many, list):
        return len(many) == len(few) and all(close(a, b) for a, b in zip(many, few, strict=True))
    if many is None or isinstance(few, str):
        return bool(many == few)
    return isclose(float(many), few, rel_tol=1e-12, abs_tol=1e-13)


async def test_equilibria() -> None:
    body = {"kind": "principal-moments", "moments": ["1", "2", "3"]}
    many = await answer(STABILITY, {"body": body, "rate": "10", "digits": 40})
    few = await answer(ordinary(STABILITY), {"body": body | {"moments": [1.0, 2.0, 3.0]}, "rate": 10.0})
    for found, wanted in zip(many["equilibria"], few["equilibria"], strict=False):
        assert found["kind"] == wanted["kind"]
        assert close(found["moment"], wanted["moment"])
        pairs = [sorted([float(x), float(y)] for x, y in entry["eigenvalues"]) for entry in (found, wanted)]
        assert all(close(a, b) for a, b in zip(*pairs, strict=True))
    with mp.workdps(50):
        # W sqrt((B - A)(C - B)/(A C)) about the middle axis.
        assert abs(mpf(many["equilibria"][1]["growth_rate"]) - 10 / mp.sqrt(3)) < mpf("1e-38")
    coin = {"kind": "principal-moments", "moments": [1, 1, 2]}
    ends = (await answer(STABILITY, {"body": coin, "digits": 16}))["equilibria"][:3]
    assert [entry["kind"] for entry in ends] == ["degenerate", "degenerate", "center"]


async def test_the_period_of_a_rod_by_the_complete_integral() -> None:
    found = await answer(ROD, LENGTHS | {"outputs": ["period"]})
    with mp.workdps(45):
        frequency = mp.sqrt(mpf("9.8125") * mp.sqrt(mpf(3)) / 2 / (1 - mpf(1) / 6))
        assert abs(mpf(found["period"]) - 4 * mpmath.ellipk(mpf(1) / 4) / frequency) < mpf("1e-29")


async def test_every_scene_is_the_one_in_doubles_with_more_digits() -> None:
    for route in SERVICE.table:
        if route.path.startswith("/v1/scenes/") and "motion" in route.examples:
            question = dict(route.examples["motion"].question)  # type: ignore[union-attr]
            many = await answer(route.path.replace("/v1/", "/v1/certified/"), question | {"digits": 20})
            few = await answer(route.path, question)
            assert many["model"]["regime"] == few["model"]["regime"]
            assert many["ended"] == few["ended"]
            assert many["work"]["samples"] == few["work"]["samples"]
            assert set(many["trajectory"]) == set(few["trajectory"])
            for name, column in few["trajectory"].items():
                assert close(many["trajectory"][name], column), (route.path, name)


async def test_evenly_spaced_times_are_exactly_so() -> None:
    found = await answer(TRAJECTORY, QUESTION | {"times": {"start": "0", "stop": "1", "count": 4}, "digits": 20})
    assert found["time"] == ["0", "0.33333333333333333333", "0.66666666666666666667", "1.0000000000000000000"]
    alone = await answer(TRAJECTORY, QUESTION | {"times": {"start": "0.3", "stop": "1", "count": 1}})
    assert len(alone["angular_velocity"]) == 1
    assert float(alone["time"][0]) == 0.3


async def test_only_what_is_requested_is_answered() -> None:
    found = await answer(TRAJECTORY, QUESTION | {"outputs": ["attitude"]})
    assert "attitude" in found
    assert not {"time", "angular_velocity"} & set(found)


async def test_a_body_held_away_from_its_centre_of_mass_is_reported_not_to_be_free() -> None:
    """By every answer about it, certified or not."""
    body = {"kind": "composite", "parts": [WALL | {"position": ["3", 0, "4"]}], "about": "origin"}
    plain = {"body": {"kind": "cuboid", "edges": [1.0, 2.0, 0.1], "mass": 3.0}, "position": [3.0, 0.0, 4.0]}
    for path, more in (
        (TRAJECTORY, {"angular_velocity": [1, 2, 3], "times": [1]}),
        (PRECESSION, {"angular_velocity": [1, 2, 3]}),
        (STABILITY, {}),
        (ELLIPSOID, {"energy": 1}),
    ):
        for where, question in (
            (path, {"body": body, "digits": 20}),
            (ordinary(path), {"body": body | {"parts": [plain]}}),
        ):
            (told,) = (await answer(where, question | more))["warnings"]
            assert (told["code"], told["pointer"]) == ("not-free", "/body/about")
            assert "5 m from its centre of mass" in told["detail"]


async def test_a_composite_of_decimal_strings_is_exact() -> None:
    question = QUESTION | {"times": ["0.1"], "digits": 30}
    tenth = WALL | {"body": WALL["body"] | {"edges": ["0.1", "0.2", "0.3"]}, "attitude": ["0.1", "0", 0, "0.1"]}
    found = await answer(TRAJECTORY, question | {"body": {"kind": "composite", "parts": [tenth]}})
    # A quarter of a turn about z takes the edges x and y to each other.
    same = await answer(TRAJECTORY, question | {"body": WALL["body"] | {"edges": ["0.2", "0.1", "0.3"]}})
    for name in ("energy", "angular_velocity", "period", "warnings"):
        assert found[name] == same[name]


async def test_polhodes_drawn_with_a_seed_have_the_energy_exactly() -> None:
    body = {"kind": "principal-moments", "moments": ["2", "1", "0.5"]}
    question = {"body": body, "energy": "0.7", "polhodes": {"count": 3, "seed": 5}, "points": 9, "digits": 40}
    found = await answer(ELLIPSOID, question)
    assert "mesh" not in found
    for curve in found["polhodes"]:
        for point in curve["points"]:
            x, y, z = (Fraction(entry) for entry in point)
            assert abs(2 * x * x + y * y + z * z / 2 - Fraction("1.4")) < Fraction(1, 10**38)
            square = 4 * x * x + y * y + z * z / 4
            assert abs(square - Fraction(curve["angular_momentum"]) ** 2) < Fraction(1, 10**38)


async def test_what_no_matter_can_be_is_warned_of() -> None:
    found = await answer(STABILITY, {"body": {"kind": "principal-moments", "moments": [1, 1, "2.1"]}, "digits": 20})
    assert [(entry["code"], entry["pointer"]) for entry in found["warnings"]] == [
        ("unphysical-inertia", "/body/moments")
    ]
    assert (await answer(STABILITY, {"body": BODY | {"moments": ["1", "1", "2"]}, "digits": 20}))["warnings"] == []


POINTS = {"kind": "point-masses", "masses": 1.0, "positions": [[0, 0, 0], [1, 0, 0], [0, 1, "1"]]}
WALL: dict[str, Any] = {"body": {"kind": "cuboid", "edges": ["1", "2", "0.1"], "mass": "3"}}
COIN = {"kind": "principal-moments", "moments": ["1", "1", "2"]}
LINE = {"kind": "rod", "length": "1", "mass": "1"}
REFUSED: list[tuple[str, dict[str, Any], str, str]] = [
    (TRAJECTORY, {"digits": 15}, "invalid-parameter", "/digits"),
    (TRAJECTORY, {"digits": 1001}, "invalid-parameter", "/digits"),
    (TRAJECTORY, {"digits": "50"}, "invalid-parameter", "/digits"),
    (TRAJECTORY, {"digits": 50.0}, "invalid-parameter", "/digits"),
    (TRAJECTORY, {"digits": True}, "invalid-parameter", "/digits"),
    (TRAJECTORY, {"digits": None}, "invalid-parameter", "/digits"),
    (TRAJECTORY, {"accuracy": 1e-9}, "invalid-parameter", "/accuracy"),
    (TRAJECTORY, {"method": {"kind": "closed-form"}}, "invalid-parameter", "/method"),
    (TRAJECTORY, {"round": 5}, "invalid-parameter", "/round"),
    (TRAJECTORY, {"times": []}, "invalid-parameter", "/times"),
    (TRAJECTORY, {"times": "0.1"}, "invalid-parameter", "/times"),
    (TRAJECTORY, {"times": ["0.1", "1/3"]}, "invalid-parameter", "/times/1"),
    (TRAJECTORY, {"times": ["nan"]}, "invalid-parameter", "/times/0"),
    (TRAJECTORY, {"times": ["1e1001"]}, "invalid-parameter", "/times/0"),
    (TRAJECTORY, {"times": ["1" * 1101]}, "invalid-parameter", "/times/0"),
    (TRAJECTORY, {"times": [True]}, "invalid-parameter", "/times/0"),
    (TRAJECTORY, {"times": {"start": "now", "stop": 1, "count": 3}}, "invalid-parameter", "/times/start"),
    (TRAJECTORY, {"times": {"start": 0, "stop": 1, "count": 10**7}}, "budget-exceeded", "/times/count"),
    (TRAJECTORY, {"times": {"start": 0, "stop": 1, "count": 10**5}}, "budget-exceeded", "/digits"),
    (TRAJECTORY, {"angular_velocity": ["1", "x", "1"]}, "invalid-parameter", "/angular_velocity/1"),
    (TRAJECTORY, {"angular_velocity": ["1", "1"]}, "invalid-parameter", "/angular_velocity"),
    (TRAJECTORY, {"attitude": ["0", 0, 0, "0.0"]}, "invalid-parameter", "/attitude"),
    (TRAJECTORY, {"body": BODY | {"moments": ["1", "-2", "3"]}}, "invalid-parameter", "/body/moments/1"),
    (TRAJECTORY, {"body": BODY | {"moments": [1, 2]}}, "invalid-parameter", "/body/moments"),
    (TRAJECTORY, {"body": BODY | {"mass": "1"}}, "invalid-parameter", "/body/mass"),
    (TRAJECTORY, {"body": {"kind": "composite", "parts": []}}, "invalid-parameter", "/body/parts"),
    (TRAJECTORY, {"body": {"kind": "mesh"}}, "invalid-parameter", "/body/kind"),
    (TRAJECTORY, {"body": {"kind": "ball", "radius": "1", "density": "1"}}, "not-applicable", "/body/density"),
    (TRAJECTORY, {"body": {"kind": "cuboid", "edges": [1, 2, "3"], "mass": -1}}, "invalid-parameter", "/body/mass"),
    (TRAJECTORY, {"body": {"kind": "cuboid", "edges": [1, 2, "3"]}}, "invalid-parameter", "/body/mass"),
    (TRAJECTORY, {"body": {"kind": "rod", "length": 1, "mass": 1}}, "invalid-parameter", "/body"),
    (TRAJECTORY, {"body": POINTS | {"masses": [1, "one", 1]}}, "invalid-parameter", "/body/masses/1"),
    (TRAJECTORY, {"body": POINTS | {"masses": {"all": 1}}}, "invalid-parameter", "/body/masses"),
    (TRAJECTORY, {"body": POINTS | {"masses": None}}, "invalid-parameter", "/body/masses"),
    (TRAJECTORY, {"body": POINTS | {"about": "here"}}, "invalid-parameter", "/body/about"),
    (
        TRAJECTORY,
        {"body": {"kind": "composite", "parts": [WALL | {"colour": 1}]}},
        "invalid-parameter",
        "/body/parts/0/colour",
    ),
    (
        TRAJECTORY,
        {"body": {"kind": "composite", "parts": [WALL | {"body": WALL["body"] | {"edges": ["1", "x", 3]}}]}},
        "invalid-parameter",
        "/body/parts/0/body/edges/1",
    ),
    (
        TRAJECTORY,
        {"body": {"kind": "composite", "parts": [WALL | {"body": {"kind": "ball", "radius": 1, "density": "1"}}]}},
        "not-applicable",
        "/body/parts/0/body/density",
    ),
    (TRAJECTORY, {"body": {"kind": "composite", "parts": [WALL] * 101}}, "budget-exceeded", "/body/parts"),
    (ELLIPSOID, {}, "invalid-parameter", "/energy"),
    (ELLIPSOID, {"energy": "0"}, "invalid-parameter", "/energy"),
    (ELLIPSOID, {"energy": "1", "points": 7, "separatrix": True}, "invalid-parameter", "/points"),
    (ELLIPSOID, {"energy": "1", "resolution": 0}, "invalid-parameter", "/resolution"),
    (ELLIPSOID, {"energy": "1", "layout": "grid", "resolution": 1}, "invalid-parameter", "/resolution"),
    (ELLIPSOID, {"energy": "1", "layout": "cubes"}, "invalid-parameter", "/layout"),
    (ELLIPSOID, {"energy": "1", "resolution": 201}, "budget-exceeded", "/digits"),
    (ELLIPSOID, {"energy": "1", "polhodes": {"count": 10**6}}, "budget-exceeded", "/polhodes/count"),
    (ELLIPSOID, {"energy": "1", "polhodes": {"count": 100}}, "budget-exceeded", "/digits"),
    (STABILITY, {"disturbance": ["1", "x"]}, "invalid-parameter", "/disturbance/1"),
    (STABILITY, {"body": COIN, "disturbance": ["1", "1"]}, "not-applicable", "/disturbance"),
    (STABILITY, {"body": LINE}, "invalid-parameter", "/body"),
    (TRAJECTORY, {"body": LINE}, "invalid-parameter", "/body"),
    (PRECESSION, {"measure": None}, "invalid-parameter", "/measure"),
    (STABILITY, {"rate": "fast"}, "invalid-parameter", "/rate"),
    (ROD, {"times": [0, "1e301"]}, "invalid-parameter", "/times/1"),
    (ROD, {"times": {"start": 0, "stop": "-1e301", "count": 2}}, "invalid-parameter", "/times"),
    (ROD, {"mass": "heavy"}, "invalid-parameter", "/mass"),
    (ROD, {"mass": "1e400"}, "invalid-parameter", "/mass"),
    (ROD, {"length": "2"}, "invalid-parameter", "/length"),
    (ROD, {"outputs": ["music"]}, "invalid-parameter", "/outputs/0"),
    (ROD, {"outputs": ["trajectory"]}, "invalid-parameter", "/times"),
    (ROD, {"hole": "square"}, "invalid-parameter", "/hole"),
    (ROD, {"digits": 1000, "times": {"start": 0, "stop": 1, "count": 10**4}}, "budget-exceeded", "/digits"),
]


def whole(path: str) -> dict[str, Any]:
    if path == ROD:
        return LENGTHS
    left_out = {TRAJECTORY: (), PRECESSION: ("times",)}.get(path, ("times", "angular_velocity"))
    return {name: value for name, value in QUESTION.items() if name not in left_out}


@pytest.mark.parametrize(("path", "change", "code", "pointer"), REFUSED, ids=lambda value: str(value)[:60])
async def test_refusals(path: str, change: dict[str, Any], code: str, pointer: str) -> None:
    response = await asked(path, whole(path) | change)
    problem = response.json()
    assert (response.status_code, problem["code"]) == (422, code), problem
    assert pointer in [fault["pointer"] for fault in problem["errors"]], problem
    if code == "budget-exceeded":
        assert problem["needed"] > problem["limit"]


@pytest.mark.parametrize(
    ("change", "pointers"),
    [
        ({"times": [0.0, "0.1"]}, ["/times/1"]),
        ({"angular_velocity": [1.0, "10", 1.0]}, ["/angular_velocity/1"]),
        ({"body": BODY | {"moments": [1.0, 2.0, "2.5"]}}, ["/body/moments/2"]),
        (
            {"body": {"kind": "point-masses", "masses": 1.0, "positions": [[0.0, "1", 0.0]] * 4}},
            ["/body/positions/0/1"],
        ),
        ({"body": BODY | {"digits": 50}}, ["/body/digits"]),
    ],
    ids=str,
)
async def test_strings_are_no_numbers_in_ordinary_questions(change: dict[str, Any], pointers: list[str]) -> None:
    question = {name: value for name, value in QUESTION.items() if name != "digits"} | change
    response = await asked(ordinary(TRAJECTORY), question)
    assert response.status_code == 422
    faults = response.json()["errors"]
    assert [fault["pointer"] for fault in faults] == pointers
    if not pointers[0].endswith("digits"):
        assert all(fault["detail"] == "must be a number" and "/v1/certified" in fault["remedy"] for fault in faults)


ONLY_ORDINARY = [
    (TRAJECTORY, "accuracy", 1e-9),
    (TRAJECTORY, "method", {"kind": "explicit-euler", "step": 0.1}),
    (TRAJECTORY, "round", 5),
    (TRAJECTORY, "input_uncertainty", 1e-9),
    (PRECESSION, "measure", {"method": {"kind": "runge-kutta-4", "step": 0.1}, "duration": 5.0, "samples": 10}),
]


@pytest.mark.parametrize(("path", "name", "value"), ONLY_ORDINARY, ids=lambda value: str(value)[:40])
async def test_what_a_certified_question_lacks_is_refused_with_the_reason_and_where_it_belongs(
    path: str, name: str, value: Any
) -> None:
    fault = (await asked(path, whole(path) | {name: value})).json()["errors"][0]
    assert fault["pointer"] == f"/{name}"
    assert fault["detail"] == "is not known here"
    assert fault["remedy"].endswith(f"; POST {ordinary(path)} takes it")


@pytest.mark.parametrize(("path", "question"), [(TRAJECTORY, QUESTION), (ROD, LENGTHS)], ids=["trajectory", "rod"])
async def test_digits_sent_to_an_ordinary_route_name_the_certified_one(path: str, question: dict[str, Any]) -> None:
    faults = (await asked(ordinary(path), question)).json()["errors"]
    [fault] = [fault for fault in faults if fault["pointer"] == "/digits"]
    assert fault["detail"] == "is not known here"
    assert f"POST {path} " in fault["remedy"]


async def test_digits_are_required() -> None:
    question = {name: value for name, value in QUESTION.items() if name != "digits"}
    assert (await asked(TRAJECTORY, question)).json()["errors"] == [{"pointer": "/digits", "detail": "is required"}]


@pytest.mark.parametrize("kind", ["mesh", "cubiod"])
async def test_a_kind_that_has_no_certified_form_is_answered_with_those_that_have(kind: str) -> None:
    [fault] = (await asked(TRAJECTORY, QUESTION | {"body": {"kind": kind}})).json()["errors"]
    assert fault["pointer"] == "/body/kind"
    assert "'cuboid'" in fault["detail"]


@pytest.mark.parametrize("twice", [b'"digits": 20, "digits": 21', b'"digits": 20, "\\u0064igits": 20'])
async def test_digits_given_twice_are_refused_as_that(twice: bytes) -> None:
    body = orjson.dumps(QUESTION).replace(b'"digits":50', twice)
    async with client_of(SERVICE) as client:
        response = await client.post(TRAJECTORY, content=body, headers={"content-type": "application/json"})
    problem = response.json()
    assert (response.status_code, problem["code"]) == (400, "duplicate-key")
    assert [fault["pointer"] for fault in problem["errors"]] == ["/digits"]


def test_none_runs_in_the_server() -> None:
    routes = questions()
    answering = RequestHandler(routes, Budget(), Limits())
    asking = [
        (route, dict(example.question))
        for route in routes
        for example in route.examples.values()
        if "digits" in example.question
    ]
    assert len({route.path for route, _ in asking}) >= 6
    for route, question in asking:
        read = answering.read(route, orjson.dumps(question))
        assert not route.small(read)


def test_over_a_socket_from_a_compute_process(server: Server) -> None:
    question = QUESTION | {"digits": 30, "times": {"start": 0, "stop": 20, "count": 200}}
    found = httpx.post(server.url + TRAJECTORY, json=question, timeout=PATIENCE)
    assert found.status_code == 200
    assert len(found.json()["angular_velocity"]) == 200
    assert httpx.post(server.url + TRAJECTORY, json=question, timeout=PATIENCE).content == found.content


@pytest.mark.parametrize("time", ["1e-310", "3e153", "1e155"])
async def test_digits_are_answered_where_squares_of_the_places_are_no_doubles(time: str) -> None:
    """The fall is exact; its check in doubles, which cannot be made there, withheld it."""
    scene = {"gravity": [0, "-9.75"], "bodies": {"stone": {"mass": 1, "at": [0, 0]}}, "times": [time], "digits": 20}
    columns = (await answer("/v1/certified/scenes", scene))["trajectory"]["columns"]
    ((_, fallen),) = columns["stone.position"]["values"]
    with mp.workdps(40):
        assert abs(mpf(fallen) / (mpf("-4.875") * mpf(time) ** 2) - 1) < mpf("1e-19")
