"""Assessments over HTTP: verdicts, units, errors that point into the submission, and what is not revealed."""

from __future__ import annotations

import io
import json
import math
import random
from decimal import Decimal
from typing import Any
from zipfile import ZipFile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.assessment.units import base_powers
from core.systems.budget import Budget
from core.work import work_limit
from service.execution.request_handler import RequestHandler
from service.requests.request_reader import Limits
from service.responses.json_rows import written
from service.routes import questions
from tests.drawn import draws
from tests.service.conftest import client_of, inline_service

PATH = "/v1/assessments"
SERVICE = inline_service()
ROUTES = {route.path: route for route in questions()}
HANDLER = RequestHandler(ROUTES.values(), Budget(), Limits())
Body = dict[str, Any]

MOMENTS = [795.7921810699588, 713.5092592592592, 395.7829218106996]
FLIP = {
    "path": "/v1/rotation/precession",
    "request": {"body": {"kind": "principal-moments", "moments": MOMENTS}, "angular_velocity": [1, 10, 1]},
}
INTERVAL = 2.453763073790956
COIN = {
    "path": "/v1/rotation/precession",
    "request": {"body": {"kind": "principal-moments", "moments": [1, 1, 2]}, "angular_velocity": [1, 1, 1]},
}
ROD = {
    "path": "/v1/scenes/rod-in-hole",
    "request": {"hole_radius": 1.0, "length": 1.0, "mass": 1.0, "gravity": 9.81},
}
HORIZONTAL = "/angular_velocity_at_horizontal"
STABILITY = {
    "path": "/v1/rotation/stability",
    "request": {"body": {"kind": "principal-moments", "moments": [2, 1, 0.5]}, "rate": 1},
}
PLANET = {"path": "/v1/rotation/wobble", "request": {"period": 430}}
DUMBBELLS = {
    "path": "/v1/bodies/mass-properties",
    "request": {
        "body": {
            "kind": "point-masses",
            "masses": [0.1, 0.3, 0.7, 0.2],
            "positions": [[0.1, 0, 0.7], [0.3, 1.1, 0], [0.2, 0.9, 2.3], [1.7, 0.4, 0.3]],
        }
    },
}
MOTION = {
    "path": "/v1/rotation/trajectory",
    "request": {
        "body": {"kind": "principal-moments", "moments": [1, 2, 3]},
        "angular_velocity": [0.1, 2, 0.1],
        "times": [0, 1],
    },
}

pytestmark = pytest.mark.anyio


def handled(question: Any, *submissions: Any, **more: Any) -> Any:
    route = ROUTES[PATH]
    body = json.dumps({"question": question, "submissions": submissions, **more}).encode()
    return json.loads(written(HANDLER.answer(route, HANDLER.read(route, body))))


async def asked(question: Any, *submissions: Any, **more: Any) -> Any:
    async with client_of(SERVICE) as client:
        return await client.post(PATH, json={"question": question, "submissions": submissions, **more})


async def graded(question: Any, *submissions: Any, **more: Any) -> Any:
    response = await asked(question, *submissions, **more)
    assert response.status_code == 200, response.text
    return response.json()


async def verdict(question: Any, pointer: str, claim: Any, **more: Any) -> str:
    (result,) = (await graded(question, {pointer: claim}, **more))["results"]
    assert result["format_errors"] == []
    return str(result["tests"][0]["verdict"])


@pytest.mark.parametrize("largest", [1e15, 1e17, 1e100])
async def test_a_wrong_period_beside_a_moment_that_exceeds_the_others_is_judged(largest: float) -> None:
    body = {"kind": "principal-moments", "moments": [1.0, 2.0, largest]}
    question = {"path": "/v1/rotation/precession", "request": {"body": body, "angular_velocity": [0.0, 0.1, 1.0]}}
    assert await verdict(question, "/period", {"value": 1e3, "unit": "s"}) == "incorrect"


async def test_the_reference_is_the_answer_with_its_error_and_its_unit() -> None:
    answer = await graded(FLIP, {"/flip_interval": {"value": 2.45, "unit": "s"}})
    (reference,) = answer["reference"]
    assert reference["value"] == INTERVAL
    assert reference["unit"] == "s"
    assert 0.0 < reference["error"] < 1e-15 * INTERVAL
    assert 0.0 < reference["inherited"] < 1e-13
    (result,) = answer["results"]
    assert result["score"] == 1.0
    assert result["correct"]
    (test,) = result["tests"]
    assert test["error"]["absolute"] == pytest.approx(INTERVAL - 2.45)
    assert test["error"]["relative"] == pytest.approx((INTERVAL - 2.45) / INTERVAL)
    assert test["error"]["in_tolerances"] == pytest.approx(test["error"]["absolute"] / test["error"]["tolerance"])


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [
        (INTERVAL, "s", "correct"),
        (INTERVAL / 60, "min", "correct"),
        (INTERVAL / 3600, "hours", "correct"),
        (INTERVAL * 1e3, "ms", "correct"),
        (INTERVAL, "ms", "incorrect"),
        (INTERVAL, None, "missing-unit"),
        (INTERVAL, "", "missing-unit"),
        (INTERVAL, " ", "missing-unit"),
        (INTERVAL, "m", "wrong-unit"),
        (INTERVAL, "parsec per fortnight", "wrong-unit"),
    ],
)
async def test_units_are_converted_and_missing_or_wrong_ones_are_verdicts(
    value: float, unit: str | None, expected: str
) -> None:
    claim = {"value": value} | ({} if unit is None else {"unit": unit})
    assert await verdict(FLIP, "/flip_interval", claim) == expected


