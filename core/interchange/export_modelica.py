"""A scene written as a Modelica model: its equations of motion in the coordinates that suffice, and its start.

The model needs no library. Coordinates that constraints tie are determined by those that are fixed at the start;
multipliers are variables without derivatives, and Modelica tools differentiate the constraints themselves.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from core.errors import NotApplicable
from core.formulas import FUNCTIONS, NAMES_OF_FUNCTIONS, Arithmetic, Formula
from core.interchange.draft import LeftOut
from core.multibody.equations_answer import SceneEquations
from core.multibody.language.scene import Scene
from core.multibody.solve import solve_scene

IN_MODELICA = ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log", "abs")
"""Functions that Modelica has under the names of formulas, beside those of two arguments."""

OF_TWO = ("atan2", "min", "max")
"""Functions of two arguments that it has."""

RESERVED = {"time", "der", "model", "end", "equation", "if", "then", "else", "and", "or", "not", "initial", "pi"}
"""Words that no variable may be called."""

FIRST_PHASE = "the model is of the first phase of the motion: what touches or is taut there stays so"

STEP = 1e-6
"""Share by which coordinates are moved to see how constraints depend on them: the cube root of a double's rounding."""

RANK = 1e-7
"""Share of the largest derivative below which one of a constraint is none: what `STEP` leaves of rounding."""


def export_modelica(scene: Scene) -> tuple[str, list[LeftOut]]:
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
        LeftOut(
            "/connections/" + str(i), name, "the model is of the first phase: what touches or is taut stays so", True
        )
        for name, (i, connection) in zip(scene.names(), scene.numbered(), strict=True)
        if connection.one_sided
    ]
    return _Model(equations).text(), left_out


class _Model:
    """The variables of a model and its equations."""

    def __init__(self, found: SceneEquations) -> None:
        self.found = found
        multipliers = sorted(set(re.findall(r"lambda_\d+", " ".join(one.plain for one in found.equations))))
        self.others = {
            **{name: text for name, text in found.places.items() if name not in found.coordinates},
            **{name: one.plain for name, one in found.forces.items()},
        }
        self.multipliers = multipliers
        self.names: dict[str, str] = {}
        self.rates: dict[str, str] = {}
        for name in (*found.coordinates, *found.constants, *multipliers, *self.others):
            self.names[name] = self._identifier(name)
        for name in found.coordinates:
            if found.start[name].rate is not None:
                self.rates[name] = self._identifier(f"{name}.rate")
        listed = sorted(self.names, key=len, reverse=True)
        own = "|".join(re.escape(name) for name in listed)
        words = r"(?P<word>[A-Za-z]\w*)"
        self.pattern = re.compile(rf"(?<![\w.])(?:(?P<name>{own})(?![\w.])(?P<primes>'*)|{words})" if own else words)

    def _identifier(self, name: str) -> str:
        """Return a word of letters, digits and _ that nothing else is called."""
        plain = re.sub(r"\W", "_", name)
        found, k = plain, 2
        taken = {*self.names.values(), *self.rates.values(), *RESERVED, *NAMES_OF_FUNCTIONS}
        while found in taken:
            found, k = f"{plain}_{k}", k + 1
        return found

    def written(self, text: str) -> str:
        """Return a formula in Modelica."""
        return self.pattern.sub(self._word, text)

    def _word(self, match: re.Match[str]) -> str:
        name = match.groupdict().get("name")
        if name is None:
            word = match.group("word")
            if word == "t":
                return "time"
            if word not in (*IN_MODELICA, *OF_TWO, "pi", "e", "E"):
                remedy = "write the law without pieces and tables"
                raise NotApplicable(f"Modelica has no {word} as formulas have it", path=("format",), remedy=remedy)
            return word
        own, primes = self.names[name], len(match.group("primes"))
        if primes == 0:
            return own
        rate = self.rates.get(name)
        if rate is None:
            return f"der({own})"
        return rate if primes == 1 else f"der({rate})"

    def text(self) -> str:
        """Return the model."""
        found = self.found
        tied, tied_rates = self.tied()
        lines = ["model Scene", '  "Equations of motion in SI units and radians"']
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
        lines += [f"  {self.written(one.plain)};" for one in (*found.equations, *found.constraints)]
        lines += [f"  {self.names[name]} = {self.written(text)};" for name, text in self.others.items()]
        lines.append("end Scene;")
        return "\n".join(lines) + "\n"

    def tied(self) -> tuple[set[str], set[str]]:
        """Return as many coordinates and as many rates as constraints determine at the start."""
        names = list(self.rates)
        values = {name: one.value for name, one in self.found.start.items()} | dict(self.found.constants) | {"t": 0.0}
        primed = {f"{name}'": one.rate for name, one in self.found.start.items() if one.rate is not None}
        start, texts = {**values, **primed}, [one.plain for one in self.found.constraints]
        of_places, of_rates = (
            [_left_side(text, [*start]) for text in texts if ("'" in text) is by] for by in (False, True)
        )
        places = [[_slope(row, start, name) for name in names] for row in of_places]
        rates = [*places, *([_slope(row, start, f"{name}'") for name in names] for row in of_rates)]
        return {names[k] for k in _pivots(places)}, {names[k] for k in _pivots(rates)}


def _left_side(text: str, known: Sequence[str]) -> Callable[[Mapping[str, float]], float]:
    """Return what a constraint holds at zero, as a function of coordinates and rates."""
    # The grammar of formulas has names of letters, digits and points.
    plain = {name: f"v{k}" for k, name in enumerate(known)}
    listed = sorted(plain, key=len, reverse=True)
    pattern = re.compile("|".join(rf"(?<![\w.]){re.escape(name)}(?![\w.'])" for name in listed))
    left, _, right = text.partition(" = ")
    renamed = pattern.sub(lambda match: plain[match.group()], f"({left}) - ({right})")
    formula = Formula.read(renamed, list(plain.values()), (*FUNCTIONS, "atan2"))
    return lambda values: float(formula.value({plain[name]: value for name, value in values.items()}, DOUBLES))


def _slope(row: Callable[[Mapping[str, float]], float], start: Mapping[str, float], name: str) -> float:
    step = STEP * max(1.0, abs(start[name]))
    ahead, behind = ({**start, name: start[name] + way * step} for way in (1.0, -1.0))
    return (row(ahead) - row(behind)) / (2 * step)


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


DOUBLES = Arithmetic[float](
    float,
    lambda: math.pi,
    lambda one, other: one / other,
    lambda one, other: one**other,
    {
        name: {"asin": np.arcsin, "acos": np.arccos, "atan": np.arctan}.get(name, getattr(np, name, abs))
        for name in FUNCTIONS
    }
    | {"atan2": np.arctan2},
)
"""Formulas in doubles."""
