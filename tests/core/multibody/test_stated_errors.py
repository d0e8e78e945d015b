"""Errors that stand beside the figures of a scene, against the true ones: closed forms in mpmath over random families.

The numbers of each family are decimals, so that the scene that is solved is the one of the closed form. A stated error
is at least the true one, and no wider than a few roundings of the figure.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from core.multibody.answer import SceneSolution
from core.multibody.solve import solve_scene
from core.multibody.trajectory.occurrences import ExtremesOf, When
from tests.core.multibody.worked_examples import points, read

DIGITS = 60
with mpmath.workdps(DIGITS):
    G = mpf("9.81")
GRAVITY = [0, -9.81]
ROUNDINGS = 8 * 2.0**-53


class Figure(NamedTuple):
    """A figure with its stated error and its true value; of a vector, all its components."""

    name: str
    value: Any
    error: float | None
    true: Any


@pytest.fixture(autouse=True)
def _in_many_digits() -> Iterator[None]:
    with mpmath.workdps(DIGITS):
        yield


def drawn(seed: int, count: int, low: float = 0.1, high: float = 9.0) -> list[mpf]:
    """Return decimals of four places."""
    return [mpf(f"{x:.4f}") for x in np.random.default_rng(seed).uniform(low, high, count)]


def check(figures: Sequence[Figure], scale: Any = 0) -> None:
    """Hold that every stated error is true, and as small as the rounding of the figure or of its terms, `scale`."""
    assert figures
    for name, value, error, true in figures:
        assert error is not None, name
        values, trues = (x if isinstance(x, (tuple, list)) else [x] for x in (value, true))
        wrong = mpmath.norm([mpf(x) - y for x, y in zip(values, trues, strict=True)])
        assert wrong <= error, f"{name}: wrong by {mpmath.nstr(wrong, 3)}, stated {error:.3g}"
        assert error <= ROUNDINGS * max(mpmath.norm(trues), scale) + 1e-30, f"{name}: {error:.3g} is too wide"


def linear(solution: SceneSolution, body: str, true: Sequence[Any]) -> Figure:
    """Return the acceleration of a centre of mass."""
    assert solution.accelerations is not None
    one = solution.accelerations[body]
    assert one.errors is not None
    return Figure(f"{body}.linear", one.linear, one.errors.linear, list(true))


def angular(solution: SceneSolution, body: str, true: Any) -> Figure:
    """Return the angular acceleration of a body."""
    assert solution.accelerations is not None
    one = solution.accelerations[body]
    assert one.errors is not None
    return Figure(f"{body}.angular", one.angular, one.errors.angular, true)


def force(solution: SceneSolution, name: str, true: Any) -> Figure:
    """Return a force at the start."""
    assert solution.forces is not None
    one = solution.forces[name]
    return Figure(name, one.value, one.error, true)


def energies(solution: SceneSolution, kinetic: Any, potential: Any) -> list[Figure]:
    """Return the energies at the start."""
    assert solution.energy is not None
    one, errors = solution.energy, solution.energy.errors
    assert errors is not None
    return [
        Figure("kinetic", one.kinetic, errors.kinetic, kinetic),
        Figure("potential", one.potential, errors.potential, potential),
        Figure("total", one.total, errors.total, kinetic + potential),
    ]


def period(solution: SceneSolution, true: Any) -> list[Figure]:
    """Return the period of a motion, and that of its only part."""
    (part,) = solution.model.apart
    assert part.errors is not None
    return [
        Figure("period", solution.period, solution.period_error, true),
        Figure("part", part.period, part.errors.period, true),
    ]


def pendulum(mass: Any, x: Any, y: Any, rate: Any) -> dict[str, Any]:
    """Return a bob at [x, -y] below the origin that turns about it at a rate."""
    bob = {"mass": float(mass), "at": [float(x), -float(y)], "velocity": [f"{rate}*{y}", f"{rate}*{x}"]}
    return {"gravity": GRAVITY, "bodies": {"bob": bob}, "connections": [{"kind": "rod", "a": "bob", "b": [0, 0]}]}


@pytest.mark.parametrize("seed", range(6))
def test_pendulum_at_the_start(seed: int) -> None:
    mass, x, y, rate = drawn(seed, 4)
    found = solve_scene(read(pendulum(mass, x, y, rate)))
    length = mpmath.hypot(x, y)
    inward, along = rate**2 * length, -G * x / length
    acceleration = [(-inward * x + along * y) / length, (inward * y + along * x) / length]
    # A rod that pulls is positive.
    figures = [
        linear(found, "bob", acceleration),
        force(found, "rod-1.force", mass * (inward + G * y / length)),
        *energies(found, mass * (rate * length) ** 2 / 2, -mass * G * y),
    ]
    check(figures, mass * G * y)


@pytest.mark.parametrize("seed", range(4))
def test_massive_pulley_at_the_start(seed: int) -> None:
    one, two, radius, inertia = drawn(seed, 4)
    bodies = {
        "a": {"mass": float(one), "at": [-float(radius), -20]},
        "b": {"mass": float(two), "at": [float(radius), -20]},
        "wheel": {"mass": 1, "inertia": float(inertia), "at": [0, 0], "radius": float(radius)},
    }
    connections = [
        {"kind": "pin", "a": "wheel", "b": [0, 0]},
        {"kind": "string", "name": "s", "through": ["a", "wheel", "b"], "sides": {"wheel": ["left", "right"]}},
    ]
    found = solve_scene(read({"gravity": GRAVITY, "bodies": bodies, "connections": connections}))
    a = (two - one) * G / (one + two + inertia / radius**2)
    check([linear(found, "a", [0, a]), linear(found, "b", [0, -a])], G)


@pytest.mark.parametrize("seed", range(6))
def test_period_of_a_pendulum_from_rest(seed: int) -> None:
    mass, x = drawn(seed, 2)
    (y,) = drawn(seed + 100, 1, -9.0, 9.0)
    found = solve_scene(read(pendulum(mass, x, y, 0)), [1.0])
    length = mpmath.hypot(x, y)
    # m = sin^2(amplitude/2)
    check(period(found, 4 * mpmath.ellipk((1 - y / length) / 2) * mpmath.sqrt(length / G)))


@pytest.mark.parametrize("seed", range(4))
def test_period_of_a_pendulum_that_turns_over(seed: int) -> None:
    mass, x, y, more = drawn(seed, 4)
    length = mpmath.hypot(x, y)
    # Faster by `more` than what just reaches the top.
    rate = mpf(f"{float(mpmath.sqrt(2 * G * (length + y)) / length + more):.4f}")
    found = solve_scene(read(pendulum(mass, x, y, rate)), [1.0])
    k = 4 * G * length / ((rate * length) ** 2 + 2 * G * (length - y))
    check(period(found, 2 * mpmath.ellipk(k) * mpmath.sqrt(k * length / G)))


@pytest.mark.parametrize("seed", range(4))
def test_period_of_an_orbit(seed: int) -> None:
    mass, x, strength = drawn(seed, 3)
    (share,) = drawn(seed + 50, 1, 0.3, 1.3)
    speed = mpf(f"{float(share * mpmath.sqrt(strength / (mass * x))):.6f}")
    scene = {
        "gravity": [0, 0],
        "bodies": {"m": {"mass": float(mass), "at": [float(x), 0], "velocity": [0, float(speed)]}},
        "connections": [{"kind": "inverse-square", "a": [0, 0], "b": "m", "strength": float(strength)}],
    }
    found = solve_scene(read(scene), [1.0])
    mu = strength / mass
    axis = 1 / (2 / x - speed**2 / mu)
    check(period(found, 2 * mpmath.pi * mpmath.sqrt(axis**3 / mu)))


@pytest.mark.parametrize("seed", range(4))
def test_modes_of_two_masses_on_springs(seed: int) -> None:
    one, two, stiff, between = drawn(seed, 4)
    bodies = {"a": {"mass": float(one), "at": [0, 0]}, "b": {"mass": float(two), "at": [1, 0]}}
    connections: list[dict[str, Any]] = [
        {"kind": "track", "place": "a", "on": {"at": [0, 0]}},
        {"kind": "track", "place": "b", "on": {"at": [0, 0]}},
        {"kind": "spring", "a": [-1, 0], "b": "a", "stiffness": float(stiff), "rest_length": 0.5},
        {"kind": "spring", "a": "a", "b": "b", "stiffness": float(between), "rest_length": 0.5},
    ]
    found = solve_scene(read({"gravity": GRAVITY, "bodies": bodies, "connections": connections}))
    half = ((stiff + between) / one + between / two) / 2
    root = mpmath.sqrt(half**2 - stiff * between / (one * two))
    (part,) = found.model.apart
    for mode, square in zip(part.modes, (half - root, half + root), strict=True):
        assert mode.errors is not None
        check(
            [
                Figure("frequency", mode.frequency, mode.errors.frequency, mpmath.sqrt(square)),
                Figure("growth", mode.growth_rate, mode.errors.growth_rate, mpf(0)),
            ]
        )


@pytest.mark.parametrize("seed", range(4))
def test_mode_with_damping(seed: int) -> None:
    mass, stiff = drawn(seed, 2)
    (damping,) = drawn(seed + 20, 1, 0.01, 0.5)
    connections: list[dict[str, Any]] = [
        {"kind": "track", "place": "a", "on": {"at": [0, 0]}},
        {"kind": "spring", "a": [-1, 0], "b": "a", "stiffness": float(stiff), "rest_length": 0.5},
        {"kind": "damper", "a": [-1, 0], "b": "a", "coefficient": float(damping)},
    ]
    body = {"a": {"mass": float(mass), "at": [0, 0]}}
    found = solve_scene(read({"gravity": GRAVITY, "bodies": body, "connections": connections}))
    ((mode,),) = [part.modes for part in found.model.apart]
    assert mode.errors is not None
    growth = -damping / (2 * mass)
    check(
        [
            Figure("frequency", mode.frequency, mode.errors.frequency, mpmath.sqrt(stiff / mass - growth**2)),
            Figure("growth", mode.growth_rate, mode.errors.growth_rate, growth),
        ]
    )


@pytest.mark.parametrize("seed", range(4))
def test_precession_of_a_conical_pendulum(seed: int) -> None:
    mass, x, down = drawn(seed, 3)
    rate = f"sqrt(9.81/{down})"
    bob = {"mass": float(mass), "at": [float(x), 0, -float(down)], "velocity": [0, f"{x}*{rate}", 0]}
    scene = {
        "gravity": [0, 0, -9.81],
        "bodies": {"bob": bob},
        "connections": [{"kind": "rod", "a": "bob", "b": [0, 0, 0]}],
    }
    found = solve_scene(read(scene), [1.0])
    (part,) = found.model.apart
    assert part.errors is not None
    assert part.name == "steady precession"
    check(
        [
            *period(found, 2 * mpmath.pi * mpmath.sqrt(down / G)),
            Figure("precession", part.precession, part.errors.precession, 2 * mpmath.pi),
        ]
    )


@pytest.mark.parametrize("seed", range(3))
def test_precession_of_a_spherical_pendulum(seed: int) -> None:
    """The height is elliptic, and the azimuth an integral over it (Landau and Lifshitz, section 14, problem 1)."""
    mass, x, down = drawn(seed, 3, 1.0, 5.0)
    length = mpmath.hypot(x, down)
    speed = mpf(f"{float(mpmath.sqrt(G / down) * x * mpf('0.8')):.4f}")
    bob = {"mass": float(mass), "at": [float(x), 0, -float(down)], "velocity": [0, float(speed), 0]}
    scene = {
        "gravity": [0, 0, -9.81],
        "bodies": {"bob": bob},
        "connections": [{"kind": "rod", "a": "bob", "b": [0, 0, 0]}],
    }
    found = solve_scene(read(scene), [1.0])
    momentum, energy = x * speed, speed**2 / 2 - G * down
    # (l z')^2 = 2 (E - g z)(l^2 - z^2) - M^2, a cubic with the start as one of its zeros.
    half, rest = (energy / G + down) / 2, energy * down / G - length**2 + down**2
    root = mpmath.sqrt(half**2 - rest)
    low, high, beyond = sorted([-down, half - root, half + root])
    m = (high - low) / (beyond - low)
    once = 4 * mpmath.ellipk(m) * length / mpmath.sqrt(2 * G * (beyond - low))

    def rate(u: Any) -> Any:
        z = low + (high - low) * mpmath.sin(u) ** 2
        slow = mpmath.sqrt(1 - m * mpmath.sin(u) ** 2)
        return 2 * length * momentum / ((length**2 - z**2) * mpmath.sqrt(2 * G * (beyond - low)) * slow)

    turned = 2 * mpmath.quad(rate, mpmath.linspace(0, mpmath.pi / 2, 5))
    (part,) = found.model.apart
    assert part.errors is not None
    check([*period(found, once), Figure("precession", part.precession, part.errors.precession, turned)])


@pytest.mark.parametrize("seed", range(4))
def test_impulse_of_a_ball_that_is_dropped(seed: int) -> None:
    mass, height = drawn(seed, 2)
    (bounce,) = drawn(seed + 30, 1, 0.1, 0.9)
    scene = {
        "gravity": GRAVITY,
        "bodies": {"ball": {"mass": float(mass), "at": [0, float(height)]}},
        "connections": [{"kind": "contact", "place": "ball", "on": {"at": [0, 0]}, "restitution": float(bounce)}],
    }
    fall = mpmath.sqrt(2 * height / G)
    found = solve_scene(read(scene), [float(1.5 * fall)])
    assert found.phases is not None
    event, (first, second) = found.events[0], found.phases[:2]
    speed = G * fall
    check(
        [
            Figure("time", event.time, event.error, fall),
            Figure("normal", event.impulses["normal"], event.errors.impulses["normal"], mass * speed * (1 + bounce)),
            Figure("loss", event.energy_loss, event.errors.energy_loss, mass * speed**2 / 2 * (1 - bounce**2)),
            Figure("end", first.end, first.errors["end"], fall),
            Figure("start", second.start, second.errors["start"], fall),
        ]
    )


@pytest.mark.parametrize("seed", range(3))
def test_impulse_of_a_pendulum_that_meets_a_wall(seed: int) -> None:
    """The state is followed by a series: the error is measured, and that of the impulse follows from it."""
    mass, x, y = drawn(seed, 3)
    (bounce,) = drawn(seed + 40, 1, 0.1, 0.9)
    scene = pendulum(mass, x, y, 0)
    wall = {"kind": "contact", "name": "wall", "place": "bob", "on": {"at": [0, 0], "slope": {"degrees": -90}}}
    scene["connections"].append({**wall, "restitution": float(bounce)})
    length = mpmath.hypot(x, y)
    amplitude = mpmath.atan2(x, y)
    quarter = mpmath.ellipk(mpmath.sin(amplitude / 2) ** 2) * mpmath.sqrt(length / G)
    found = solve_scene(read(scene), [float(1.2 * quarter)])
    event = found.events[0]
    speed = mpmath.sqrt(2 * G * (length - y))
    check(
        [
            Figure("time", event.time, event.error, quarter),
            Figure("normal", event.impulses["normal"], event.errors.impulses["normal"], mass * speed * (1 + bounce)),
            Figure("loss", event.energy_loss, event.errors.energy_loss, mass * speed**2 / 2 * (1 - bounce**2)),
        ]
    )


@pytest.mark.parametrize("halves", [1, 2, 7, 1000])
def test_rates_where_a_motion_turns_back(halves: int) -> None:
    """The speed is zero there but for the rounding of the time: its error is a share of the speeds of the motion."""
    found = solve_scene(read(pendulum(mpf(1), mpf("0.6"), mpf("0.8"), 0)), [1.0])
    assert found.period is not None
    time = halves * found.period / 2
    solution = solve_scene(read(pendulum(mpf(1), mpf("0.6"), mpf("0.8"), 0)), [time], accuracy=1e-14)
    assert solution.trajectory is not None
    column = solution.trajectory.columns["bob.velocity"]
    # Beside a turning point the speed is g sin(amplitude) times the time since then.
    exact = 4 * mpmath.ellipk(mpf("0.1")) / mpmath.sqrt(G)
    late = mpf(time) - halves * exact / 2
    speed = mpmath.norm([mpf(x) for x in column.values[0].tolist()])
    assert abs(speed - abs(late) * G * mpf("0.6")) <= column.error + abs(late) ** 3 * 1000
    assert column.scale == pytest.approx(float(mpmath.sqrt(2 * G * mpf("0.2"))), rel=0.1)


@pytest.mark.parametrize("seed", range(4))
def test_times_of_the_extremes_of_an_oscillation(seed: int) -> None:
    mass, stiff, away = drawn(seed, 3)
    scene = {
        "gravity": [0, 0],
        "bodies": {"a": {"mass": float(mass), "at": [float(away), 0], "velocity": [1, 0]}},
        "connections": [
            {"kind": "track", "place": "a", "on": {"at": [0, 0]}},
            {"kind": "spring", "a": [0, 0], "b": "a", "stiffness": float(stiff), "rest_length": 0},
        ],
    }
    rate = mpmath.sqrt(stiff / mass)
    solution = solve_scene(read(scene), [float(0.9 * 2 * mpmath.pi / rate)], [ExtremesOf("a.position.x")])
    assert solution.extremes is not None
    (one,) = solution.extremes
    # x = A cos(w t - phase)
    phase, size = mpmath.atan2(1 / rate, away), mpmath.hypot(away, 1 / rate)
    for name, value, time in (("largest", size, phase / rate), ("least", -size, (phase + mpmath.pi) / rate)):
        assert abs(mpf(getattr(one, name)) - value) <= one.error <= 1e-14 * float(size)
        wrong = abs(mpf(getattr(one, f"{name}_time")) - time)
        assert wrong <= one.errors[f"{name}_time"] <= 1e-5 * float(time)


def test_times_of_extremes_at_the_ends_and_of_what_is_constant() -> None:
    thrown = {"gravity": GRAVITY, "bodies": {"a": {"mass": 1, "at": [0, 0], "velocity": [2, 3]}}}
    searches = [ExtremesOf(f"a.position.{axis}") for axis in "xy"] + [ExtremesOf("a.velocity.x")]
    solution = solve_scene(read(thrown), [1.0], searches)
    assert solution.extremes is not None
    along, up, steady = solution.extremes
    assert (along.least_time, along.largest_time) == (0.0, 1.0)
    assert max(along.errors.values()) < 1e-14
    assert abs(mpf(up.largest_time) - 3 / G) <= up.errors["largest_time"] < 1e-6
    assert (up.least_time, up.errors["least_time"] < 1e-14) == (1.0, True)
    # Of a constant no time is told from another.
    assert steady.errors["least_time"] >= 1.0


def test_searched_values_honour_the_accuracy_without_a_trajectory() -> None:
    """A double pendulum amplifies rounding of doubles beyond 1e-12: alone or not, it is searched in pairs."""
    scene = read(points((1, 1), ("1", "1"), (1, 1)) | {"bodies": SWINGING})
    search = When("p1.position.x", 0.0)
    alone = solve_scene(scene, [12.0], [search], 1e-12)
    beside = solve_scene(scene, [12.0], [search, "trajectory"], 1e-12)
    assert alone.occurrences is not None
    assert beside.occurrences is not None
    assert len(alone.occurrences) == len(beside.occurrences) > 4
    for one, other in zip(alone.occurrences, beside.occurrences, strict=True):
        assert abs(one.time - other.time) <= one.error + other.error
        assert one.error < 1e-11


SWINGING = {
    "p0": {"mass": 1, "at": ["sin(2)", "-cos(2)"]},
    "p1": {"mass": 1, "at": ["sin(2) + sin(2.5)", "-cos(2) - cos(2.5)"]},
}


@pytest.mark.parametrize(("square", "repeats"), [("1.9", True), ("2.1", False), ("4.9", False), ("5.1", True)])
def test_a_swing_on_a_string_has_a_period_only_where_the_string_stays_taut(square: str, repeats: bool) -> None:
    """From the bottom with v^2 between 2 g l and 5 g l the string becomes slack, whether or not times are requested."""
    scene = {
        "gravity": GRAVITY,
        "bodies": {"bob": {"mass": 1, "at": [0, -1], "velocity": [f"sqrt({square}*9.81)", 0]}},
        "connections": [{"kind": "string", "through": ["bob", [0, 0]]}],
    }
    found = solve_scene(read(scene))
    assert (found.period is not None) is repeats
    assert [part.period is not None for part in found.model.apart] == [repeats]