async def test_rates_may_be_in_turns_and_angles_without_a_unit() -> None:
    rate = math.sqrt(6.0)
    for value, unit in ((rate, "rad/s"), (rate * 30 / math.pi, "rpm"), (rate / (2 * math.pi), "Hz")):
        assert await verdict(COIN, "/space_rate", {"value": value, "unit": unit}) == "correct"
    angle = math.atan2(math.sqrt(2.0), 2.0)
    assert await verdict(COIN, "/axis_to_angular_momentum", {"value": angle}) == "correct"
    assert await verdict(COIN, "/axis_to_angular_momentum", {"value": math.degrees(angle), "unit": "deg"}) == "correct"
    (result,) = (await graded(COIN, {"/axis_to_angular_momentum": {"value": math.degrees(angle)}}))["results"]
    assert result["matches"] == ["degrees"]


@pytest.mark.parametrize(
    ("comparison", "value", "expected"),
    [
        ({"kind": "relabs", "rtol": 1e-3}, 3.195, "correct"),
        ({"kind": "relabs", "rtol": 1e-4}, 3.195, "incorrect"),
        ({"kind": "relabs", "rtol": 0.0, "atol": 0.01}, 3.2, "correct"),
        ({"kind": "sigfig", "digits": 3}, 3.19, "correct"),
        ({"kind": "sigfig", "digits": 4}, 3.19, "incorrect"),
        ({"kind": "decdig", "digits": 1}, 3.2, "correct"),
        ({"kind": "decdig", "digits": 2}, 3.2, "incorrect"),
        ({"kind": "interval", "lower": 3.0, "upper": 3.5}, 3.4, "correct"),
        ({"kind": "interval", "lower": 3.0, "upper": 3.5}, 3.6, "incorrect"),
        ({"kind": "interval", "lower": 3.3, "upper": 3.5}, 3.4, "not-gradable"),
        ({"kind": "relabs", "rtol": 1e-17, "atol": 0.0}, 3.1929376839127963, "not-gradable"),
        ({"kind": "sigfig", "digits": 15}, 3.19293768391280, "correct"),
    ],
)
async def test_comparisons_decide(comparison: Body, value: float, expected: str) -> None:
    assert await verdict(ROD, HORIZONTAL, {"value": value, "unit": "rad/s"}, comparison=comparison) == expected


async def test_the_data_justify_what_follows_from_their_uncertainty() -> None:
    # omega is proportional to the root of g: 9.8 for 9.81 changes it by half of 0.1 %.
    more = {"comparison": {"kind": "data"}, "input_uncertainties": {"/gravity": 0.01 / 9.81}}
    value = 3.1929376839127963 * math.sqrt(9.8 / 9.81)
    assert await verdict(ROD, HORIZONTAL, {"value": value * 1.00001, "unit": "rad/s"}, **more) == "correct"
    assert await verdict(ROD, HORIZONTAL, {"value": value * 0.9999, "unit": "rad/s"}, **more) == "incorrect"
    fine = {"comparison": {"kind": "sigfig", "digits": 6}, "input_uncertainty": 1e-3}
    assert await verdict(ROD, HORIZONTAL, {"value": 3.19294, "unit": "rad/s"}, **fine) == "not-gradable"


async def test_zero_is_accepted_for_zero_and_not_for_something_small() -> None:
    small = {"path": "/v1/bodies/mass-properties", "request": {"body": {"kind": "ball", "mass": 1e-5, "radius": 1e-2}}}
    moments = [4e-10, 4e-10, 4e-10]
    assert await verdict(small, "/principal/moments", {"value": moments, "unit": "kg m^2"}) == "correct"
    assert await verdict(small, "/principal/moments", {"value": [0, 0, 0], "unit": "kg m^2"}) == "incorrect"
    level = {
        "path": "/v1/scenes/unwinding-shafts",
        "request": {"masses": [1, 1], "radii": [1, 1], "slopes": [0.5, 0.5], "gravity": 9.81},
    }
    assert await verdict(level, "/string_acceleration", {"value": 1e-12, "unit": "m/s^2"}) == "correct"
    assert await verdict(level, "/string_acceleration", {"value": 1e-3, "unit": "m/s^2"}) == "incorrect"


async def test_choices_sets_and_figures_that_do_not_exist() -> None:
    assert await verdict(STABILITY, "/equilibria/1/stable", {"value": False}) == "correct"
    assert await verdict(STABILITY, "/equilibria/1/stable", {"value": True}) == "incorrect"
    assert await verdict(STABILITY, "/equilibria/1/kind", {"value": "saddle"}) == "correct"
    values = [[0.0, 0.0], [-math.sqrt(0.5), 0.0], [math.sqrt(0.5), 0.0]]
    assert await verdict(STABILITY, "/equilibria/1/eigenvalues", {"value": values, "unit": "1/s"}) == "correct"
    assert await verdict(COIN, "/flip_interval", {"value": None}) == "correct"
    assert await verdict(COIN, "/flip_interval", {"value": 3.0, "unit": "s"}) == "incorrect"
    assert await verdict(FLIP, "/flip_interval", {"value": None}) == "incorrect"


async def test_principal_axes_are_right_up_to_sign_and_rotation_among_equal_moments() -> None:
    body = {
        "path": "/v1/bodies/mass-properties",
        "request": {"body": {"kind": "cylinder", "mass": 1, "radius": 1, "height": 5}},
    }
    c, s = math.cos(0.3), math.sin(0.3)
    # The axis of the cylinder is the one of smallest moment.
    axes = [[0, -c, s], [0, s, c], [-1, 0, 0]]
    assert await verdict(body, "/principal/axes", {"value": axes}) == "correct"
    assert await verdict(body, "/principal/axes", {"value": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}) == "incorrect"


