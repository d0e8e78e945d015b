"""Described scenes over HTTP: numbers with all their digits, and hostile descriptions with clear refusals."""

from __future__ import annotations

import io
import json
from decimal import Decimal
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import httpx
import numpy as np
import pytest

from core.multibody.language.scene import MOST_BODIES, MOST_CONNECTIONS
from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.requests.described_scene import DescribedSceneRequest
from service.requests.request_reader import Limits, Reader
from service.routes import questions
from service.routing import PostRoute
from tests.service.conftest import PATIENCE, Server, client_of, inline_service

PATH = "/v1/scenes"
EXAMPLES = Path(__file__).parents[2] / "examples" / "scenes"
SERVICE = inline_service()
ROUTE = next(route for route in questions() if route.path == PATH)
POINT: dict[str, Any] = {"mass": 1, "at": [3, -4]}
ROD: dict[str, Any] = {"kind": "rod", "a": "p", "b": [0, 0]}
PENDULUM: dict[str, Any] = {"gravity": [0, -9.81], "bodies": {"p": POINT}, "connections": [ROD]}

pytestmark = pytest.mark.anyio


async def sent(content: bytes, path: str = PATH) -> httpx.Response:
    async with client_of(SERVICE) as client:
        return await client.post(path, content=content, headers={"content-type": "application/json"})


def made_in_short(question: Any) -> Any:
    """Return the plan of a question that is not run."""
    route = next(route for route in questions() if route.path == "/v1/plan")
    handler = RequestHandler(questions(), Budget(), Limits())
    return handler.answer(route, handler.read(route, json.dumps({"path": PATH, "request": question}).encode()), 2)


async def asked(question: Any, path: str = PATH) -> httpx.Response:
    return await sent(json.dumps(question).encode(), path)


def of_point(**changes: Any) -> dict[str, Any]:
    return PENDULUM | {"bodies": {"p": POINT | changes}}


def of_rod(**changes: Any) -> dict[str, Any]:
    return PENDULUM | {"connections": [ROD | changes]}


def named(name: str) -> dict[str, Any]:
    return PENDULUM | {"bodies": {name: POINT}, "connections": []}


class TestNumbers:
    TEXT = (
        b'{"gravity": [0, -9.81], "bodies": {"p": {"mass": 1, "at": [0.30000000000000000000001, 0]}}, '
        b'"connections": [{"kind": "rod", "a": "p", "b": [0, 0], "length": "0.3 + 1e-23"}], "numbers": "%s"}'
    )

    async def test_every_digit_counts(self) -> None:
        """The rod is as long as the place is far only if the last of 23 digits is read."""
        exact, rounded = [(await sent(self.TEXT % kind)).json() for kind in (b"decimals", b"doubles")]
        assert exact["model"]["noticed"] == []
        assert "moved by rounding's width" in rounded["model"]["noticed"][0]

    def test_numbers_are_read_as_they_are_written_but_for_times(self) -> None:
        text = json.dumps(PENDULUM | {"times": [0.1], "let": {"x": 0.5}}).replace("-9.81", "-9.810000000000000000001")
        read = Reader(DescribedSceneRequest, Limits()).read(text.encode())
        assert read.gravity == [0, Decimal("-9.810000000000000000001")]
        assert read.let == {"x": Decimal("0.5")}
        assert read.times == [0.1]
        assert type(read.times[0]) is float

    @pytest.mark.parametrize("number", ["1e999", "-1e999", "1e99999999999999999999", "1e-99999999999999999999"])
    async def test_exponents_beyond_all_are_refused(self, number: str) -> None:
        response = await sent(json.dumps(of_point()).replace('"mass": 1', f'"mass": {number}').encode())
        assert response.status_code == 422
        assert response.json()["errors"][0]["pointer"].startswith("/bodies/p")

    async def test_angles_and_polar_coordinates(self) -> None:
        """An eighth of a turn below the horizontal: the two components of the acceleration are the same number."""
        answer = (await asked(of_point(at={"polar": ["sqrt(2)", {"degrees": -45}]}))).json()
        x, y = answer["accelerations"]["p"]["linear"]
        assert x == y == pytest.approx(-9.81 / 2, rel=1e-15)


