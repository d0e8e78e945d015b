"""The page of references: its figures are those of today, and two published ones are refuted by other formulations."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from decimal import Decimal
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from benchmarks.references.__main__ import PAGE, Reference, computed, shown
from benchmarks.references.problems import (
    BRICARD,
    BRICARD_AXES,
    BRICARD_PLACES,
    CAR_AXIS,
    CHRONO_BALL_JOINT,
    CHRONO_PENDULUM,
    HEAVY_TOP,
    MODELICA_PENDULUM,
    PROBLEMS,
    SQUEEZER,
    SQUEEZER_ANGLES,
    SQUEEZER_LENGTHS,
    Problem,
)


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
    adams = ((CHRONO_PENDULUM, 2e-6), (CHRONO_BALL_JOINT, 2e-6))
    for problem, digits in ((PROBLEMS[0], 2e-15), (PROBLEMS[1], 1e-21), (CAR_AXIS, 6e-12), (SQUEEZER, 2e-9), *adams):
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


def by_doubles(rates: Callable[[float, Any], Any], start: Any, end: float) -> Any:
    return solve_ivp(rates, (0.0, end), start, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]


def confirmed(problem: Problem, expected: dict[str, float], within: float) -> None:
    for name, value in expected.items():
        assert float(figures(problem.name)[name].value) == pytest.approx(value, abs=within), name


def test_the_heavy_top_by_euler_s_equations() -> None:
    """In body axes about the tip: J w' = J w x w + r x R^T (0, 0, -m g), with the rotation as a matrix."""
    inertia, arm = np.array([15.234375, 15.234375, 0.46875]), np.array([0, 0, -1.0])

    def rates(_: float, y: Any) -> Any:
        omega, turn = y[:3], y[3:].reshape(3, 3)
        torque = np.cross(arm, turn.T @ [0, 0, -15 * 9.81])
        across = np.array([[0, -omega[2], omega[1]], [omega[2], 0, -omega[0]], [-omega[1], omega[0], 0]])
        return np.concatenate([(np.cross(inertia * omega, omega) + torque) / inertia, (turn @ across).ravel()])

    y = by_doubles(rates, [-4.61538, 0, 150, 1, 0, 0, 0, 0, -1, 0, 1, 0], 2.0)
    confirmed(HEAVY_TOP, dict(zip(HEAVY_TOP.figures, y[3:].reshape(3, 3) @ arm, strict=True)), 1e-9)


def test_pendulums_in_their_angles() -> None:
    """Lagrange's equations of two angles; and theta'' = m g' l cos theta/(I + m l^2) from the horizontal."""
    m, length = 7700 * 0.5 * 0.06**2, 0.5
    inertia = m * (length**2 + 0.06**2) / 12

    def rates(_: float, y: Any) -> Any:
        one, two, u, v = y
        mass = np.array([[inertia + 1.25 * m * length**2, 0.5 * m * length**2 * np.cos(one - two)], [0, 0]])
        mass[1] = [mass[0, 1], inertia + 0.25 * m * length**2]
        pull = 0.5 * m * length**2 * np.sin(one - two)
        right = [-pull * v * v - 1.5 * m * 9.81 * length * np.cos(one) - 0.1 * u]
        right.append(pull * u * u - 0.5 * m * 9.81 * length * np.cos(two))
        return [u, v, *np.linalg.solve(mass, right)]

    one, two, *_ = by_doubles(rates, [0, 0, 0, 0], 3.0)
    middle = {"box1.x": np.cos(one) / 4, "box1.y": np.sin(one) / 4}
    last = {"box2.x": np.cos(one) / 2 + np.cos(two) / 4, "box2.y": np.sin(one) / 2 + np.sin(two) / 4}
    confirmed(MODELICA_PENDULUM, middle | last, 1e-10)
    for problem, share in ((CHRONO_PENDULUM, np.sqrt(0.5)), (CHRONO_BALL_JOINT, 1.0)):
        fall = 2 * 9.80665 * share / 4.1
        angle, _ = by_doubles(lambda _, y, fall=fall: [y[1], fall * np.cos(y[0])], [0, 0], 2.5)
        down = 2 * np.sin(angle) * share
        confirmed(problem, {"pendulum.x": 1 + 2 * np.cos(angle), "pendulum.z": 3 - down}, 1e-10)