async def test_samples_are_judged_at_the_times_of_the_student() -> None:
    times = [0.0, 0.7, -3.2, 11.0]
    async with client_of(SERVICE) as client:
        request = {**MOTION["request"], "times": times}
        rows = (await client.post(MOTION["path"], json=request)).json()["angular_velocity"]
    claim = {"times": times, "value": rows, "unit": "rad/s"}
    assert await verdict(MOTION, "/angular_velocity", claim) == "correct"
    rows[2][1] += 0.1
    assert await verdict(MOTION, "/angular_velocity", claim) == "incorrect"


GOOD = {"/flip_interval": {"value": 2.4538, "unit": "s"}}


@pytest.mark.parametrize(
    ("submission", "pointer"),
    [
        (None, ""),
        (3, ""),
        ([], ""),
        ({}, ""),
        ({"flip_interval": {"value": 1.0}}, "/flip_interval"),
        ({"/nothing": {"value": 1.0}}, "/~1nothing"),
        ({"/flip_interval/3": {"value": 1.0}}, "/~1flip_interval~13"),
        ({"/absent": {"value": 1.0}}, "/~1absent"),
        ({"/__class__": {"value": 1.0}}, "/~1__class__"),
        ({"/flip_interval": 2.45}, "/~1flip_interval"),
        ({"/flip_interval": {"unit": "s"}}, "/~1flip_interval/value"),
        ({"/flip_interval": {"value": 2.45, "units": "s"}}, "/~1flip_interval/units"),
        ({"/flip_interval": {"value": "2.45", "unit": "s"}}, "/~1flip_interval/value"),
        ({"/flip_interval": {"value": True, "unit": "s"}}, "/~1flip_interval/value"),
        ({"/flip_interval": {"value": [2.45], "unit": "s"}}, "/~1flip_interval/value"),
        ({"/flip_interval": {"value": {"x": 1}, "unit": "s"}}, "/~1flip_interval/value"),
        ({"/flip_interval": {"value": 10**400, "unit": "s"}}, "/~1flip_interval/value"),
        ({"/flip_interval": {"value": 2.45, "unit": 3}}, "/~1flip_interval/unit"),
        ({"/axis": {"value": [1, 2]}}, "/~1axis/value"),
        ({"/axis": {"value": [1, "2", 3]}}, "/~1axis/value/1"),
        ({"/axis": {"value": [[1, 2], [3]]}}, "/~1axis/value/1"),
        ({"/axis": {"value": [0, 0, 0]}}, "/~1axis/value"),
        ({"/flip_interval": {"value": [1, 2], "times": [1, 2], "unit": "s"}}, "/~1flip_interval/times"),
        ({"/flip_interval": {"value": [1], "times": [1, 2], "unit": "s"}}, "/~1flip_interval/value"),
        ({"/flip_interval": {"value": 1e308, "unit": "d"}}, "/~1flip_interval/value"),
    ],
    ids=str,
)
async def test_a_bad_submission_has_its_errors_and_spoils_no_other(submission: Any, pointer: str) -> None:
    bad, good = (await graded(FLIP, submission, GOOD))["results"]
    assert good["correct"]
    assert [fault["pointer"] for fault in bad["format_errors"]] == [f"/submissions/0{pointer}"]
    assert (bad["score"], bad["correct"], bad["gradable"]) == (None, None, False)
    assert bad["format_errors"][0]["detail"].startswith(("must", "is"))


@pytest.mark.parametrize("text", ["NaN", "Infinity", "-Infinity", "1e999"])
async def test_what_is_not_finite_is_no_number(text: str) -> None:
    body = json.dumps({"question": FLIP, "submissions": [{"/flip_interval": {"value": 0, "unit": "s"}}, GOOD]})
    async with client_of(SERVICE) as client:
        headers = {"content-type": "application/json"}
        response = await client.post(PATH, content=body.replace('"value": 0', f'"value": {text}'), headers=headers)
    if response.status_code == 200:
        bad, good = response.json()["results"]
        assert bad["format_errors"][0]["detail"] == "must be finite"
        assert good["correct"]
    else:
        assert response.json()["code"] == "invalid-json"


@pytest.mark.parametrize(
    ("change", "pointer"),
    [
        ({"question": {"path": "/v1/rotation/precesion", "request": {}}}, "/question/path"),
        ({"question": {"path": PATH, "request": {}}}, "/question/path"),
        ({"question": {"path": FLIP["path"], "request": {}}}, "/question/request/body"),
        (
            {"question": {**FLIP, "request": {**FLIP["request"], "angular_velocity": [1, 2]}}},
            "/question/request/angular_velocity",
        ),
        ({"comparison": {"kind": "relabs", "rtol": -1.0}}, "/comparison/rtol"),
        ({"comparison": {"kind": "interval", "lower": 2.0, "upper": 1.0}}, "/comparison/upper"),
        ({"comparison": {"kind": "exactly"}}, "/comparison/kind"),
        ({"comparisons": {"/flip_interval": {"kind": "sigfig", "digits": 0}}}, "/comparisons/~1flip_interval/digits"),
        ({"comparisons": {"/flip_intervall": {"kind": "sigfig"}}}, "/comparisons/~1flip_intervall"),
        ({"comparisons": {"flip_interval": {"kind": "sigfig"}}}, "/comparisons/flip_interval"),
        ({"credits": {"factor-2": 2.0}}, "/credits/factor-2"),
        ({"credits": {"unknown": 0.5}}, "/credits/unknown"),
        ({"input_uncertainties": {"/gravity": 0.1}}, "/input_uncertainties/~1gravity"),
        ({"submissions": []}, "/submissions"),
        ({"reveal": "no"}, "/reveal"),
    ],
    ids=str,
)
async def test_faults_of_the_assessment_itself_are_refused(change: Body, pointer: str) -> None:
    body = {"question": FLIP, "submissions": [GOOD]} | change
    async with client_of(SERVICE) as client:
        response = await client.post(PATH, json=body)
    assert response.status_code == 422, response.text
    assert response.json()["errors"][0]["pointer"] == pointer