HOSTILE: dict[str, tuple[Any, str]] = {
    "an attraction without a body": (
        PENDULUM | {"connections": [{"kind": "gravitation", "a": "p", "b": "q"}]},
        "/connections/0/b",
    ),
    "a strength that is no number": (
        PENDULUM | {"connections": [{"kind": "inverse-square", "a": "p", "b": [0, 0], "strength": "1/0"}]},
        "/connections/0/strength",
    ),
    "a value that is no quantity": (
        PENDULUM | {"times": [1], "outputs": [{"when": {"quantity": "../p", "equals": 1}}]},
        "/outputs/0/when/quantity",
    ),
    "extremes of nothing": (PENDULUM | {"times": [1], "outputs": [{"extremes": "p.mass"}]}, "/outputs/0/extremes"),
    "a search for nothing": (PENDULUM | {"times": [1], "outputs": [{"when": 3}]}, "/outputs/0/when"),
    "a search of two kinds": (PENDULUM | {"times": [1], "outputs": [{"when": {}, "extremes": "p"}]}, "/outputs/0"),
    "a search without a value": (
        PENDULUM | {"times": [1], "outputs": [{"when": {"quantity": "p.position.x"}}]},
        "/outputs/0/when/equals",
    ),
    "a search for the time before the first": (
        PENDULUM | {"times": [1], "outputs": [{"when": {"quantity": "p.position.x", "equals": 0, "nth": 0}}]},
        "/outputs/0/when/nth",
    ),
    "a list as an output": (PENDULUM | {"outputs": [["energy"]]}, "/outputs/0"),
    "thresholds of nothing": (PENDULUM | {"outputs": [{"thresholds": 3}]}, "/outputs/0/thresholds"),
    "thresholds without bounds": (
        PENDULUM | {"outputs": [{"thresholds": {"vary": "/gravity/1"}}]},
        "/outputs/0/thresholds/between",
    ),
    "thresholds of what is no number": (
        PENDULUM | {"outputs": [{"thresholds": {"vary": "/bodies/p", "between": [0, 1]}}]},
        "/outputs/0/thresholds/vary",
    ),
    "thresholds with more": (
        PENDULUM | {"outputs": [{"thresholds": {"vary": "/gravity/1", "between": [-10, 0], "until": 1}}]},
        "/outputs/0/thresholds/until",
    ),
    "a search without an end": (PENDULUM | {"outputs": [{"extremes": "p.position.x"}]}, "/times"),
    "no bodies": (PENDULUM | {"bodies": {}}, "/bodies"),
    "a list of bodies": (PENDULUM | {"bodies": [POINT]}, "/bodies"),
    "too many bodies": ({"bodies": {f"p{i}": {"mass": 1, "at": [i, 0]} for i in range(101)}}, "/bodies"),
    "too many connections": (PENDULUM | {"connections": [ROD] * 401}, "/connections"),
    "ten thousand empty connections": (PENDULUM | {"connections": [{}] * 10_000}, "/connections"),
    "two connections of one name": (PENDULUM | {"connections": [ROD | {"name": "r"}] * 2}, "/connections/1/name"),
    "a connection named as a body": (of_rod(name="p"), "/connections/0/name"),
    "a name that is a path": (named("../../etc/passwd"), "/bodies/..~1..~1etc~1passwd"),
    "a name with a tilde": (named("a~b"), "/bodies/a~0b"),
    "an empty name": (named(""), "/bodies/"),
    "a long name": (named("a" * 5000), "/bodies"),
    "the ground as a body": (named("ground"), "/bodies/ground"),
    "a place named as a path": (of_point(places={"../x": [0, 0]}), "/bodies/p/places/..~1x"),
    "a number named as a function": (PENDULUM | {"let": {"sqrt": 1}}, "/let/sqrt"),
    "names in a cycle": (PENDULUM | {"let": {"x": "y", "y": "x"}}, "/let/x"),
    "code": (PENDULUM | {"let": {"x": "__import__('os').system('true')"}}, "/let/x"),
    "a deep formula": (of_point(mass="(" * 90 + "1" + ")" * 90), "/bodies/p/mass"),
    "a long formula": (of_point(mass="1+" * 5000 + "1"), "/bodies/p/mass"),
    "a division by zero": (of_point(mass="1/(1 - 1)"), "/bodies/p/mass"),
    "NaN": (of_point(mass=float("nan")), "/bodies/p/mass"),
    "infinity": (of_point(at=[float("inf"), 0]), "/bodies/p/at/0"),
    "a whole number of 3000 digits": (of_point(mass=10**3000), "/bodies/p/mass"),
    "true": (of_point(mass=True), "/bodies/p/mass"),
    "a negative mass": (of_point(mass=-1), "/bodies/p/mass"),
    "no mass": (of_point(mass=0), "/bodies/p"),
    "three components in the plane": (of_point(at=[1, 2, 3]), "/bodies/p/at"),
    "an unknown field of a body": (of_point(mas=1), "/bodies/p/mas"),
    "an unknown field of a connection": (of_rod(stiffness=1), "/connections/0/stiffness"),
    "a long unknown field": (of_rod(**{"k" * 3000: 1}), "/connections/0"),
    "a field left out": (PENDULUM | {"connections": [{"kind": "rod", "a": "p"}]}, "/connections/0/b"),
    "no kind": (PENDULUM | {"connections": [{"a": "p", "b": [0, 0]}]}, "/connections/0/kind"),
    "an unknown kind": (of_rod(kind="rope"), "/connections/0/kind"),
    "a kind that is a list": (of_rod(kind=["rod"]), "/connections/0/kind"),
    "a connection that is a list": (PENDULUM | {"connections": [json.loads("[" * 25 + "]" * 25)]}, "/connections/0"),
    "an unknown body": (of_rod(a="q"), "/connections/0/a"),
    "an unknown place": (of_rod(a="p.end"), "/connections/0/a"),
    "a connection to itself": (of_rod(b="p"), "/connections/0"),
    "a length in seconds": (of_rod(length={"value": 1, "unit": "s"}), "/connections/0/length/unit"),
    "nested degrees": (of_point(mass={"degrees": {"degrees": 1}}), "/bodies/p/mass/degrees"),
    "slips that are no names": (
        PENDULUM | {"connections": [{"kind": "string", "through": [[0, 0], "p"], "slips": [["p"]]}]},
        "/connections/0/slips/0",
    ),
    "a velocity against the rod": (of_point(velocity=[3, -4]), "/bodies/p/velocity/1"),
    "a body of the catalogue that is none": (
        {"gravity": [0, 0, -1], "bodies": {"p": {"at": [0, 0, 0], "body": {"kind": "ball", "mass": 1, "radius": -1}}}},
        "/bodies/p/body/radius",
    ),
    "a contact that names nothing to touch": (
        PENDULUM | {"connections": [{"kind": "contact", "place": "p"}]},
        "/connections/0",
    ),
    "friction, not covered yet": (of_rod(friction=0.2), "/connections/0/friction"),
    "an unknown method": (PENDULUM | {"method": {"kind": "rk5"}}, "/method/kind"),
    "a step of zero": (PENDULUM | {"times": [1], "method": {"kind": "explicit-euler", "step": 0}}, "/method/step"),
    "a step too short": (PENDULUM | {"times": [1], "method": {"kind": "explicit-euler", "step": 1e-9}}, "/method/step"),
    "a method that scenes do not have": (
        PENDULUM | {"times": [1], "method": {"kind": "symmetric-splitting", "step": 0.1}},
        "/method/kind",
    ),
    "a closed form where there is none": (PENDULUM | {"times": [1], "method": {"kind": "closed-form"}}, "/method/kind"),
    "an uncertainty of two": (PENDULUM | {"times": [1], "input_uncertainty": 2}, "/input_uncertainty"),
    "no digits": (PENDULUM | {"times": [1], "round": 0}, "/round"),
    "a time that is no number": (PENDULUM | {"times": [0, None]}, "/times/1"),
    "too many samples": (PENDULUM | {"times": {"start": 0, "stop": 1, "count": 10**9}}, "/times/count"),
    "an unknown output": (PENDULUM | {"outputs": ["everything"]}, "/outputs/0"),
    "a wheel without sides": (
        PENDULUM
        | {
            "bodies": {
                "p": POINT,
                "q": POINT | {"at": [1, -4]},
                "w": {"mass": 1, "inertia": 1, "radius": 1, "at": [2, 0]},
            },
            "connections": [{"kind": "string", "through": ["p", "w", "q"]}],
        },
        "/connections/0/sides/w",
    ),
    "a mass with its unit": (of_point(mass="1 kg"), "/bodies/p/mass"),
    "an accuracy of two": (PENDULUM | {"accuracy": 2}, "/accuracy"),
    "a trajectory without times": (PENDULUM | {"outputs": ["trajectory"]}, "/times"),
    "work without times": (PENDULUM | {"outputs": ["work-in-time"]}, "/times"),
    "a method without times": (PENDULUM | {"method": {"kind": "explicit-euler", "step": 0.1}}, "/method"),
    "digits without times": (PENDULUM | {"round": 3}, "/round"),
    "a value that no double has": (
        PENDULUM | {"times": [1], "outputs": [{"when": {"quantity": "p.position.x", "equals": 10**400}}]},
        "/outputs/0/when/equals",
    ),
}


