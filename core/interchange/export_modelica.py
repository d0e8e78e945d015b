"""A scene written as a Modelica model: its equations of motion in the coordinates that suffice, and its start.

The model needs no library. Coordinates that constraints tie are determined by those that are fixed at the start;
multipliers are variables without derivatives, and Modelica tools differentiate the constraints themselves.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from core.errors import NotApplicable
from core.formulas import NAMES_OF_FUNCTIONS, Node, names_of, value_of
from core.formulas_in_doubles import DOUBLES
from core.interchange.left_out import LeftOutOfScene
from core.multibody.equations_answer import SceneEquations
from core.multibody.formulation.law_forces import MULTIPLIER
from core.multibody.formulation.notation.modelica import RESERVED, modelica
from core.multibody.language.motion_formulas import TIME
from core.multibody.language.scene import Scene
from core.multibody.solve import solve_scene

MODEL = "Scene"
"""What the model is called."""

STEP = 1e-6
"""Share by which coordinates are moved to see how constraints depend on them: the cube root of a double's rounding."""

RANK = 1e-7
"""Share of the largest derivative below which one of a constraint is none: what `STEP` leaves of rounding."""


def export_modelica(scene: Scene) -> tuple[str, list[LeftOutOfScene]]:
    """Return a scene as the text of a Modelica model, and what it leaves out.

    Raises
    ------
    InvalidParameter
        For a scene that cannot be.
    BudgetExceeded
        For more coordinates than written equations have.
    NotApplicable
        For a law whose function Modelica does not have.
    """
    equations = solve_scene(replace(scene, attitudes=False), outputs=("equations",)).equations
    if equations is None:
        raise NotApplicable("mechanics leaves open how the motion begins: there are no equations of it")
    left_out = [
        LeftOutOfScene(f"/connections/{i}", name, f"the model is of the first phase: {why}")
        for name, (i, connection) in zip(scene.names(), scene.numbered(), strict=True)
        for applies, why in (
            (connection.one_sided, "what touches or is taut stays so"),
            (bool(connection.occasions()), "what begins, ends or strikes has no part in it later"),
            (scene.switches_in(connection), "a formula of several pieces has the piece of the start"),
        )
        if applies
    ]
    return _Model(equations).text(), left_out


class _Model:
    """The variables of a model and its equations."""

    def __init__(self, found: SceneEquations) -> None:
        self.found = found
        self.others: dict[str, Node] = {
            **{name: node for name, node in found.places.items() if name not in found.coordinates},
            **{name: one.sides[0] for name, one in found.forces.items()},
        }
        occurring = {name for one in found.equations for side in one.sides for name in names_of(side)}
        self.multipliers = sorted(name for name in occurring if name.startswith(MULTIPLIER))
        self.names: dict[str, str] = {}
        self.rates: dict[str, str] = {}
        for name in (*found.coordinates, *found.constants, *self.multipliers, *self.others):
            self.names[name] = self._identifier(name)
        for name in found.coordinates:
            if found.start[name].rate is not None:
                self.rates[name] = self._identifier(f"{name}.rate")

    def _identifier(self, name: str) -> str:
        """Return a word of letters, digits and _ that nothing else is called."""
        plain = re.sub(r"\W", "_", name)
        found, k = plain, 2
        taken = {*self.names.values(), *self.rates.values(), *RESERVED, *NAMES_OF_FUNCTIONS, MODEL, "pi"}
        while found in taken:
            found, k = f"{plain}_{k}", k + 1
        return found

    def written(self, node: Node) -> str:
        """Return a formula in Modelica."""
        return modelica(node, self._called)

    def _called(self, name: str) -> str:
        """Return what stands for a name of an equation, of which each prime is a derivative by time."""
        plain = name.rstrip("'")
        primes = len(name) - len(plain)
        if name == TIME and name not in self.names:
            return "time"
        own, rate = self.names[plain], self.rates.get(plain)
        if primes == 0:
            return own
        if rate is None:
            return f"der({own})"
        return rate if primes == 1 else f"der({rate})"

    def text(self) -> str:
        """Return the model."""
        found = self.found
        tied, tied_rates = self.tied()
        lines = [f"model {MODEL}", '  "Equations of motion in SI units and radians"']
        lines.append("  constant Real pi = 3.141592653589793;")
        lines += [f"  constant Real {self.names[name]} = {value!r};" for name, value in found.constants.items()]
        for name in found.coordinates:
            start = found.start[name]
            begins = f"(start = {start.value!r}, fixed = {'false' if name in tied else 'true'})"
            lines.append(f"  Real {self.names[name]}{begins};")
            if name in self.rates:
                begins = f"(start = {start.rate!r}, fixed = {'false' if name in tied_rates else 'true'})"
                lines.append(f"  Real {self.rates[name]}{begins};")
        lines += [f"  Real {self.names[name]};" for name in (*self.multipliers, *self.others)]
        lines.append("equation")
        lines += [f"  der({self.names[name]}) = {rate};" for name, rate in self.rates.items()]
        lines += [f"  {' = '.join(map(self.written, one.sides))};" for one in (*found.equations, *found.constraints)]
        lines += [f"  {self.names[name]} = {self.written(node)};" for name, node in self.others.items()]
        lines.append(f"end {MODEL};")
        return "\n".join(lines) + "\n"

    def tied(self) -> tuple[set[str], set[str]]:
        """Return as many coordinates and as many rates as constraints determine at the start."""
        names = list(self.rates)
        values = {name: one.value for name, one in self.found.start.items()} | dict(self.found.constants) | {TIME: 0.0}
        primed = {f"{name}'": one.rate for name, one in self.found.start.items() if one.rate is not None}
        start = {**values, **primed}
        of_places, of_rates = list[Node](), list[Node]()
        for one in self.found.constraints:
            row = Node("-", inner=one.sides)
            (of_rates if any(name.endswith("'") for name in names_of(row)) else of_places).append(row)
        places = [[_slope(row, start, name) for name in names] for row in of_places]
        rates = [*places, *([_slope(row, start, f"{name}'") for name in names] for row in of_rates)]
        return {names[k] for k in _pivots(places)}, {names[k] for k in _pivots(rates)}


def _slope(row: Node, start: Mapping[str, float], name: str) -> float:
    """Return the derivative of what a constraint holds at zero by a coordinate or rate."""
    step = STEP * max(1.0, abs(start[name]))
    ahead, behind = (value_of(row, {**start, name: start[name] + way * step}, DOUBLES) for way in (1.0, -1.0))
    return (ahead - behind) / (2 * step)


def _pivots(rows: Sequence[Sequence[float]]) -> list[int]:
    """Return the columns that elimination with complete pivoting chooses."""
    left, chosen = np.array(rows, np.float64), list[int]()
    largest = float(np.abs(left).max(initial=0.0))
    while left.size and float(np.abs(left).max()) > RANK * largest:
        i, k = divmod(int(np.argmax(np.abs(left))), left.shape[1])
        chosen.append(k)
        left = np.delete(left - np.outer(left[:, k] / left[i, k], left[i]), i, axis=0)
        left[:, chosen] = 0.0
    return chosen