async def test_a_course_may_change_credits_and_compare_figures_differently() -> None:
    twice = {"/flip_interval": {"value": 2 * INTERVAL, "unit": "s"}}
    (result,) = (await graded(FLIP, twice, credits={"period-for-flip-interval": 0.8}))["results"]
    assert result["score"] == 0.8
    claims = {"/flip_interval": {"value": 2.46, "unit": "s"}, "/period": {"value": 4.92, "unit": "s"}}
    (result,) = (await graded(FLIP, claims, comparisons={"/period": {"kind": "sigfig", "digits": 4}}))["results"]
    assert [test["verdict"] for test in result["tests"]] == ["correct", "incorrect"]
    assert result["score"] == 0.5
    assert not result["correct"]


def numbers_in(node: Any) -> list[float]:
    if isinstance(node, dict):
        return [number for entry in node.values() for number in numbers_in(entry)]
    if isinstance(node, list):
        return [number for entry in node for number in numbers_in(entry)]
    return [float(node)] if type(node) in (int, float) else []


@settings(max_examples=draws(40))
@given(scale=st.floats(1.2, 50.0), seed=st.integers(0, 10**6))
def test_without_reveal_equal_verdicts_are_equal_bytes(scale: float, seed: int) -> None:
    """Of two questions with different references, the answers to what has the same verdict are the same."""
    chance = random.Random(seed)
    slow = [chance.uniform(0.1, 3.0) for _ in range(3)]
    moments = [1.0, chance.uniform(1.2, 2.0), chance.uniform(2.1, 2.9)]

    def question(rates: list[float]) -> Body:
        body = {"kind": "principal-moments", "moments": moments}
        return {"path": "/v1/rotation/precession", "request": {"body": body, "angular_velocity": rates}}

    first, second = question(slow), question([scale * rate for rate in slow])
    pointers = ("/flip_interval", "/period", "/mean_precession_rate")
    right = [handled(one, {pointer: {"value": None} for pointer in pointers})["reference"] for one in (first, second)]
    units = {"/mean_precession_rate": "rad/s"}

    def hidden(which: int, factor: float) -> Any:
        claims = {
            entry["pointer"]: {"value": factor * entry["value"], "unit": units.get(entry["pointer"], "s")}
            for entry in right[which]
        }
        found = handled((first, second)[which], claims, {"/period": {"value": 1.0}}, [], reveal=False)
        assert "reference" not in found
        assert set(numbers_in(found)) <= {0.0, 1.0}
        return found

    # Wrong by anything, a factor that is recognised and would give the reference away, and right.
    for factor in (chance.uniform(3.0, 6.0), 2.0, 0.5, -1.0, 1000.0, 1.0):
        assert hidden(0, factor) == hidden(1, factor)
    assert hidden(0, 1.0)["results"][0]["correct"]


async def test_without_reveal_nothing_is_revealed_by_warnings_or_errors_either() -> None:
    rod = {"path": ROD["path"], "request": {**ROD["request"], "hole_radius": 1.0, "angular_velocity": 0.0}}
    claim = {"times": [-1e9, 1.0], "value": [1.0, 2.0], "unit": "rad"}
    text = json.dumps(await graded(rod, {"/trajectory/angle": claim}, reveal=False))
    assert '"reference"' not in text
    shafts = {
        "path": "/v1/scenes/unwinding-shafts",
        "request": {
            "masses": [1, 2], "radii": [0.1, 0.1], "slopes": [0.5, 0.7], "gravity": 9.81,
            "positions": [1, 1], "velocities": [3, 3], "wound": [1, 1], "times": [0.1],
        },
    }  # fmt: skip
    claim = {"times": [-50.0], "value": [1.0], "unit": "N"}
    (result,) = (await graded(shafts, {"/trajectory/tension": claim}, reveal=False))["results"]
    assert result["format_errors"][0]["detail"] == "must be times that can be answered"


async def test_the_reference_is_computed_once_whatever_is_submitted() -> None:
    def work(count: int) -> float:
        with work_limit(1e9) as meter:
            handled(ROD, *[{HORIZONTAL: {"value": 3.0 + 0.01 * i, "unit": "rad/s"}} for i in range(count)])
        return meter.spent

    # Each further claim costs what judging it costs, and no further question.
    assert work(101) - work(1) == pytest.approx(100 * 4)


async def test_right_in_every_order_of_magnitude() -> None:
    for exponent in range(-60, 61, 20):
        size = 10.0**exponent
        body = {"kind": "principal-moments", "moments": [size, 2 * size, 2.5 * size]}
        question = {"path": "/v1/rotation/precession", "request": {"body": body, "angular_velocity": [1, 2, 3]}}
        (reference,) = handled(question, {"/period": {"value": None}})["reference"]
        assert await verdict(question, "/period", {"value": reference["value"], "unit": "s"}) == "correct"
        assert np.isfinite(reference["error"])


@pytest.mark.parametrize("name", ["errors", "methods", "mistakes", "undecided", "scenes"])
async def test_catalogues_have_no_parameters_and_pages_may(name: str) -> None:
    async with client_of(SERVICE) as client:
        refused = await client.get(f"/v1/{name}?limit=3")
        assert (refused.status_code, refused.json()["errors"][0]["pointer"]) == (422, "?limit")
        assert (await client.get(f"/v1/{name}")).status_code == 200
        assert (await client.get("/healthz?limit=3")).status_code == 200


async def test_the_catalogue_lists_every_mistake() -> None:
    async with client_of(SERVICE) as client:
        listed = (await client.get("/v1/mistakes")).json()["mistakes"]
    assert {"rod-inertia-about-end", "factor-2", "rate-over-axial-moment"} <= {entry["tag"] for entry in listed}
    assert all(0.0 <= entry["credit"] < 1.0 for entry in listed)