@pytest.mark.parametrize("case", HOSTILE, ids=HOSTILE)
async def test_what_cannot_be_answered_is_refused_with_its_place(case: str) -> None:
    question, pointer = HOSTILE[case]
    response = await asked(question)
    problem = response.json()
    assert response.status_code == 422, problem
    assert response.headers["content-type"] == "application/problem+json"
    assert len(response.content) <= 2048
    assert [fault["pointer"] for fault in problem["errors"]] == [pointer]
    assert len(problem["detail"]) > 20


IMMODERATE: dict[str, tuple[str, tuple[str | int, ...], str, str]] = {
    "periods so many that their phase is lost": ("pendulum-timed", ("gravity", 0), "1e60", "/accuracy"),
    "a place far from all others": ("atwood-machine", ("bodies", "heavy", "at", 0), "1e300", "/bodies"),
    "a spin that turns once in 1e-299 s": ("lagrange-top", ("bodies", "top", "angular_velocity", 0), "1e299", "/times"),
    "a start of 1e299 m/s": ("conical-pendulum", ("bodies", "bob", "velocity", 1), "1e299", "/times"),
    "a mass of 1e260 kg": ("binary-stars", ("bodies", "a", "mass"), "cosh(600)", "/times"),
    "a mass of 1e434294 kg": ("binary-stars", ("bodies", "a", "mass"), "cosh(1e6)", "/bodies/a/mass"),
    "a start of 1e-400 m": ("harmonic-ellipse", ("bodies", "bob", "at", 0), "1e-400", "/bodies/bob/at/0"),
    "an impact at 1e299 m/s": ("slip-to-roll", ("bodies", "disc", "velocity", 1), "-1e299", "/bodies"),
    "steps of 1e300 s": ("stone-across-slope", ("bodies", "stone", "velocity", 0), "1e299", "/times"),
}
"""Worked scenes with one number that is valid and leads beyond the range of doubles, and where the refusal points."""


@pytest.mark.parametrize("case", IMMODERATE, ids=IMMODERATE)
async def test_numbers_that_lead_beyond_doubles_are_refused(case: str) -> None:
    name, path, formula, pointer = IMMODERATE[case]
    scene = json.loads((EXAMPLES / f"{name}.json").read_text(encoding="utf-8"))
    node = scene
    for step in path[:-1]:
        node = node[step]
    node[path[-1]] = formula
    response = await asked(scene)
    assert response.status_code == 422, response.text
    assert response.json()["errors"][0]["pointer"] == pointer
    assert "inf " not in response.json()["detail"]


async def test_refusals_name_the_limit() -> None:
    for case, limit in (("too many bodies", MOST_BODIES), ("too many connections", MOST_CONNECTIONS)):
        assert f"at most {limit}" in (await asked(HOSTILE[case][0])).json()["detail"]
    many = await asked(PENDULUM | {"connections": [ROD] * 10_000})
    assert (many.status_code, many.json()["code"]) == (400, "too-complex")
    assert "20000 keys" in many.json()["detail"]


