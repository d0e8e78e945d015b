"""The page of references: its figures are those of today, and two published ones are refuted by other formulations."""

from __future__ import annotations

import re
from collections.abc import Callable
from decimal import Decimal
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from benchmarks.references.__main__ import PAGE, Reference, computed, shown
from benchmarks.references.problems import CAR_AXIS, PROBLEMS, SQUEEZER, SQUEEZER_ANGLES, SQUEEZER_LENGTHS, Problem


@cache
def figures(name: str) -> dict[str, Reference]:
    problem = next(problem for problem in PROBLEMS if problem.name == name)
    return {one.figure: one for one in computed(problem)}


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda problem: problem.name.split()[0])
def test_the_page_has_the_figures_of_today(problem: Problem) -> None:
    part = PAGE.read_text(encoding="utf-8").split(f"## {problem.name}\n")[1].split("\n## ")[0]
    rows = dict(re.findall(r"^\| `(.+?)` \| (\S+) \|", part, re.MULTILINE))
    assert list(rows) == list(problem.figures)
    for name, one in figures(problem.name).items():
        assert one.error < 2e-21
        places = -Decimal(rows[name]).as_tuple().exponent  # type: ignore[operator]
        assert abs(Decimal(rows[name]) - one.value) <= Decimal(one.error) + Decimal(10) ** -places
        assert len(shown(one.value, one.error).lstrip("-0.")) >= 18 or one.value.adjusted() < -10


def test_published_figures_agree_to_the_digits_that_the_page_says() -> None:
    for problem, digits in ((PROBLEMS[0], 2e-15), (PROBLEMS[1], 1e-21), (CAR_AXIS, 6e-12), (SQUEEZER, 2e-9)):
        for name, published in problem.published.items():
            assert abs(Decimal(published) - figures(problem.name)[name].value) < Decimal(digits)