def euler_rows(step: float, count: int) -> list[list[float]]:
    a, b, c = MOTION["request"]["body"]["moments"]
    rows = [list(map(float, MOTION["request"]["angular_velocity"]))]
    for _ in range(count):
        x, y, z = rows[-1]
        slope = ((b - c) / a * y * z, (c - a) / b * z * x, (a - b) / c * x * y)
        rows.append([w + step * rate for w, rate in zip(rows[-1], slope, strict=True)])
    return rows


async def test_wrong_samples_are_judged_like_a_method() -> None:
    step = 1 / 120
    times = [4 * i * step for i in range(300)]
    claim = {"times": times, "value": euler_rows(step, 1196)[::4], "unit": "rad/s"}
    more = {"comparison": {"kind": "relabs", "rtol": 1e-3}}
    (result,) = (await graded(MOTION, {"/angular_velocity": claim}, **more))["results"]
    samples = result["tests"][0]["samples"]
    assert samples["consistent_with"]["method"] == "explicit-euler"
    assert samples["consistent_with"]["step"] == pytest.approx(step)
    assert 0.0 < samples["within_until"] < times[-1]
    assert samples["energy_drift"] > 0.0
    assert "explicit-euler with a step of 0.00833333 s" in result["feedback"]
    (hidden,) = (await graded(MOTION, {"/angular_velocity": claim}, reveal=False, **more))["results"]
    assert "samples" not in hidden["tests"][0]


async def test_a_hundred_trajectories_are_judged_by_one_reference() -> None:
    times = [0.01 * i for i in range(100)]
    column = handled(
        MOTION | {"request": {**MOTION["request"], "times": times}}, {"/angular_velocity": {"value": None}}
    )
    rows = column["reference"][0]["value"]

    def work(count: int) -> float:
        claim = {"times": times, "value": rows, "unit": "rad/s"}
        with work_limit(1e9) as meter:
            results = handled(MOTION, *[{"/angular_velocity": claim}] * count)["results"]
        assert all(result["correct"] for result in results)
        return meter.spent

    assert work(101) - work(1) == pytest.approx(100 * 4)


SHAFTS = {
    "path": "/v1/scenes/unwinding-shafts",
    "request": {"masses": [2, 1], "radii": [0.1, 0.2], "slopes": [0.5, 0.9], "gravity": 9.81},
}
NAMED = {"M_1": "/masses/0", "M_2": "/masses/1", "alpha": "/slopes/0", "beta": "/slopes/1", "g": "/gravity"}
TENSION = "g*(sin(alpha)+sin(beta))*M_1*M_2/(3*(M_1+M_2))"


@pytest.mark.parametrize(
    ("formula", "expected", "tags"),
    [
        (TENSION, "correct", []),
        ("g*(sin(alpha)+sin(beta))/(3/M_1+3/M_2)", "correct", []),
        (TENSION.replace("3*", ""), "incorrect", ["shafts-do-not-turn"]),
        ("-" + TENSION, "incorrect", ["sign"]),
        (TENSION.replace("M_1*M_2", "M_1"), "incorrect", []),
        ("2.7528003371450764", "missing-unit", []),
        ("sqrt(-g)", "incorrect", []),
    ],
)
async def test_formulas_are_right_if_they_agree_everywhere(formula: str, expected: str, tags: list[str]) -> None:
    (result,) = (await graded(SHAFTS, {"/tension": {"formula": formula}}, names=NAMED))["results"]
    assert result["format_errors"] == []
    assert result["tests"][0]["verdict"] == expected
    assert result["matches"] == tags


async def test_the_formulas_of_the_homework() -> None:
    names = {"a": "/hole_radius", "l": "/length", "g": "/gravity", "M": "/mass"}
    right = "sqrt(2*g*sqrt(a^2-l^2/4)*(1-l/(2*a))/(a^2-l^2/6))"
    # Energy at the bottom as M g a (1 - sqrt(a^2 - l^2/4)): a length is subtracted from a number.
    source = "sqrt((g*a*l/sqrt(a^2-l^2/4) - 2*g*a*(1-sqrt(a^2-l^2/4)))/(l^2/3+a^2-l^2/4))"
    claims = [{HORIZONTAL: {"formula": formula}} for formula in (right, source)]
    first, second = (await graded(ROD, *claims, names=names))["results"]
    assert first["correct"]
    assert not second["correct"]
    assert second["feedback"].startswith("Check the dimensions")


async def test_formulas_name_the_fields_of_the_question_unless_names_are_given() -> None:
    formula = "gravity*(sin(slopes_1)+sin(slopes_2))*masses_1*masses_2/(3*(masses_1+masses_2))"
    assert (await graded(SHAFTS, {"/tension": {"formula": formula}}))["results"][0]["correct"]


ATWOOD = {
    "path": "/v1/scenes",
    "request": {
        "gravity": [0, -9.81],
        "bodies": {"light": {"mass": 1, "at": [-0.1, -0.5]}, "heavy": {"mass": 3, "at": [0.1, -0.5]}},
        "connections": [{"kind": "string", "name": "cord", "through": ["light", [-0.1, 0], [0.1, 0], "heavy"]}],
    },
}
SLOPE = {"degrees": 30}
WEDGE = {
    "path": "/v1/scenes",
    "request": {
        "gravity": [0, -9.81],
        "bodies": {
            "wedge": {"mass": 3, "inertia": 0.1, "at": [0, 0]},
            "block": {"mass": 1, "at": {"polar": [1, SLOPE]}},
        },
        "connections": [
            {"kind": "slider", "a": "wedge", "b": [0, 0]},
            {"kind": "track", "name": "face", "place": "block", "on": {"at": "wedge", "slope": SLOPE}},
        ],
    },
}
FACE = "-gravity_2*block_mass*wedge_mass*cos(A*pi/180)/(wedge_mass+block_mass*sin(A*pi/180)^2)"