async def test_the_largest_scene_answers_and_one_body_more_is_refused() -> None:
    """A horizontal chain of points, released: under its rods' tensions the last one falls freely at first."""

    def chain(count: int) -> dict[str, Any]:
        bodies = {f"p{i}": {"mass": 1, "at": [i + 1, 0]} for i in range(count)}
        rods = [{"kind": "rod", "a": f"p{i}", "b": f"p{i - 1}" if i else [0, 0]} for i in range(count)]
        return {"gravity": [0, -9.81], "bodies": bodies, "connections": rods, "times": [0.02], "accuracy": 1e-9}

    response = await asked(chain(MOST_BODIES))
    answer = response.json()
    assert (response.status_code, answer["model"]["degrees_of_freedom"]) == (200, MOST_BODIES)
    # A rod that starts level and at rest pulls on nothing: to third order in time every point falls freely.
    fall = answer["trajectory"]["columns"][f"p{MOST_BODIES - 1}.position"]
    assert fall["values"][0][1] == pytest.approx(-9.81 * 0.02**2 / 2, abs=1e-6)
    refused = await asked(chain(MOST_BODIES + 1))
    assert (refused.status_code, refused.json()["errors"][0]["pointer"]) == (422, "/bodies")
    assert f"at most {MOST_BODIES}" in refused.json()["detail"]


async def test_faults_of_several_parts_are_said_at_once() -> None:
    wrong = [ROD | {"a": "nobody"}, ROD, {"kind": "spring", "a": "nobody", "b": [0, 1], "stiffness": 1}]
    problem = (await asked(PENDULUM | {"connections": wrong})).json()
    assert [fault["pointer"] for fault in problem["errors"]] == ["/connections/0/a", "/connections/2/a"]
    assert problem["detail"].endswith(", and 1 more")
    assert "further" not in problem


async def test_a_misspelt_field_of_a_body_is_recognised_whatever_the_body_is_called() -> None:
    for name in ("p", "times", "ball", "body"):
        response = await asked({"bodies": {name: {"mass": 1, "at": [0, 0], "velocty": [0, 0]}}})
        (fault,) = response.json()["errors"]
        assert (fault["pointer"], fault["remedy"]) == (f"/bodies/{name}/velocty", "did you mean velocity?")


DISC: dict[str, Any] = {"mass": 1, "inertia": 1, "radius": 1, "at": [0, 2], "places": {"rim": [0, 1]}}
NAMED: dict[str, Any] = {
    "gravity": [0, -9.81],
    "bodies": {"bob": {"mass": 1, "at": [3, -4]}, "disc": DISC},
    "connections": [{"kind": "rod", "name": "arm", "a": "bob", "b": [0, 0]}],
    "times": [1],
}


def joined(**changes: Any) -> dict[str, Any]:
    return {"connections": [{"kind": "pin", "a": "bob", "b": [3, -4]} | changes]}


@pytest.mark.parametrize(
    ("changes", "pointer", "remedy"),
    [
        (joined(a="bop"), "/connections/0/a", 'did you mean "bob"? the bodies here are bob, disc'),
        (joined(a="bop.rim"), "/connections/0/a", 'did you mean "bob"? the bodies here are bob, disc'),
        (joined(a="rope"), "/connections/0/a", "the bodies here are bob, disc"),
        (joined(a="disc.rum"), "/connections/0/a", 'did you mean "rim"? the places here are centre, rim'),
        (joined(kind="spirng"), "/connections/0/kind", 'did you mean "spring"?'),
        (joined(kind="rope"), "/connections/0/kind", None),
        (joined(axes=[0, 0, 1]), "/connections/0/axes", 'did you mean "axis"?'),
        (joined(damping=1), "/connections/0/damping", None),
        (
            {"connections": [{"kind": "torsion-spring", "a": "disk", "stiffness": 1}]},
            "/connections/0/a",
            'did you mean "disc"? the bodies here are bob, disc',
        ),
        (
            {"connections": [{"kind": "torque", "body": "disk", "torque": 1}]},
            "/connections/0/body",
            'did you mean "disc"? the bodies here are bob, disc',
        ),
        (
            {"connections": [{"kind": "gravitation", "a": "bob", "b": "disk"}]},
            "/connections/0/b",
            'did you mean "disc"? the bodies here are bob, disc; use inverse-square for a place',
        ),
        (
            {"connections": [{"kind": "rolling", "a": "disk", "b": "bob"}]},
            "/connections/0/a",
            'did you mean "disc"? the bodies here are bob, disc',
        ),
        (
            {"connections": [{"kind": "rolling", "a": "disc", "b": {"at": [0, 0], "radius": 1}}]},
            "/connections/0/b",
            'for a circle of the ground give "place": the body, and "on": {"at": [0, 0], "radius": 1}, in place of a '
            "and b; or describe it as a body with a radius that is pinned to the ground",
        ),
        ({"gravity": 9.81}, "/gravity", "such as [0, -9.81]"),
        ({"outputs": ["energie"]}, "/outputs/0", 'did you mean "energy"?'),
        ({"outputs": [{"wen": {}}]}, "/outputs/0", 'did you mean "when"?'),
        (
            {"outputs": [{"when": {"quantity": "bob.position.x", "equal": 0}}]},
            "/outputs/0/when/equal",
            'did you mean "equals"?',
        ),
        (
            {"outputs": [{"when": {"quantity": "bop.positon.x", "equals": 0}}]},
            "/outputs/0/when/quantity",
            'did you mean "bob.position.x"? take a component of a vector by ".x", its length by ".length"',
        ),
        (
            {"outputs": [{"extremes": "arm.forse"}]},
            "/outputs/0/extremes",
            'did you mean "arm.force"? take a component of a vector by ".x", its length by ".length"',
        ),
        (
            {"outputs": [{"thresholds": {"vary": "/bodies/bob/mas", "between": [0, 2]}}]},
            "/outputs/0/thresholds/vary",
            'did you mean "/bodies/bob/mass"? name one that is written there, as /connections/0/friction',
        ),
    ],
)  # fmt: skip
async def test_an_unknown_name_in_a_scene_is_answered_with_the_one_that_was_meant(
    changes: dict[str, Any], pointer: str, remedy: str | None
) -> None:
    response = await asked(NAMED | changes)
    (fault,) = response.json()["errors"]
    assert (response.status_code, fault["pointer"], fault.get("remedy")) == (422, pointer, remedy)


