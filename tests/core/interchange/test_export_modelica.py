"""Scenes as Modelica models: read back by a reader of its own, they move as the answers of the scenes say."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.errors import BudgetExceeded, NotApplicable
from core.interchange.export_modelica import export_modelica
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene
from service.requests.described_scene import SCENE_FIELDS
from service.routes.scene_catalogue import scene_catalogue

FUNCTIONS = {name: getattr(math, name) for name in ("sin", "cos", "tan", "sqrt", "exp", "atan2")}

WITHOUT_CONSTRAINTS = (
    *("double-pendulum", "driven-duffing-oscillator", "kovalevskaya-top", "fall-with-drag", "swinging-atwood-machine"),
    *(
        "lagrange-top",
        "pendulum-on-cart",
        "kapitza-pendulum",
        "damped-oscillator",
        "harmonic-ellipse",
        "elastic-pendulum",
    ),
)


@dataclass
class Read:
    """A model: variables with (start, fixed), constants, and equations as functions of names."""

    variables: dict[str, tuple[float, bool] | None]
    constants: dict[str, float]
    equations: list[Callable[[Mapping[str, float]], float]]


def question(name: str) -> dict[str, Any]:
    return {key: value for key, value in scene_catalogue()[name].question.items() if key in SCENE_FIELDS}


def read(text: str) -> Read:
    """Return what a model says: each line has one of three forms, and der(x) is a name of its own."""
    head, body = text.split("equation\n")
    constants = {name: float(value) for name, value in re.findall(r"constant Real (\w+) = (\S+);", head)}
    variables: dict[str, tuple[float, bool] | None] = {}
    for name, start, fixed in re.findall(r"^  Real (\w+)(?:\(start = (\S+), fixed = (\w+)\))?;", head, re.MULTILINE):
        variables[name] = (float(start), fixed == "true") if start else None
    lines = body.removesuffix("end Scene;\n").strip().split("\n")
    return Read(variables, constants, [residual(line.strip().removesuffix(";")) for line in lines])


def residual(line: str) -> Callable[[Mapping[str, float]], float]:
    left, right = re.sub(r"der\((\w+)\)", r"der_\1", line).replace("^", "**").split(" = ")
    code = compile(f"({left}) - ({right})", line, "eval")
    # The text is the project's own, and has no names but functions and variables.
    return lambda values: float(eval(code, {"__builtins__": {}}, {**FUNCTIONS, **values}))


def moved(model: Read, end: float) -> dict[str, float]:
    """Return the variables at a time: derivatives and other variables are those that satisfy the equations."""
    states = [name for name, start in model.variables.items() if start is not None]
    unknown = [f"der_{name}" for name in states] + [name for name, start in model.variables.items() if start is None]

    def solved(t: float, state: Any) -> dict[str, float]:
        known = {**model.constants, "time": t, **dict(zip(states, state, strict=True))}
        others = dict.fromkeys(unknown, 0.0)
        # Formulas may use other variables that others define: twice or three times solved, all are known.
        for _ in range(3):
            base = np.array([one(known | others) for one in model.equations])
            matrix = [
                [one(known | others | {name: others[name] + 1.0}) - b for name in unknown]
                for one, b in zip(model.equations, base, strict=True)
            ]
            step = np.linalg.solve(np.array(matrix), -base)
            others = {name: others[name] + float(x) for name, x in zip(unknown, step, strict=True)}
        return known | others

    def rate(t: float, state: Any) -> list[float]:
        found = solved(t, state)
        return [found[f"der_{name}"] for name in states]

    begun = [start[0] for name in states if (start := model.variables[name]) is not None]
    found = solve_ivp(rate, (0.0, end), begun, method="DOP853", rtol=1e-10, atol=1e-12)
    return solved(end, found.y[:, -1])


@pytest.mark.parametrize("name", WITHOUT_CONSTRAINTS)
def test_a_model_moves_as_the_scene_does(name: str) -> None:
    text, _ = export_modelica(scene_from(question(name)))
    model, end = read(text), 0.3
    assert all(start is None or start[1] for start in model.variables.values())
    found = moved(model, end)
    trajectory = solve_scene(scene_from(question(name)), [end], ("trajectory",)).trajectory
    assert trajectory is not None
    compared = 0
    for body in question(name)["bodies"]:
        for k, axis in enumerate("xyz"[: trajectory.columns[f"{body}.position"].values.shape[1]]):
            if f"{body}_{axis}" in found:
                compared += 1
                expected = trajectory.columns[f"{body}.position"].values[0, k]
                assert found[f"{body}_{axis}"] == pytest.approx(expected, rel=1e-8, abs=1e-9), (body, axis)
        for k in (1, 2, 3):
            if f"{body}_omega_{k}" in found:
                compared += 1
                expected = trajectory.columns[f"{body}.angular_velocity"].values[0, k - 1]
                assert found[f"{body}_omega_{k}"] == pytest.approx(expected, rel=1e-8)
    assert compared


@pytest.mark.parametrize(("name", "free", "free_rates"), [("four-bar-linkage", 1, 1), ("coin-rolls-round", 5, 3)])
def test_constraints_tie_what_is_not_fixed(name: str, free: int, free_rates: int) -> None:
    """As many places and rates are fixed as there are degrees of freedom: a coin has five, and three that are rates."""
    model = read(export_modelica(scene_from(question(name)))[0])
    fixed = {key for key, start in model.variables.items() if start is not None and start[1]}
    assert sum(not key.endswith("_rate") for key in fixed) == free
    assert sum(key.endswith("_rate") for key in fixed) == free_rates


def test_a_model_of_contacts_is_one_of_the_first_phase() -> None:
    _, left_out = export_modelica(scene_from(question("ladder-leaves-wall")))
    assert [one.pointer for one in left_out] == ["/connections/0", "/connections/1"]


def test_names_that_modelica_has_are_no_variables() -> None:
    """Keywords, the time and the model's own names, and two names that differ by a sign that Modelica does not have."""
    names = ("block", "loop", "when", "parameter", "in", "time", "der", "Real", "Scene")
    law = " + ".join(f"sin({name}*x)" for name in names)
    body = {"mass": 1, "at": [0, 0], "velocity": [1, 0]}
    scene = {
        "let": dict.fromkeys(names, 1.5),
        "bodies": {"x-y": body, "x_y": body},
        "connections": [{"kind": "force", "name": "f", "place": "x-y", "force": [law, 0]}],
    }
    text, _ = export_modelica(scene_from(scene))
    declared = re.findall(r"Real (\w+)", text)
    assert len(declared) == len(set(declared))
    assert {f"{name}_2" for name in names} <= set(declared)
    assert not {*names} & {*declared}


@pytest.mark.parametrize("law", ["if(x - 1, -x, 2)", "max(x - 1, -x)", "k(x)", "-m*sign(vx)"])
def test_a_law_of_pieces_is_that_of_the_start_and_said_to_be(law: str) -> None:
    """Also where its pieces are those of a table."""
    forces = [
        {"kind": "force", "name": name, "place": "b", "force": [text, 0]} for name, text in (("f", law), ("g", "x"))
    ]
    body = {"mass": 1, "at": [0.2, 0], "velocity": [1, 0]}
    scene = {
        "let": {"k": {"points": [[-1, 0], [0, 2], [3, 1]]}, "m": "abs(-2)"},
        "bodies": {"b": body},
        "connections": forces,
    }
    _, left_out = export_modelica(scene_from(scene))
    assert [(one.pointer, one.why.rpartition(": ")[2]) for one in left_out] == [
        ("/connections/0", "a formula of several pieces has the piece of the start")
    ]


def test_what_has_no_equations_or_functions_is_refused() -> None:
    with pytest.raises(BudgetExceeded):
        export_modelica(scene_from(question("bicycle")))
    with pytest.raises(NotApplicable, match="mechanics leaves open"):
        export_modelica(scene_from(question("painleve-chalk")))