async def test_formulas_on_a_described_scene_need_no_names() -> None:
    tension = "-2*gravity_2*light_mass*heavy_mass/(light_mass+heavy_mass)"
    wrong, one_body = tension.replace("2*g", "g"), "mass*9.81*3/2"
    claims = [{"/forces/cord.tension/value": {"formula": one}} for one in (tension, wrong, one_body)]
    answer = await graded(ATWOOD, *claims)
    first, second, third = answer["results"]
    assert (first["correct"], second["correct"], answer["warnings"]) == (True, False, [])
    # No units are declared for the numbers of a described scene: of dimensions nothing can be said.
    assert "dimensions" not in second["feedback"]
    # Both masses are one, and would be called so.
    assert third["format_errors"][0]["detail"] == 'must use known names, unlike "mass"'
    assert "heavy_mass, light_at_1" in third["format_errors"][0]["remedy"]


async def test_formulas_on_a_described_scene_may_leave_what_agrees_to_it() -> None:
    # The direction of the block is that of the face: one alone cannot be changed.
    formulas = [FACE.replace("A", name) for name in ("slope_degrees_2", "polar_degrees_2", "30")]
    wrong = FACE.replace("A", "slope_degrees_2").replace("wedge_mass+", "wedge_mass-")
    claims = [{"/forces/face.normal/value": {"formula": one}} for one in (*formulas, wrong)]
    results = (await graded(WEDGE, *claims))["results"]
    assert [one["correct"] for one in results] == [True, True, True, False]
    names = {"a": "/connections/1/on/slope/degrees", "m": "/bodies/block/mass", "M": "/bodies/wedge/mass"}
    claim = {"/forces/face.normal/value": {"formula": "9.81*m*M*cos(a*pi/180)/(M+m*sin(a*pi/180)^2)"}}
    assert (await graded(WEDGE, claim, names=names))["results"][0]["correct"]


SPOOL = {
    "path": "/v1/scenes",
    "request": {
        "gravity": [0, -9.81],
        "bodies": {
            "flange": {"mass": 2, "radius": 0.2, "inertia": 0.03, "at": [0, 0.2]},
            "axle": {"mass": 0, "radius": 0.1, "inertia": 0, "at": [0, 0.2]},
            "weight": {"mass": 1, "at": [1, -0.5]},
        },
        "connections": [
            {"kind": "weld", "a": "axle", "b": "flange"},
            {"kind": "rolling", "name": "floor", "place": "flange", "on": {"at": [0, 0]}},
            {"kind": "string", "through": ["axle", [1, 0.1], "weight"], "sides": {"axle": "below"}},
        ],
    },
}
OF_SPOOL = "weight_mass*9.81*0.1*0.2/(0.03+flange_mass*0.2^2+weight_mass*0.1^2)"


@pytest.mark.parametrize("reveal", [True, False])
async def test_a_formula_that_cannot_be_judged_says_what_to_do(reveal: bool) -> None:
    # With another axle the string, which leaves it at the height of a fixed point, is level no more.
    pointer = "/accelerations/flange/linear/0"
    with_axle = OF_SPOOL.replace("0.1*0.2", "(0.2-axle_radius)*0.2")
    wrong = with_axle.replace("0.1^2", "0.2^2")
    answer = await graded(SPOOL, *({pointer: {"formula": one}} for one in (OF_SPOOL, with_axle, wrong)), reveal=reveal)
    right, unclear, wrong_too = (one["tests"][0] for one in answer["results"])
    assert (right["verdict"], wrong_too["verdict"]) == ("correct", "incorrect")
    assert (unclear["verdict"], unclear["score"]) == ("not-gradable", None)
    assert unclear["feedback"] == "A formula cannot be graded here. Give the number with its unit."
    (warning,) = answer["warnings"]
    assert (warning["code"], warning["pointer"]) == ("formulas-not-judged", "/names")
    assert pointer in warning["detail"]
    assert "in names, beside question" in warning["detail"]
    named = {"m": "/bodies/weight/mass", "M": "/bodies/flange/mass", "g": "/gravity/1"}
    formula = OF_SPOOL.replace("weight_mass", "m").replace("flange_mass", "M").replace("9.81", "(-g)")
    answer = await graded(SPOOL, {pointer: {"formula": formula}}, names=named)
    assert (answer["results"][0]["correct"], answer["warnings"]) == (True, [])


@pytest.mark.parametrize(
    "formula", ["", "M_3", "(" * 200, "__import__('os').system('x')", "9" * 301, "M_1 M_2", 3, "sin(sin)", "1e9999"]
)
async def test_what_is_no_formula_is_a_format_error(formula: Any) -> None:
    bad, good = (
        await graded(SHAFTS, {"/tension": {"formula": formula}}, {"/tension": {"formula": TENSION}}, names=NAMED)
    )["results"]
    assert [fault["pointer"] for fault in bad["format_errors"]] == ["/submissions/0/~1tension/formula"]
    assert good["correct"]


@pytest.mark.parametrize(
    ("names", "pointer"),
    [
        ({"g": "/nothing"}, "/names/g"),
        ({"2g": "/gravity"}, "/names/2g"),
        ({"g" * 65: "/gravity"}, "/names"),
        ({"sin": "/gravity"}, "/names/sin"),
        ({"g": ""}, "/names/g"),
    ],
)
async def test_names_lead_to_numbers(names: dict[str, str], pointer: str) -> None:
    response = await asked(SHAFTS, {"/tension": {"formula": "1"}}, names=names)
    assert response.status_code == 422
    assert response.json()["errors"][0]["pointer"] == pointer