async def test_a_disc_rolls_on_a_circle_of_the_ground_as_the_remedy_says() -> None:
    rolling = {"kind": "rolling", "place": "disc", "on": {"at": [0, 0], "radius": 1}}
    assert (await asked(NAMED | {"connections": [rolling]})).status_code == 200


async def test_undetermined_forces_are_null_and_say_with_whom_they_are_shared() -> None:
    """A beam pinned at both ends: half of its weight on each vertically, horizontally whatever they agree on."""
    beam = {"mass": 3, "inertia": 1, "at": [0, 0], "places": {"left": [-1, 0], "right": [1, 0]}}
    pins = [{"kind": "pin", "a": f"beam.{side}", "b": [x, 0]} for side, x in (("left", -1), ("right", 1))]
    answer = (await asked({"gravity": [0, -9.81], "bodies": {"beam": beam}, "connections": pins})).json()
    forces = answer["forces"]
    assert [forces[f"pin-{i}.y"]["value"] for i in (1, 2)] == pytest.approx([14.715, 14.715], rel=1e-15)
    assert forces["pin-1.x"]["value"] is None
    assert not forces["pin-1.x"]["determined"]
    assert "pin-2" in forces["pin-1.x"]["shared_with"]
    assert answer["model"]["name"] == "rest"
    assert answer["ended"] is None
    assert "trajectory" not in answer


async def test_a_string_becomes_slack() -> None:
    """Thrown up from the side of a circle: v^2 = v0^2 - 2 g l sin a, slack where v^2 = g l sin a."""
    scene = {
        "gravity": [0, -10],
        "bodies": {"p": {"mass": 1, "at": [1, 0], "velocity": [0, "sqrt(15)"]}},
        "connections": [{"kind": "string", "through": [[0, 0], "p"]}],
        "times": [0, 0.1, 0.5, 0.15],
        "outputs": ["trajectory"],
    }
    answer = (await asked(scene)).json()
    assert answer["ended"] == "horizon"
    (event,) = answer["events"]
    assert (event["kind"], event["name"]) == ("slack", "string-1")
    assert [phase["states"]["string-1"] for phase in answer["phases"]] == ["closed", "open"]
    assert answer["trajectory"]["rows"] == [0, 1, 2, 3]
    end = (await asked(scene | {"times": [event["time"] * (1 - 1e-12)]})).json()
    (place,) = end["trajectory"]["columns"]["p.position"]["values"]
    assert place == pytest.approx([-np.sqrt(3) / 2, 0.5] if place[0] < 0 else [np.sqrt(3) / 2, 0.5], abs=1e-9)


async def test_a_ball_bounces_and_mechanics_leaves_two_impacts_undecided() -> None:
    ball = {"mass": 1, "inertia": 1, "radius": 0.1}
    scene = {
        "gravity": [0, -10],
        "bodies": {"p": ball | {"at": [0, 5.1]}},
        "connections": [{"kind": "contact", "name": "floor", "place": "p", "on": {"at": [0, 0]}, "restitution": 0.5}],
        "times": [0.5, 1.25],
    }
    answer = (await asked(scene)).json()
    assert [event["kind"] for event in answer["events"]] == ["touch"]
    assert answer["events"][0]["time"] == 1.0
    assert answer["events"][0]["impulses"] == {"normal": pytest.approx(15, rel=1e-15)}
    assert answer["events"][0]["energy_loss"] == pytest.approx(37.5, rel=1e-15)
    assert set(answer["events"][0]["rates"]["normal"]) == {"before", "after", "error"}
    assert [(phase["start"], phase["end"]) for phase in answer["phases"]] == [(0.0, 1.0), (1.0, None)]
    assert "problem" not in answer
    scene["bodies"]["q"] = ball | {"at": [0, 0.1]}
    scene["connections"][0]["place"] = "q"
    scene["connections"].append({"kind": "contact", "name": "pair", "a": "p", "b": "q", "restitution": 1})
    stopped = (await asked(scene | {"times": [0.5, 1.25]})).json()
    assert stopped["ended"] == "simultaneous-impacts"
    assert stopped["trajectory"]["rows"] == [0]
    assert {candidate["order"] for candidate in stopped["problem"]["candidates"]} >= {"together"}
    # The problem leads to its entry in the registry, and that to the section of its documentation.
    path, _, code = stopped["problem"]["type"].partition("#")
    async with client_of(SERVICE) as client:
        entries = {entry["code"]: entry for entry in (await client.get(path)).json()["undecided"]}
    assert code == stopped["problem"]["code"]
    assert entries[code]["type"] == stopped["problem"]["type"]
    document, _, section = entries[code]["documentation"].partition("#")
    assert f"\n## {section}\n" in (EXAMPLES.parents[1] / document).read_text(encoding="utf-8")