def test_the_squeezing_mechanism_in_its_seven_angles() -> None:
    """Every centre and joint is a sum of fixed arms that turn with sums of the angles: places as complex numbers."""
    x = {key: float(value) for key, value in {**SQUEEZER_LENGTHS, **SQUEEZER_ANGLES}.items()}
    b = complex(x["xb"], x["yb"])
    # beta, theta, gamma, phi, delta, omega, epsilon.
    turns = {"b": [0], "bt": [0, 1], "g": [2], "pd": [3, 4], "d": [4], "oe": [5, 6], "e": [6]}
    which = np.array([[float(i in turn) for i in range(7)] for turn in turns.values()])
    number = {name: i for i, name in enumerate(turns)}

    def arms(**given: complex) -> Any:
        found = np.zeros(7, dtype=complex)
        for name, arm in given.items():
            found[number[name]] = arm
        return found

    centres = [
        *(arms(b=x["ra"]), arms(b=x["rr"], bt=-x["da"]), arms(g=complex(x["sb"], -x["sa"]))),
        *(arms(d=x["zt"], pd=-1j * (x["e"] - x["ea"])), arms(d=complex(x["ta"], x["tb"]))),
        *(arms(e=-1j * x["u"], oe=x["zf"] - x["fa"]), arms(e=complex(-x["ub"], -x["ua"]))),
    ]
    end = arms(b=x["rr"], bt=-x["d"])
    loops = [
        end - arms(g=-1j * x["ss"]),
        end - arms(pd=-1j * x["e"], d=x["zt"]),
        end - arms(oe=x["zf"], e=-1j * x["u"]),
    ]
    hook = arms(g=complex(x["sd"], -x["sc"]))
    links = [SQUEEZER.scene["bodies"][f"k{i + 1}"] for i in range(7)]
    masses, inertias = (np.array([float(link[key]) for link in links]) for key in ("mass", "inertia"))

    def rates(_: float, y: Any) -> Any:
        turned, spin = np.exp(1j * which @ y[:7]), which @ y[7:]

        def slopes(arm: Any) -> tuple[Any, Any]:
            """Return the derivatives of a place by the angles, and its acceleration without theirs."""
            return 1j * (arm * turned) @ which, -(arm * turned) @ spin**2

        mass, force = (which.T * inertias) @ which, np.zeros(7)
        for m, arm in zip(masses, centres, strict=True):
            slope, bent = slopes(arm)
            mass = mass + m * (np.outer(slope.conj(), slope)).real
            force -= m * (slope.conj() * bent).real
        slope, _ = slopes(hook)
        d = b + hook @ turned - complex(x["xc"], x["yc"])
        force -= (slope.conj() * d).real * 4530 * (1 - float("0.07785") / abs(d))
        force[0] += 0.033
        held = [part(z) for arm in loops for z in [slopes(arm)[0]] for part in (np.real, np.imag)]
        pull = [-part(slopes(arm)[1]) for arm in loops for part in (np.real, np.imag)]
        saddle = np.block([[mass, np.array(held).T], [np.array(held), np.zeros((6, 6))]])
        return np.concatenate([y[7:], np.linalg.solve(saddle, [*force, *pull])[:7]])

    start = [x["beta"], 0, x["gamma"], x["phi"], x["delta"], x["omega"], x["epsilon"], *[0.0] * 7]
    y = solve_ivp(rates, (0, 0.03), start, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
    ours = figures(SQUEEZER.name)
    for name, i in (("k1.angle", 0), ("k3.angle", 2), ("k5.angle", 4), ("k7.angle", 6)):
        assert float(ours[name].value) == pytest.approx(y[i], abs=5e-11)
    assert abs(y[0] - float(SQUEEZER.published["k1.angle"])) > 5e-10


def extrapolated(rates: Callable[[Any, Any], Any], y: Any, end: Any, steps: int) -> Any:
    """Return the solution of an initial value problem in extended precision, by extrapolated midpoint rules.

    References
    ----------
    E. Hairer, S. P. Nørsett and G. Wanner, "Solving Ordinary Differential Equations I", section II.9.
    """
    t, h = np.longdouble(0), end / steps
    for _ in range(steps):
        rows: list[Any] = []
        for k in range(1, 9):
            n, last, now = 2 * k, y, y + h / (2 * k) * rates(t, y)
            for i in range(1, n):
                last, now = now, last + 2 * h / n * rates(t + i * h / n, now)
            row = [(last + now + h / n * rates(t + h, now)) / 2]
            for j, above in enumerate(rows[-1] if rows else []):
                ratio = (np.longdouble(n) / (2 * (k - j - 1))) ** 2
                row.append(row[j] + (row[j] - above) / (ratio - 1))
            rows.append(row)
        y, t = rows[-1][-1], t + h
    return y


def test_the_car_axis_in_extended_precision() -> None:
    """Two masses of 5e-4 with the multipliers of rod and joint from the second derivatives of both."""
    one, m = np.longdouble(1), np.longdouble("5e-4")

    def rates(t: Any, y: Any) -> Any:
        p, v = y[:4], y[4:]
        s, c = np.sin(10 * t), np.cos(10 * t)
        wheel = np.array([np.sqrt(one - s * s / 100), s / 10])
        # By the chain rule of x^2 + y^2 = 1.
        wy, ay = c, -10 * s
        wx = -wheel[1] * wy / wheel[0]
        ax = -(wx * wx + wy * wy + wheel[1] * ay) / wheel[0]
        moved, bent = np.array([wx, wy]), np.array([ax, ay])
        d = p[:2] - p[2:]
        lines = np.array([[*wheel, 0, 0], [*d, *-d]])
        right = np.array([-(bent @ p[:2]) - 2 * (moved @ v[:2]), -((v[:2] - v[2:]) @ (v[:2] - v[2:]))])
        left, over = np.sqrt(p[:2] @ p[:2]), p[2:] - wheel
        far = np.sqrt(over @ over)
        half = np.longdouble("0.5")
        pull = np.concatenate([(half - left) / left * p[:2], (half - far) / far * over]) / m
        pull = pull - np.array([0, one, 0, one])
        (a, b), (_, e) = lines @ lines.T
        f, g = right - lines @ pull
        det = a * e - b * b
        return np.concatenate([v, pull + lines.T @ np.array([(e * f - b * g) / det, (a * g - b * f) / det])])

    half = np.longdouble("0.5")
    start = np.array([0, half, 1, half, -half, 0, -half, 0], dtype=np.longdouble)
    y = extrapolated(rates, start, np.longdouble(3), 250)
    ours = figures(CAR_AXIS.name)
    for found, (name, published) in zip(y, CAR_AXIS.published.items(), strict=True):
        assert abs(found - np.longdouble(str(ours[name].value))) < 1e-15
        assert abs(found - np.longdouble(published)) > 3e-15