def units_in(node: Any) -> list[str]:
    if isinstance(node, dict):
        own = [node["unit"]] if isinstance(node.get("unit"), str) else []
        return own + [unit for entry in node.values() for unit in units_in(entry)]
    return [unit for entry in node for unit in units_in(entry)] if isinstance(node, list) else []


def test_no_example_imports_the_library_of_units_while_the_service_warms_up() -> None:
    examples = [dict(example.question) for example in ROUTES[PATH].examples.values()]
    assert units_in(examples)
    assert all(base_powers(unit) is not None for unit in units_in(examples))


def test_every_comparison_and_every_form_of_claim_has_an_example() -> None:
    examples = ROUTES[PATH].examples
    assert {"relabs", "sigfig", "decdig", "interval", "data", "formulas", "samples", "choices-and-sets"} <= set(
        examples
    )


async def test_methods_are_looked_for_in_a_limited_number_of_samples() -> None:
    times = [0.1 * i for i in range(10)]
    claim = {"times": times, "value": [[0.1 * i, 1.0, 0.3 * i] for i in range(10)], "unit": "rad/s"}
    few = handled(MOTION, *[{"/angular_velocity": claim}] * 3)
    many = handled(MOTION, *[{"/angular_velocity": claim}] * 101)
    assert few["warnings"] == []
    assert [warning["code"] for warning in many["warnings"]] == ["methods-not-looked-for"]


async def test_a_measurement_is_run_once() -> None:
    measure = {"method": {"kind": "closed-form"}, "duration": 15.0, "samples": 2000, "tolerance": 0.035}
    measured = {**COIN, "request": {**COIN["request"], "measure": measure}}

    def work(question: Body) -> float:
        with work_limit(1e9) as meter:
            assert handled(question, {"/space_rate": {"value": 2.0, "unit": "rad/s"}})["results"][0]["gradable"]
        return meter.spent

    assert work(measured) - work(COIN) < 2 * measure["samples"] + 100
    assert await verdict(measured, "/measured/theory", {"value": 6.2832, "unit": "s"}) == "correct"


def archive(document: Any, **arrays: Any) -> bytes:
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    with ZipFile(stream, "a") as packed:
        packed.writestr("metadata.json", json.dumps(document))
    return stream.getvalue()


def test_samples_may_be_arrays_of_an_archive() -> None:
    times = np.linspace(0.0, 2.0, 40)
    rows = np.array(euler_rows(times[1], 39))
    route = ROUTES[PATH]
    named = {"value": {"array": "rows"}, "times": {"array": "times"}, "unit": "rad/s"}
    unknown = {"value": {"array": "other"}, "times": {"array": "times"}, "unit": "rad/s"}
    body = archive(
        {"question": MOTION, "submissions": [{"/angular_velocity": named}, {"/angular_velocity": unknown}]},
        rows=np.asfortranarray(rows),
        times=times,
    )
    answer = json.loads(written(HANDLER.answer(route, HANDLER.read(route, body, npz=True))))
    claim = {"value": rows.tolist(), "times": times.tolist(), "unit": "rad/s"}
    assert answer["results"][0] == handled(MOTION, {"/angular_velocity": claim})["results"][0]
    assert answer["results"][0]["tests"][0]["samples"]["consistent_with"]["method"] == "explicit-euler"
    assert [fault["pointer"] for fault in answer["results"][1]["format_errors"]] == [
        "/submissions/1/~1angular_velocity/value"
    ]


def test_what_is_wrong_with_samples_is_a_sentence() -> None:
    times = np.linspace(0.0, 8.0, 80)
    motion = {**MOTION, "request": {**MOTION["request"], "times": times.tolist()}}
    route = ROUTES[MOTION["path"]]
    rows = np.array(
        HANDLER.answer(route, HANDLER.read(route, json.dumps(motion["request"]).encode()))["angular_velocity"]
    )
    late = np.append(rows[:1], rows[:-1], axis=0)

    def feedback(value: Any, unit: str = "rad/s") -> tuple[str, list[str]]:
        claim = {"times": times.tolist(), "value": value.tolist(), "unit": unit}
        (result,) = handled(MOTION, {"/angular_velocity": claim})["results"]
        return result["feedback"], result["matches"]

    assert feedback(rows[:, [0, 2, 1]])[0].endswith("Axes 2 and 3 are exchanged.")
    assert feedback(late)[1] == ["samples-off-by-one"]
    assert feedback(np.degrees(rows))[1] == ["degrees"]
    assert feedback(rows[::2].repeat(2, axis=0) * 0.0)[1] == []
    twice = HANDLER.answer(
        route, HANDLER.read(route, json.dumps({**MOTION["request"], "times": (2.0 * times).tolist()}).encode())
    )
    assert feedback(np.array(twice["angular_velocity"]))[1] == ["time-scaled"]


def test_a_constant_is_no_motion_at_another_time() -> None:
    times = np.linspace(0.0, 30.0, 200)
    claim = {"times": times.tolist(), "value": [[0.1, 2.0, 0.1]] * 200, "unit": "rad/s"}
    (result,) = handled(MOTION, {"/angular_velocity": claim})["results"]
    assert (result["matches"], result["score"]) == ([], 0.0)


@pytest.mark.parametrize(
    "claim",
    [
        {"value": 1.0, "unit": "s"},
        {"value": 1.0},
        {"value": 1.0, "unit": "m"},
        {"formula": "1"},
        {"formula": "1 +"},
        {"value": None},
    ],
    ids=str,
)
def test_without_reveal_a_figure_that_does_not_exist_is_judged_as_one_that_does(claim: Body) -> None:
    coin, handle = (handled(one, {"/flip_interval": claim}, reveal=False)["results"] for one in (COIN, FLIP))
    if claim == {"value": None}:
        assert coin[0]["correct"]
        assert not handle[0]["correct"]
    else:
        assert coin == handle