async def test_figures_beyond_doubles_are_null_with_a_warning() -> None:
    answer = (await asked({"gravity": [0, -1e300], "bodies": {"p": {"mass": 1e300, "at": [0, 1]}}})).json()
    assert answer["energy"]["potential"] is None
    assert {notice["code"] for notice in answer["warnings"]} == {"out-of-range"}
    assert answer["accelerations"]["p"]["linear"] == [0.0, -1e300]


async def test_columns_travel_as_arrays() -> None:
    question = PENDULUM | {"times": {"start": 0, "stop": 1, "count": 7}}
    async with client_of(SERVICE) as client:
        response = await client.post(PATH, json=question, headers={"accept": "application/x-npz"})
    with np.load(io.BytesIO(response.content)) as found:
        assert found["trajectory/columns/p.position/values"].shape == (7, 2)


class TestMethods:
    async def test_a_method_is_answered_with_its_error_and_its_work(self) -> None:
        """Released at 5 m, the height falls by g t^2/2 at first: Euler's first step leaves the place where it is."""
        question = PENDULUM | {"times": [0.0, 0.01], "outputs": ["trajectory"]}
        answer = (await asked(question | {"method": {"kind": "explicit-euler", "step": 0.01}})).json()
        right = (await asked(question)).json()["trajectory"]["columns"]["p.position"]["values"]
        column = answer["trajectory"]["columns"]["p.position"]
        assert column["values"] == [[3.0, -4.0], [3.0, -4.0]]
        true = np.hypot(*(np.array(column["values"][1]) - np.array(right[1])))
        assert true <= column["error"] <= true + 1e-14
        assert column["how"] == answer["accuracy"]["how"] == "measured against pairs"
        assert answer["method"] == "explicit-euler"
        assert answer["work"]["evaluations"] == answer["work"]["steps"] == 1
        assert answer["work"]["step"] == 0.01
        (warning,) = answer["warnings"]
        assert (warning["code"], warning["pointer"]) == ("accuracy-not-reached", "/method")

    async def test_without_a_method_nothing_is_said_of_one(self) -> None:
        answer = (await asked(PENDULUM | {"times": [1]})).json()
        assert not {"method", "work"} & set(answer)
        assert answer["accuracy"]["inherited"] is None

    async def test_no_motion_no_method(self) -> None:
        answer = (await asked(PENDULUM | {"method": {"kind": "radau", "tolerance": 1e-6}})).json()
        assert not {"method", "work", "trajectory"} & set(answer)


class TestSamples:
    async def test_digits(self) -> None:
        answer = (await asked(PENDULUM | {"times": [0.1, 0.7], "round": 4})).json()
        column = answer["trajectory"]["columns"]["p.position"]
        assert all(float(f"{x:.4g}") == x for row in column["values"] for x in row)
        assert 1e-4 < column["error"] < 1e-2
        assert [notice["code"] for notice in answer["warnings"]] == ["rounded-beyond-accuracy"]

    async def test_inherited_by_hand(self) -> None:
        """A stone at 2 m, thrown at 4 m/s upwards: 2 + 4 t - g t^2/2 changes by at most its terms times 1e-6."""
        stone = {"bodies": {"p": {"mass": 1, "at": [0, 2], "velocity": [0, 4]}}, "gravity": [0, -9.81]}
        answer = (await asked(stone | {"times": [1], "input_uncertainty": 1e-6})).json()
        inherited = answer["trajectory"]["columns"]["p.position"]["inherited"]
        assert inherited == pytest.approx(1e-6 * (2 + 4 + 9.81 / 2), rel=0.03)
        assert answer["accuracy"]["inherited"] == pytest.approx(inherited / (2 + 4 - 9.81 / 2), rel=1e-9)
        assert answer["accuracy"]["horizon"] < 1.0

    async def test_figure(self) -> None:
        question = PENDULUM | {
            "times": {"start": 0, "stop": 1, "count": 50},
            "outputs": ["trajectory", "forces-in-time"],
        }
        async with client_of(SERVICE) as client:
            response = await client.post(PATH, json=question, headers={"accept": "image/svg+xml"})
            refused = await client.post(PATH, json=PENDULUM, headers={"accept": "image/svg+xml"})
        drawing = ElementTree.fromstring(response.text)
        lines = [e for e in drawing.iter() if e.tag.endswith("polyline")]
        # The path; two components of the velocity; the force of the rod.
        assert len(lines) >= 4
        points = np.array([[float(x) for x in p.split(",")] for p in lines[0].attrib["points"].split()])
        places = np.array((await asked(question)).json()["trajectory"]["columns"]["p.position"]["values"])
        # One scale on both axes, upwards negative.
        scale = np.ptp(points[:, 0]) / np.ptp(places[:, 0])
        assert points[:, 1] - points[0, 1] == pytest.approx(-scale * (places[:, 1] - places[0, 1]), abs=0.11)
        assert refused.status_code == 422
        assert refused.json()["errors"][0]["pointer"] == "/times"


