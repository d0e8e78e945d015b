"""Compute published problems in pairs of doubles and write docs/references.md: `make references`.

python -m benchmarks.references
"""

from __future__ import annotations

from decimal import Decimal, localcontext
from pathlib import Path
from typing import NamedTuple

import numpy as np
from flint import arb

from benchmarks.references.problems import PROBLEMS, Problem
from core.balls import precision
from core.multibody.algebra.polynomials import BITS
from core.multibody.language.reading import scene_from
from core.multibody.motion.modelling import modelled

PAGE = Path(__file__).parents[2] / "docs" / "references.md"
DIGITS = 22
"""Significant digits that are printed, where the error allows."""

INTRODUCTION = """# Published problems as references

Problems that others publish to compare integrators and simulators with. Each is a described scene
([`problems.py`](../benchmarks/references/problems.py)); its motion is computed twice in pairs of doubles (106 bits), of
which the difference states the error. `make references` computes all of them and writes this page. Errors are
estimates, not proofs, and smaller than what the last printed digit is worth.

The last column is the published figure less ours: published digits beyond it are not those of the problem. A source
that integrated in doubles prints more digits than it knows. Some problems are computed by other formulations of the
equations in [a test](../tests/benchmarks/test_references.py), which confirm the figures here: the squeezing mechanism
in its seven angles, the car axis in extended precision, Bricard's mechanism by its energy, the top by Euler's
equations, and the pendulums in their angles.
"""


class Reference(NamedTuple):
    """A figure of a problem with its error."""

    figure: str
    value: Decimal
    error: float


def computed(problem: Problem) -> list[Reference]:
    """Return the figures of a problem at its time."""
    with localcontext() as context, precision(BITS):
        context.prec = 40
        whole = modelled(scene_from(dict(problem.scene))).whole
        time = float(problem.time)
        # What the time has beyond a double, times the rate: its square does not count.
        beyond = Decimal(problem.time) - Decimal(time)
        states = whole.states(np.array([time]), finer=True)
        places, rates = (
            [Decimal(float(high)) + Decimal(float(low)) for high, low in pairs[0]] for pairs in (states.q, states.v)
        )
        gain = whole.accelerations(states.q, states.v)[0]
        names, found = whole.measures.table.names, []
        for figure in problem.figures:
            body, _, column = figure.rpartition(".")
            if column == "angle" and figure not in names:
                c, s = (names.index(f"{body}.{one}") for one in ("cos", "sin"))
                cosine, sine = (places[i] + beyond * rates[i] for i in (c, s))
                angle = arb.atan2(arb(str(sine)), arb(str(cosine))).mid()
                error = float(np.hypot(states.q_error[0, c], states.q_error[0, s]))
                found.append(Reference(figure, Decimal(angle.str(36, radius=False)), error))
            elif column.startswith("v"):
                i = names.index(f"{body}.{column[1:]}")
                found.append(Reference(figure, rates[i] + beyond * Decimal(float(gain[i])), states.v_error[0, i]))
            else:
                i = names.index(figure)
                found.append(Reference(figure, places[i] + beyond * rates[i], states.q_error[0, i]))
        return found


def shown(value: Decimal, error: float) -> str:
    """Return a number with the digits that its error leaves, at most `DIGITS`."""
    last = max(Decimal(error).adjusted(), value.adjusted() - DIGITS) + 1
    rounded = value.quantize(Decimal(1).scaleb(last))
    return f"{rounded if rounded else abs(rounded):f}"


def section(problem: Problem) -> str:
    """Return the part of the page about a problem."""
    lines = [f"## {problem.name}", "", f"{problem.source}.", "", f"At t = {problem.time}:", ""]
    lines += ["| figure | value | error | published | published less ours |", "|---|---|---|---|---|"]
    for one in computed(problem):
        published = problem.published.get(one.figure)
        apart = "" if published is None else f"{Decimal(published) - one.value:.1e}"
        lines.append(
            f"| `{one.figure}` | {shown(one.value, one.error)} | {one.error:.1e} | {published or ''} | {apart} |"
        )
    return "\n".join([*lines, *(["", problem.remark] if problem.remark else [])])


def main() -> None:
    """Write the page."""
    PAGE.write_text("\n".join([INTRODUCTION, *(section(problem) + "\n" for problem in PROBLEMS)]), encoding="utf-8")


if __name__ == "__main__":
    main()