@pytest.mark.parametrize(
    ("question", "pointer", "unit", "how", "axis"),
    [
        (FLIP, "/flip_interval", "s", "ball arithmetic", 3),
        (COIN, "/space_rate", "rad s^-1", "ball arithmetic", 3),
        (COIN, "/axis", "1", "ball arithmetic", 3),
        (STABILITY, "/equilibria/0/eigenvalues", "s^-1", "ball arithmetic", 3),
        (STABILITY, "/equilibria/1/growth_rate", "s^-1", "ball arithmetic", 2),
        (STABILITY, "/equilibria/2/moment", "kg m^2", "ball arithmetic", 1),
        (ROD, HORIZONTAL, "rad s^-1", "bound that the answer states", None),
        (MOTION, "/period", "s", "ball arithmetic", None),
        (MOTION, "/angular_velocity/1", "rad s^-1", "closed form", None),
        (PLANET, "/ellipticity", "1", "ball arithmetic", None),
        (PLANET, "/flattening", "1", "ball arithmetic", None),
        (DUMBBELLS, "/principal/moments/2", "kg m^2", "sums of two doubles", None),
        (DUMBBELLS, "/inertia/about_origin", "kg m^2", "sums of two doubles", None),
        (DUMBBELLS, "/principal/axes", "1", "sums of two doubles", None),
    ],
)
def test_a_reference_says_what_its_error_rests_on_and_to_which_axis_it_belongs(
    question: Any, pointer: str, unit: str, how: str, axis: int | None
) -> None:
    (reference,) = handled(question, {pointer: {"value": None}})["reference"]
    assert (reference["unit"], reference["how"], reference["body_axis"]) == (unit, how, axis)
    size = np.abs(reference["value"]).max()
    assert 0.0 < reference["error"] <= 1e-14 * size


def test_as_many_submissions_as_are_documented_fit_into_one_request() -> None:
    claims = [{"/flip_interval": {"value": INTERVAL + 0.1 * (i % 2), "unit": "s"}} for i in range(5000)]
    results = handled(FLIP, *claims)["results"]
    assert [result["correct"] for result in results] == [True, False] * 2500


def test_proven_references_agree_with_forty_digits() -> None:
    """The error covers the distance from digits of which more were proven than the reference was compared with."""
    for path, request, names in (
        (FLIP["path"], FLIP["request"], ("flip_interval", "period", "mean_precession_rate", "precession_per_period")),
        (ROD["path"], ROD["request"], ("angular_velocity_at_horizontal", "period", "equivalent_length")),
        (SHAFTS["path"], SHAFTS["request"], ("tension", "string_acceleration")),
    ):
        route = ROUTES[str(path).replace("/v1", "/v1/certified", 1)]
        digits = HANDLER.answer(route, HANDLER.read(route, json.dumps({**request, "digits": 40}).encode()))
        claims = {f"/{name}": {"value": None} for name in names}
        found = handled({"path": path, "request": request}, claims)["reference"]
        for name, reference in zip(names, found, strict=True):
            assert abs(Decimal(digits[name]) - Decimal(reference["value"])) <= Decimal(reference["error"]), name


async def test_curves_are_right_from_any_start_in_either_direction() -> None:
    request = {
        "body": {"kind": "principal-moments", "moments": [2.0, 1.0, 0.5]}, "angular_velocity": [0.4, 1.0, 0.7],
        "resolution": 6, "layout": "grid", "points": 256,
    }  # fmt: skip
    question = {"path": "/v1/rotation/energy-ellipsoid", "request": request}
    route = ROUTES[str(question["path"])]
    answer = HANDLER.answer(route, HANDLER.read(route, json.dumps({**request, "points": 100}).encode()))
    points = np.array(json.loads(written(answer))["polhodes"][0]["points"])[:-1]
    claims = [points, np.roll(points[::-1], 17, axis=0), points[:, [0, 2, 1]], -points[:40]]
    graded = handled(question, *[{"/polhodes/0/points": {"value": one.tolist(), "unit": "rad/s"}} for one in claims])
    assert [result["correct"] for result in graded["results"]] == [True, True, False, False]
    assert graded["results"][2]["matches"] == ["permuted-axes"]
    (reference,) = graded["reference"]
    assert reference["form"] == "curve"
    assert 0.0 < reference["error"] < 1e-4


@settings(max_examples=10)
@given(seed=st.integers(0, 10**6))
def test_without_reveal_samples_say_nothing_but_their_verdict(seed: int) -> None:
    """Of two motions, the answers to samples that are wrong in the same way are the same bytes."""
    chance = random.Random(seed)
    times = np.linspace(0.0, 5.0, 30)

    def hidden(rates: list[float], change: Any) -> Any:
        question = {**MOTION, "request": {**MOTION["request"], "angular_velocity": rates}}
        route = ROUTES[MOTION["path"]]
        timed = {**question["request"], "times": times.tolist()}
        rows = np.array(HANDLER.answer(route, HANDLER.read(route, json.dumps(timed).encode()))["angular_velocity"])
        claim = {"value": change(rows).tolist(), "times": times.tolist(), "unit": "rad/s"}
        return handled(question, {"/angular_velocity": claim}, reveal=False)

    first = [chance.uniform(0.3, 2.0) for _ in range(3)]
    second = [chance.uniform(1.2, 3.0) * rate for rate in first]
    for change in (
        lambda rows: rows[:, [1, 2, 0]] * [1.0, 2.0, 3.0],
        lambda rows: 2.0 * rows,
        lambda rows: np.append(3.0 * rows[1:], rows[:1], axis=0),
        lambda rows: rows,
    ):
        assert hidden(first, change) == hidden(second, change)