class TestCatalogue:
    async def test_described_examples_stand_beside_the_named_scenes(self) -> None:
        async with client_of(SERVICE) as client:
            listed = (await client.get(PATH)).json()["scenes"]
        described = {entry["name"]: entry["example"] for entry in listed if entry["path"] == PATH}
        assert {file.stem for file in EXAMPLES.glob("*.json")} == set(described)
        assert {entry["path"] for entry in listed} - {PATH} == {
            route.path for route in questions() if route.path.startswith("/v1/scenes/")
        } - {"/v1/scenes/import", "/v1/scenes/export"}
        for name, example in described.items():
            assert example == json.loads((EXAMPLES / f"{name}.json").read_text())


class TestPlan:
    def test_it_always_runs_in_a_compute_process(self) -> None:
        assert ROUTE.small is PostRoute.small

    async def test_searches_that_are_too_long_are_foreseen_to_be_refused(self) -> None:
        bodies = {f"p{i}": POINT | {"at": [i, 0]} for i in range(100)}
        request = {"bodies": bodies, "outputs": ["equilibria"]}
        (fault,) = (await asked({"path": PATH, "request": request}, "/v1/plan")).json()["errors"]
        assert (fault["code"], fault["pointer"]) == ("budget-exceeded", "/request/outputs")

    async def test_the_evaluations_of_a_step_are_foreseen_and_others_are_not(self) -> None:
        """Four a step by the classical Runge-Kutta method; the pendulum's three unknowns make each count as four."""
        question = PENDULUM | {"times": [2.0], "method": {"kind": "runge-kutta-4", "step": 0.01}}
        plan = (await asked({"path": PATH, "request": question}, "/v1/plan")).json()
        assert plan["cost"]["evaluations"] == (await asked(question)).json()["work"]["evaluations"] == 800
        assert made_in_short(question)["cost"]["evaluations"] == 800
        assert plan["method"] == {"kind": "runge-kutta-4", "step": 0.01}
        assert [entry["code"] for entry in plan["warnings"]] == ["accuracy-not-reached"]
        question["method"]["step"] = 1e-6
        for path, request in ((PATH, question), ("/v1/plan", {"path": PATH, "request": question})):
            problem = (await asked(request, path)).json()
            assert problem["errors"][0]["pointer"].endswith("/method/step")
            assert "8000000 evaluations are needed and 5000000 are allowed" in json.dumps(problem)
        chosen = question | {"method": {"kind": "dormand-prince-853", "tolerance": 1e-6}}
        assert made_in_short(chosen)["cost"]["evaluations"] is None

    async def test_refusals_are_reported_where_they_stand(self) -> None:
        plan = (await asked({"path": PATH, "request": of_rod(a="q")}, "/v1/plan")).json()
        assert [fault["pointer"] for fault in plan["errors"]] == ["/request/connections/0/a"]


def test_a_server_answers_in_its_compute_processes(server: Server) -> None:
    answer = httpx.post(f"{server.url}{PATH}", json=PENDULUM | {"times": [0, 1]}, timeout=PATIENCE).json()
    assert answer["model"]["name"] == "one period"
    refused = httpx.post(f"{server.url}{PATH}", json=of_rod(b="p"), timeout=PATIENCE)
    assert (refused.status_code, refused.json()["errors"][0]["pointer"]) == (422, "/connections/0")


async def test_searches_and_sums_are_answered_and_planned() -> None:
    """A pendulum of 5 m from (3, -4): lowest after a quarter of its period, as fast as its fall of 1 m makes it."""
    outputs = [
        {"when": {"quantity": "p.position.x", "equals": 0, "nth": 1}},
        {"extremes": "p.velocity.length"},
        "work-in-time",
        "paths-in-time",
        "momenta-in-time",
    ]
    question = PENDULUM | {"times": [0, 10], "outputs": outputs}
    response = await asked(question)
    assert response.status_code == 200, response.text
    answer = response.json()
    (first,) = answer["occurrences"]
    assert first["time"] == pytest.approx(answer["period"] / 4, rel=1e-14)
    assert first["error"] < 1e-13
    (speed,) = answer["extremes"]
    assert speed["largest"] == pytest.approx(19.62**0.5, rel=1e-14)
    assert speed["periodic"]
    columns = answer["trajectory"]["columns"]
    assert set(columns) == {
        "gravity.work", "p.path", "momentum", "angular_momentum", "p.momentum", "p.angular_momentum",
    }  # fmt: skip
    plan = await asked({"path": PATH, "request": question}, "/v1/plan")
    assert plan.status_code == 200, plan.text
    assert not plan.json().get("errors")


BLOCK: dict[str, Any] = {
    "gravity": [0, -9.81],
    "bodies": {"block": {"mass": 2, "at": [0, 0]}},
    "connections": [
        {"kind": "contact", "name": "floor", "place": "block", "on": {"at": [0, 0]}, "friction": 0.5},
        {"kind": "force", "name": "pull", "place": "block", "force": [1, 0]},
    ],
}


async def test_thresholds_of_rest() -> None:
    """A block of 2 kg moves from mu m g = 9.81 N on, to either side."""
    pull = {"thresholds": {"vary": "/connections/1/force/0", "between": [-50, 5]}}
    found = await asked(BLOCK | {"outputs": ["accelerations", pull], "times": [1]})
    assert found.status_code == 200, found.text
    (one,) = found.json()["thresholds"]
    assert (one["vary"], one["written"]) == ("/connections/1/force/0", 1)
    assert one["lower"]["beyond"] == {"floor": "slide back"}
    assert abs(one["lower"]["value"] + 9.81) <= 2.0**-50
    assert one["lower"]["error"] <= 2.0**-49
    assert one["upper"] == {"value": 5, "error": 0, "beyond": None, "problem": None}
    moving = await asked(
        BLOCK
        | {
            "outputs": [{"thresholds": {"vary": "/gravity/1", "between": [-10, 0]}}],
            "bodies": {"block": {"mass": 2, "at": [0, 0], "velocity": [1, 0]}},
        }
    )
    assert (moving.json()["thresholds"][0]["lower"], moving.json()["thresholds"][0]["upper"]) == (None, None)


