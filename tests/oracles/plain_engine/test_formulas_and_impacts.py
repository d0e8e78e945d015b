"""Closed forms of what the time drives, of relations, and of the laws of impact.

References
----------
.. [1] W. J. Stronge, "Impact Mechanics" (2000), chapters 3 and 5.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from core.multibody.audit.definition import Touch
from tests.oracles.plain_engine.mechanism import NotSupported
from tests.oracles.plain_engine.slip_in_impact import impulses
from tests.oracles.plain_engine.test_closed_forms import G, acceleration, moved, near, position, shown, spin, velocity

WHEEL = {"mass": 1, "inertia": 0.02, "at": [0, 0]}
AXLE = {"kind": "pin", "name": "axle", "a": "w", "b": [0, 0]}


def test_a_rod_whose_length_is_driven_along_a_rail() -> None:
    rod = {"kind": "rod", "name": "winch", "a": "p", "b": [0, 0], "drive": "1 + t^2/2"}
    rail = {"kind": "track", "place": "p", "on": {"at": [0, 0]}}
    motion = moved({"p": {"mass": 3, "at": [1, 0]}}, [rod, rail], [0.8])
    near(position(motion, 0.8, "p"), [1.32, 0])
    # It accelerates with 1 m/s^2, pushed by the rod.
    near([motion.forces[t]["winch.force"] for t in (0.0, 0.8)], [-3, -3], 1e-9)


@pytest.mark.parametrize("drive", [{"drive": "t^3"}, {"rate": "3*t^2"}])
def test_a_motor_whose_turn_or_rate_is_driven(drive: dict[str, str]) -> None:
    motor = {"kind": "motor", "name": "m", "a": "w", **drive}
    motion = moved({"w": WHEEL}, [AXLE, motor], [0.5])
    near([motion.states[0.5].turn[0], spin(motion, 0.5, "w")], [0.125, 0.75])
    near(motion.forces[0.5]["m.torque"], 0.02 * 3, 1e-9)


def test_a_pendulum_on_a_support_that_is_accelerated_from_rest() -> None:
    rod = {"kind": "rod", "name": "rod", "a": "p", "b": ["t^2", "0"]}
    motion = moved({"p": {"mass": 2, "at": [0.6, -0.8]}}, [rod], [0.1])
    # Along the rod (-0.6, 0.8) the point follows the acceleration (2, 0) of the support.
    near(motion.forces[0.0]["rod.force"], 2 * (0.8 * G - 0.6 * 2), 1e-9)


def test_a_pendulum_on_a_support_that_falls_freely() -> None:
    """The string of a falling lift has only the centripetal force."""
    rod = {"kind": "rod", "name": "rod", "a": "p", "b": ["0", f"-{G}*t^2/2"]}
    motion = moved({"p": {"mass": 2, "at": [1, 0], "velocity": [0, 3]}}, [rod], [0.4])
    near(position(motion, 0.4, "p"), [math.cos(1.2), math.sin(1.2) - G * 0.08])
    near(motion.forces[0.4]["rod.force"], 18, 1e-8)


def test_gears_as_a_relation() -> None:
    bodies = {"w": WHEEL, "v": {"mass": 2, "inertia": 0.05, "at": [1, 0]}}
    connections = [
        AXLE,
        {"kind": "pin", "a": "v", "b": [1, 0]},
        {"kind": "relation", "name": "mesh", "of": "2*w.angle + 5*v.angle"},
        {"kind": "torque", "body": "w", "torque": 0.1},
    ]
    motion = moved(bodies, connections, [0.5])
    rate = 0.1 / (0.02 + 0.05 * 0.16)
    near([spin(motion, 0.5, "w"), spin(motion, 0.5, "v")], [0.5 * rate, -0.2 * rate])
    # The force along 2 a + 5 b: 5 times it turns the second wheel.
    near(motion.forces[0.5]["mesh.force"], 0.05 * (-0.4 * rate) / 5, 1e-9)


def test_a_rack_that_falls_and_turns_its_wheel() -> None:
    bodies = {"w": WHEEL, "p": {"mass": 1, "at": [0.1, -0.5]}}
    guide = {"kind": "track", "place": "p", "on": {"at": [0.1, 0], "slope": {"degrees": 90}}}
    relation = {"kind": "relation", "of": "p.y + 1/2", "equals": "w.angle/10"}
    motion = moved(bodies, [AXLE, guide, relation], [0.3])
    near(acceleration(motion, "p"), [0, -G / (1 + 0.02 / 0.01)])


def test_a_bead_on_a_parabola_of_a_relation() -> None:
    """The energy gives its speed at the bottom."""
    relation = {"kind": "relation", "of": "p.y - p.x^2/2"}
    motion = moved({"p": {"mass": 2, "at": [1, 0.5]}}, [relation], [0.3])
    (x, y), v = position(motion, 0.3, "p"), velocity(motion, 0.3, "p")
    near([y, v @ v / 2], [x * x / 2, G * (0.5 - y)])
    # At rest it is accelerated along the tangent (1, 1).
    near(acceleration(motion, "p"), [-G / 2, -G / 2])


@pytest.mark.parametrize(
    "everywhere",
    [{"kind": "field", "acceleration": ["1", "0"]}, {"kind": "spinning-frame", "rate": 1, "about": "normal"}],
)
def test_what_acts_on_the_links_of_a_chain_is_refused_by_name(everywhere: dict[str, Any]) -> None:
    bodies = {"a": {"mass": 1, "at": [0, -0.5]}, "b": {"mass": 1, "at": [-0.8, -0.6]}}
    chain = {"kind": "chain", "through": ["a", [0, 0], "b"], "density": 1.2}
    with pytest.raises(NotSupported, match="links of a chain"):
        moved(bodies, [chain, everywhere], [0.1])


def row(**more: Any) -> Any:
    bodies = {
        f"b{k}": {"mass": 1, "radius": 0.1, "at": [0.2 * k if k else -1, 0], "velocity": [0 if k else 1, 0]}
        for k in range(3)
    }
    contacts = [
        {"kind": "contact", "name": f"c{k}", "a": f"b{k}", "b": f"b{k + 1}", "restitution": 1} for k in range(2)
    ]
    return moved(bodies, contacts, [1.5], [0, 0], **more)


@pytest.mark.parametrize(("simultaneous", "speeds"), [("in order", [0, 0, 1]), ("together", [-1 / 3, 2 / 3, 2 / 3])])
def test_three_balls_in_a_row(simultaneous: str, speeds: list[float]) -> None:
    motion = row(simultaneous=simultaneous)
    near([velocity(motion, 1.5, f"b{k}")[0] for k in range(3)], speeds)


def test_without_a_choice_three_balls_in_a_row_are_undecided() -> None:
    motion = row()
    assert motion.ended is not None
    assert motion.ended.kind == "simultaneous-impacts"
    assert shown(motion) == []


@pytest.mark.parametrize("law", ["poisson", "stronge"])
@pytest.mark.parametrize(("slip", "mu"), [(1.0, 0.3), (0.2, 0.6), (-0.2, 0.6), (0.0, 0.2), (0.3, 0.15)])
def test_an_impulse_in_small_parts(law: str, slip: float, mu: float) -> None:
    """The rates follow the impulse in 40,000 parts; the end of compression, and the law, are seen on the way."""
    response = np.array([[4.0, 1.5], [1.5, 2.0]])
    rates, touch = np.array([-1.0, slip]), Touch(mu, mu, 0.6, ("f",), law)
    found = impulses(response, rates, touch)
    assert found is not None
    part, now, total, work = 2e-5, rates.copy(), np.zeros(2), 0.0
    compression: tuple[float, float] | None = None
    while True:
        # What would stick does so by the friction that leaves no slip after a part.
        hold = -(now[1] + response[1, 0] * part) / (response[1, 1] * part)
        step = part * np.array([1.0, np.clip(hold, -mu, mu)])
        work, now, total = work + part * (now[0] + 0.5 * (response @ step)[0]), now + response @ step, total + step
        if compression is None and now[0] >= 0.0:
            compression = total[0], work
        if compression is None:
            continue
        push, taken = compression
        if (law == "poisson" and total[0] >= 1.6 * push) or (law == "stronge" and work >= (1 - 0.36) * taken):
            break
    np.testing.assert_allclose(found, total, atol=2e-4)