RODS = ("ab", "bc", "cd", "de", "ef")


def turned(axis: Any, angle: float) -> Any:
    x, y, z = axis
    across = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * across + (1 - np.cos(angle)) * across @ across


def chain(angles: Any) -> tuple[list[Any], list[Any], Any]:
    """Return the rotations of Bricard's rods, the places of their joints and the axis of the last hinge."""
    at, axes = ({name: np.array(v, float) for name, v in given.items()} for given in (BRICARD_PLACES, BRICARD_AXES))
    turns, joints, turn = [], [at["A"]], np.eye(3)
    for k in range(5):
        turn = turn @ turned(axes["ABCDE"[k]], angles[k])
        turns.append(turn)
        joints.append(joints[-1] + turn @ (at["BCDEF"[k]] - at["ABCDE"[k]]))
    return turns, joints, turn @ axes["F"]


def closed(first: float, guess: Any) -> Any:
    """Return the angles of the other hinges, by least squares of six equations: two of them follow from the others."""

    def miss(others: Any) -> Any:
        _, joints, axis = chain([first, *others])
        return np.concatenate([joints[5] - BRICARD_PLACES["F"], axis - BRICARD_AXES["F"]])

    others = np.array(guess, float)
    for _ in range(12):
        slopes = np.array([(miss(others + s) - miss(others - s)) / 2e-6 for s in 1e-6 * np.eye(4)]).T
        others = others - np.linalg.lstsq(slopes, miss(others), rcond=1e-6)[0]
    assert np.abs(miss(others)).max() < 1e-11
    return others


def energies(first: float, others: Any) -> tuple[float, float]:
    """Return twice the kinetic energy at a rate of one of the first hinge, and the potential energy."""
    h, total = 1e-3, 0.0
    (r0, a0, _), (r1, a1, _) = (chain([first + step, *closed(first + step, others)]) for step in (-h, h))
    _, at, _ = chain([first, *others])
    for k, rod in enumerate(RODS):
        velocity = (a1[k] + a1[k + 1] - a0[k] - a0[k + 1]) / (4 * h)
        spin = (r0[k].T @ r1[k] - r1[k].T @ r0[k]) / 2
        # The rotation between two places is exp of its axis by its angle, whose sine this is.
        sine = np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
        size = float(np.linalg.norm(sine))
        omega = sine / size * np.arcsin(size) / (2 * h) if size else sine
        moments = [0.02 / 12 if "0.02" in text else 1.01 / 12 for text in BRICARD.scene["bodies"][rod]["moments"]]
        total += velocity @ velocity + omega @ (moments * omega)
    return total, sum(9.81 * (at[k][1] + at[k + 1][1]) / 2 for k in range(5))


def test_bricard_s_mechanism_by_its_energy() -> None:
    """All angles follow from that of the first hinge, and the time is the integral of its rate by the energy."""
    ours = {name: float(one.value) for name, one in figures(BRICARD.name).items()}
    last = math.atan2(-ours["ab.z"], ours["ab.x"])
    nodes, weights = np.polynomial.legendre.leggauss(24)
    rest, others, time = energies(0.0, closed(0.0, np.zeros(4)))[1], np.zeros(4), 0.0
    # From rest the angle grows as the square of the time: its root is the variable.
    for s, weight in zip((nodes + 1) / 2, weights / 2, strict=True):
        first = last * s * s
        others = closed(first, others)
        doubled, potential = energies(first, others)
        time += weight * 2 * abs(last) * s * math.sqrt(doubled / (2 * (rest - potential)))
    assert time == pytest.approx(1.0, abs=1e-5)
    _, joints, _ = chain([last, *closed(last, others)])
    for k in (1, 2):
        middle = (joints[k] + joints[k + 1]) / 2
        expected = [ours[f"{RODS[k]}.{axis}"] for axis in "xyz"]
        assert middle == pytest.approx(expected, abs=1e-9)