async def test_thresholds_are_planned() -> None:
    pull = {"thresholds": {"vary": "/connections/1/force/0", "between": [-50, 5]}}
    plan = await asked({"path": PATH, "request": BLOCK | {"outputs": [pull]}}, "/v1/plan")
    assert plan.status_code == 200, plan.text


async def test_the_value_of_a_search_is_a_number_as_those_of_the_scene() -> None:
    """At 45 degrees a pendulum turns back: a formula has the height of the turn, the nearest double lies below it."""
    question = PENDULUM | {"let": {"root": "sqrt(2)"}, "bodies": {"p": {"mass": 1, "at": ["root/2", "-root/2"]}}}
    for written, count in (('"-root/2"', 1), ("-0.7071067811865476", 3), ("-0.70710678118654752440", 0)):
        search = '{"when": {"quantity": "p.position.y", "equals": ' + written + "}}"
        document = json.dumps(question | {"times": [2], "outputs": ["SEARCH"]}).replace('"SEARCH"', search)
        response = await sent(document.encode())
        assert response.status_code == 200, response.text
        found = response.json()["occurrences"]
        assert len(found) == count
        assert all(one["equals"] == -0.7071067811865476 for one in found)


async def test_a_sketch_is_answered_planned_and_certified() -> None:
    """The bob goes straight to its circle; what cannot be is refused by its pointer."""
    sketch = of_rod(length=2.5) | {"assemble": "nearest"}
    answer = (await asked(sketch | {"times": [0, 1]})).json()
    assert answer["assembly"]["distance"] == 2.5
    assert answer["assembly"]["bodies"]["p"] == {
        "at": [1.5, -2.0],
        "angle": None,
        "axes": None,
        "moved": 2.5,
        "turned": 0.0,
        "errors": answer["assembly"]["bodies"]["p"]["errors"],
    }
    assert max(x for x in answer["assembly"]["errors"].values()) < 1e-15
    assert answer["trajectory"]["columns"]["p.position"]["values"][0] == [1.5, -2.0]
    plan = (await asked({"path": PATH, "request": sketch}, "/v1/plan")).json()
    assert plan["answerable"] is True
    certified = (await asked(sketch | {"digits": 30}, "/v1/certified/scenes")).json()
    assert certified["forces"]["rod-1.force"]["value"].startswith("7.8480000")
    for wrong, pointer in (("near", "/assemble"), ({"nearest": ["q"]}, "/assemble/nearest/0"), (3, "/assemble")):
        refused = await asked(sketch | {"assemble": wrong})
        assert refused.status_code == 422
        assert refused.json()["errors"][0]["pointer"] == pointer
    refused = (await asked(of_rod(length=2.5))).json()
    assert '"p" at [1.5, -2]' in json.dumps(refused).replace('\\"', '"')


async def test_equations_are_answered_in_three_notations() -> None:
    """Of two bodies that nothing joins together, in one list."""
    bodies = {"bob": {"mass": 2, "at": [0.6, -0.8]}, "stone": {"mass": 1, "at": [3, 0], "velocity": [1, 2]}}
    rod = {"kind": "rod", "name": "rod", "a": "bob", "b": [0, 0]}
    question = {"gravity": [0, -9.81], "bodies": bodies, "connections": [rod], "outputs": ["equations"]}
    found = (await asked(question)).json()["equations"]
    assert [one["plain"] for one in found["equations"]] == [
        "bob.theta'' = -9.81*sin(bob.theta)",
        "stone.x'' = 0",
        "stone.y'' = -9.81",
    ]
    assert found["equations"][0]["latex"] == r"\ddot{\theta}_{\text{bob}} = -9.81 \, \sin \theta_{\text{bob}}"
    assert found["equations"][0]["mathml"].startswith("<math>")
    assert found["coordinates"] == {"bob.theta": "atan2(bob.x, -bob.y)", "stone.x": "stone.x", "stone.y": "stone.y"}
    assert found["places"]["bob.x"] == "sin(bob.theta)"
    assert found["closed_form"]["stone.y"]["plain"] == "2*t - 4.905*t^2"
    kinetic, potential = "bob.theta'^2 + 0.5*stone.x'^2 + 0.5*stone.y'^2", "19.62*cos(bob.theta) - 9.81*stone.y"
    assert found["lagrangian"]["plain"] == f"{kinetic} + {potential}"
    assert {one["name"] for one in found["conserved"]} == {"energy", "momentum of stone.x"}


async def test_equations_that_nobody_reads_are_refused() -> None:
    bodies = {f"p{i}": POINT | {"at": [i + 1, 0]} for i in range(30)}
    rods = [{"kind": "rod", "a": f"p{i}", "b": f"p{i - 1}" if i else [0, 0]} for i in range(30)]
    question = {"gravity": [0, -9.81], "bodies": bodies, "connections": rods, "outputs": ["energy", "equations"]}
    problem = (await asked(question)).json()
    assert (problem["code"], problem["errors"][0]["pointer"]) == ("budget-exceeded", "/outputs/1")
