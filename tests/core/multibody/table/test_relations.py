"""Relations between places and angles by formula, against closed forms and against tracks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from core.errors import InvalidParameter, NotApplicable, PlacesDisagree
from core.multibody.answer import SceneSolution
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene

TIMES = np.array([0.0, 0.3, 1.0])
ALL = ("accelerations", "forces", "energy", "trajectory", "forces-in-time", "energy-in-time", "work-in-time")


def answer(description: dict[str, Any], outputs: Sequence[str] = ALL) -> SceneSolution:
    return solve_scene(scene_from(description), TIMES, outputs)


def columns(found: SceneSolution, *names: str) -> list[Any]:
    assert found.trajectory is not None
    return [found.trajectory.columns[name].values for name in names]


def relation(of: str, equals: Any = 0) -> dict[str, Any]:
    return {"kind": "relation", "name": "r", "of": of, "equals": equals}


def wheel(inertia: Any, x: Any) -> dict[str, Any]:
    return {"mass": 1, "inertia": inertia, "at": [x, 0]}


def point(x: Any, y: Any, *connections: dict[str, Any]) -> dict[str, Any]:
    return {"gravity": [0, -10], "bodies": {"p": {"mass": 1, "at": [x, y]}}, "connections": list(connections)}


def test_two_gears() -> None:
    """2 a + 5 b = 0 with the force F: 2 a'' = 7 + 2 F and 3 b'' = 5 F, so that F = -7/(2 + 25/3)."""
    pins = [{"kind": "pin", "a": name, "b": [x, 0]} for name, x in (("a", 0), ("b", 5))]
    torque = {"kind": "torque", "body": "a", "torque": 7}
    gears = {"gravity": [0, 0], "bodies": {"a": wheel(2, 0), "b": wheel(3, 5)},
             "connections": [*pins, relation("2*a.angle + 5*b.angle"), torque]}  # fmt: skip
    found = answer(gears)
    a, b, force = columns(found, "a.angle", "b.angle", "r.force")
    pull = -7 / (2 + 25 / 3)
    np.testing.assert_allclose(force, pull, rtol=1e-15)
    np.testing.assert_allclose(a, (7 + 2 * pull) / 4 * TIMES**2, rtol=1e-15)
    np.testing.assert_allclose(b, 5 * pull / 6 * TIMES**2, rtol=1e-15)
    assert found.model.name == "constant acceleration"
    assert found.forces is not None
    assert found.forces["r.force"].unit == "N m"


def test_a_rack_and_its_pinion() -> None:
    """y = a/2 with an inertia of 2 behind it: y'' = -10/(1 + 2/(1/2)^2)."""
    pinion = {"kind": "pin", "a": "w", "b": [0, 0]}
    guide = {"kind": "slider", "a": "p", "b": [1, 0], "slope": {"degrees": 90}}
    rack = point(1, 0, pinion, guide, relation("p.y", "0.5*w.angle"))
    rack["bodies"]["w"] = wheel(2, 0)
    place, force = columns(answer(rack), "p.position", "r.force")
    np.testing.assert_allclose(place[:, 1], -10 / 9 / 2 * TIMES**2, rtol=1e-15)
    np.testing.assert_allclose(force, 10 - 10 / 9, rtol=1e-15)


def test_a_parabola_is_the_track() -> None:
    track = {"kind": "track", "name": "r", "place": "p", "on": {"at": [0, 0], "curvature": 2}}
    own, other = (answer(point(1, 1, one)) for one in (relation("p.y", "p.x^2"), track))
    np.testing.assert_allclose(*(columns(one, "p.position")[0] for one in (own, other)), atol=4e-15)


def test_a_relation_with_the_time_drives() -> None:
    """On a line that turns with the angle 2 t about the origin from rest along it: r'' = 4 r - 10 sin(2 t)."""
    line = point(1, 0, relation("p.y*cos(2*t)", "p.x*sin(2*t)"))
    line["bodies"]["p"]["velocity"] = [0, 2]
    place, work = columns(answer(line), "p.position", "r.work")
    # r = A exp(2 t) + B exp(-2 t) + (10/8) sin(2 t), with r = 1 and r' = 0 at the start.
    grown, fallen = (1 - 1.25) / 2, (1 + 1.25) / 2
    radius = grown * np.exp(2 * TIMES) + fallen * np.exp(-2 * TIMES) + 1.25 * np.sin(2 * TIMES)
    rate = 2 * grown * np.exp(2 * TIMES) - 2 * fallen * np.exp(-2 * TIMES) + 2.5 * np.cos(2 * TIMES)
    exact = radius[:, None] * np.stack([np.cos(2 * TIMES), np.sin(2 * TIMES)], axis=1)
    np.testing.assert_allclose(place, exact, atol=1e-14)
    energy = (rate**2 + 4 * radius**2) / 2 + 10 * exact[:, 1]
    np.testing.assert_allclose(work, energy - 2, atol=1e-13)


def test_places_that_are_rounded_are_put_onto_a_relation() -> None:
    found = answer(point(0.3, "0.0270000001", relation("p.y", "p.x^3")), ("trajectory",))
    (place,) = columns(found, "p.position")
    np.testing.assert_allclose(place[:, 1], place[:, 0] ** 3, atol=1e-16)


def test_a_bead_on_a_helix() -> None:
    """x + i y = exp(3 i z): s' = sqrt(10) z', so that z'' = -g/10."""
    bead = {"gravity": [0, 0, -10], "bodies": {"p": {"mass": 2, "at": [1, 0, 0]}},
            "connections": [relation("p.x", "cos(3*p.z)"), relation("p.y", "sin(3*p.z)") | {"name": "s"}]}  # fmt: skip
    found = answer(bead)
    (place,) = columns(found, "p.position")
    z = -(TIMES**2) / 2
    np.testing.assert_allclose(place, np.stack([np.cos(3 * z), np.sin(3 * z), z], axis=1), atol=4e-15)


WIRES = {
    "sine": ("sin(3*p.x)/10", "0.2"),
    "catenary": ("cosh(p.x)", "1"),
    "bell": ("-exp(-p.x^2)", "0.5"),
    "arc tangent": ("p.x^2 + atan(p.x)", "0.5"),
    "logarithm": ("-log(1 + p.x)", "0.5"),
    "power": ("(1 + p.x^2)^(2/3)", "0.5"),
    "arc sine": ("p.x^2 - asin(p.x/4)", "0.5"),
}


@pytest.mark.parametrize("wire", WIRES)
def test_a_bead_on_a_wire_keeps_its_energy_and_stays_on_it(wire: str) -> None:
    """The energy at the start is that of the height; the place on the wire is compared with the formula itself."""
    formula, x = WIRES[wire]
    found = answer(point(x, formula.replace("p.x", x), relation("p.y", formula)))
    place, velocity = columns(found, "p.position", "p.velocity")
    functions = {name: getattr(np, name) for name in ("sin", "cosh", "exp", "log")}
    functions |= {"atan": np.arctan, "asin": np.arcsin}

    def height(u: Any) -> Any:
        return eval(formula.replace("p.x", "u").replace("^", "**"), functions | {"u": u})

    np.testing.assert_allclose(place[:, 1], height(place[:, 0]), atol=1e-14)
    slope = np.imag(height(place[:, 0] + 1e-30j)) / 1e-30
    np.testing.assert_allclose(velocity[:, 1], slope * velocity[:, 0], atol=1e-13)
    np.testing.assert_allclose((velocity**2).sum(axis=1) / 2 + 10 * place[:, 1], 10 * place[0, 1], atol=1e-13)
    assert found.trajectory is not None
    assert found.trajectory.columns["p.position"].error < 1e-12


def test_a_slotted_bar_follows_the_cosine_of_a_crank() -> None:
    crank = {"mass": 1, "inertia": "0.1", "at": ["0.5", 0], "places": {"top": ["-0.5", 0]}}
    guide = {"kind": "slider", "a": "p", "b": [0, 1], "slope": 0}
    scene = point(
        "0.3", 1, {"kind": "pin", "a": "crank.top", "b": [0, 0]}, guide, relation("p.x", "0.3*cos(crank.angle)")
    )
    scene["bodies"]["crank"] = crank
    place, angle = columns(answer(scene), "p.position", "crank.angle")
    np.testing.assert_allclose(place[:, 0], 0.3 * np.cos(angle), atol=1e-15)


def test_rounded_places_are_put_onto_a_curve_and_its_functions_follow() -> None:
    found = answer(point("0.2", "0.0564642473", relation("p.y", "sin(3*p.x)/10")), ("trajectory",))
    (place,) = columns(found, "p.position")
    np.testing.assert_allclose(place[:, 1], np.sin(3 * place[:, 0]) / 10, atol=1e-16)


def test_a_sketch_is_not_put_onto_functions_of_places() -> None:
    sketch = point(1, 0, relation("p.y", "sin(p.x)")) | {"assemble": "nearest"}
    with pytest.raises(InvalidParameter, match="other than square roots"):
        answer(sketch)
    with pytest.raises(PlacesDisagree):
        answer(point(1, 0, relation("p.y", "sin(p.x)")))


@pytest.mark.parametrize(
    ("of", "equals", "rule", "pointer"),
    [
        ("p.y", "abs(p.x)", "one piece", "equals"),
        ("p.y", "p.vx", 'unlike "p.vx"', "equals"),
        ("p.z", 0, 'unlike "p.z"', "of"),
        ("3*t", 0, "name places or angles", "of"),
    ],
)
def test_what_no_relation_can_say_is_refused(of: str, equals: Any, rule: str, pointer: str) -> None:
    with pytest.raises(InvalidParameter, match=rule) as refused:
        answer(point(1, 0, relation(of, equals)))
    assert tuple(refused.value.path) == ("connections", 0, pointer)


def test_places_that_do_not_fit_a_relation_are_refused_with_the_nearest() -> None:
    with pytest.raises(PlacesDisagree, match=r"be 0\.5") as refused:
        answer(point(0, "0.5", relation("p.y", "p.x")))
    assert refused.value.remedy is not None
    assert "[0.25, 0.25]" in refused.value.remedy


def test_an_unknown_name_is_answered_with_what_relations_may_have() -> None:
    with pytest.raises(InvalidParameter, match='use known names, unlike "foo"') as refused:
        answer(point(0, 1, relation("foo(p.x)")))
    assert (refused.value.path, refused.value.remedy) == (
        ("connections", 0, "of"),
        "names: p.x, p.y, t; functions: sqrt, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, log, atan2",
    )


@pytest.mark.parametrize(
    "always",
    ["p.x - p.x", "(p.x + p.y)^2 - p.x^2 - p.y^2 - 2*p.x*p.y", "cos(p.x)^2 + sin(p.x)^2 - 1", "(0.1 + 0.2 - 0.3)*p.x"],
)
@pytest.mark.parametrize("x", [0, 1000])
def test_a_relation_that_is_always_true_is_noticed_and_ties_nothing(always: str, x: float) -> None:
    found = answer(point(x, 0, relation(always)))
    noticed = "r.force is not determined by the scene: what r says with it is true anyway"
    assert noticed in found.model.noticed
    np.testing.assert_allclose(columns(found, "p.velocity")[0], np.outer(TIMES, [0, -10]), rtol=1e-14, atol=1e-13)
    assert found.forces is not None
    assert not found.forces["r.force"].determined
    tied = [relation("p.x - p.y"), {**relation("2*p.x - 2*p.y"), "name": "s"}]
    for connections in (tied[:1], tied):
        assert not any("anyway" in one for one in answer(point(0, 0, *connections)).model.noticed)


@pytest.mark.parametrize("equals", ["sin(w.angle)", "tan(w.angle)", "w.angle*cos(w.angle)", "w.angle*exp(w.angle^2)"])
@pytest.mark.parametrize("beside", [False, True])
def test_a_relation_that_holds_at_the_start_alone_is_singular_there(equals: str, beside: bool) -> None:
    """Both sides have the same slope at zero, and differ by the third power of the angle."""
    thrown = {"p": {"mass": 1, "at": [0.5, 0], "velocity": [10, 10]}} if beside else {}
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"w": wheel(1, 3), **thrown},
        "connections": [
            {"kind": "pin", "a": "w", "b": [3, 0]},
            {"kind": "torque", "body": "w", "torque": 1},
            relation("w.angle", equals),
        ],
    }
    with pytest.raises(NotApplicable, match="singular"):
        answer(scene, ("trajectory",))
