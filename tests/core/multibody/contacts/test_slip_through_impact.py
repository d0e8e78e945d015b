"""Impulses by the laws of Poisson and Stronge, against small steps of the impulse and closed forms."""

from __future__ import annotations

import math
from typing import Any

import pytest

from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import read

STEP = 2e-5
"""Part of the impulse of a step (N s)."""


def rod(angle: float, along: float, **more: Any) -> dict[str, Any]:
    """Return a homogeneous rod of 1 m and 1 kg that falls on its lower end at 1 m/s, leaning by an angle."""
    at = [f"0.5*sin({angle})", f"0.5*cos({angle}) + 0.1"]
    body = {"mass": 1, "inertia": "1/12", "at": at, "angle": f"pi/2 - {angle}", "velocity": [along, -1]}
    end = {"places": {"end": [-0.5, 0]}}
    contact = {"kind": "contact", "name": "floor", "place": "rod.end", "on": {"at": [0, 0]}}
    return {"bodies": {"rod": {**body, **end}}, "connections": [{**contact, **more}]}


def by_steps(angle: float, along: float, law: str, e: float, mu: float) -> tuple[float, float]:
    """Return the impulses along and across the floor: Coulomb's friction on the slip that there is at every step."""
    x, y, inertia = -0.5 * math.sin(angle), -0.5 * math.cos(angle), 1 / 12
    nn, tt, nt = 1 + x * x / inertia, 1 + y * y / inertia, -x * y / inertia
    closing, slip, push, rub, work = -1.0, along, 0.0, 0.0, 0.0
    compressed: tuple[float, float] | None = None
    while True:
        holds = -nt / tt
        ratio = holds if abs(holds) <= mu else math.copysign(mu, holds)
        ratio = -math.copysign(mu, slip) if slip else ratio
        then, after = closing + (nn + ratio * nt) * STEP, slip + (nt + ratio * tt) * STEP
        if compressed is None and then >= 0:
            compressed = push, work
        work += STEP * (closing + then) / 2
        closing, push, rub = then, push + STEP, rub + ratio * STEP
        slip = 0.0 if after * slip < 0 or (ratio == holds and not slip) else after
        if compressed is not None:
            ends = push >= (1 + e) * compressed[0] if law == "poisson" else work >= (1 - e * e) * compressed[1]
            if ends:
                return push, rub


@pytest.mark.parametrize("law", ["poisson", "stronge"])
@pytest.mark.parametrize(
    ("angle", "along", "e", "mu"),
    [(0.7, 1.0, 0.5, 0.3), (0.7, 0.1, 0.5, 1.2), (-0.3, 0.6, 0.7, 0.5), (0.9, -0.05, 0.8, 0.2), (0.5, 0.0, 0.6, 0.1)],
)
def test_impulses_are_those_of_small_steps(law: str, angle: float, along: float, e: float, mu: float) -> None:
    """It slips on, stops and sticks, or turns back."""
    scene = rod(angle, along, friction=mu, restitution=e)
    answer = solve_scene(read({**scene, "impacts": law}), [0.11])
    found = answer.events[0].impulses
    push, rub = by_steps(angle, along, law, e, mu)
    assert (found["normal"], found["friction"]) == pytest.approx((push, rub), abs=4 * STEP)
    assert answer.events[0].energy_loss > 0
    # The law of the contact is that which counts.
    own = rod(angle, along, friction=mu, restitution=e, impacts=law)
    assert solve_scene(read(own), [0.11]).events[0].impulses == found


def test_newton_alone_adds_energy_to_kanes_pendulum() -> None:
    """Two rods that swing onto a floor: where the slip turns back, Newton's law gives more energy than there was.

    References
    ----------
    T. R. Kane, D. A. Levinson, "Dynamics: Theory and Applications" (1985), section 5.8: 20 and 30 degrees, -0.1 and
    -0.2 rad/s, mu = 0.5.
    """
    ends = {"places": {"a": [-0.5, 0], "b": [0.5, 0]}}
    rods: dict[str, Any] = {}
    x, y = 0.0, 0.0
    for name, degrees, rate in (("upper", 20, -0.1), ("lower", 30, -0.2)):
        angle = math.radians(degrees)
        at = [x + 0.5 * math.sin(angle), y - 0.5 * math.cos(angle)]
        motion = {"angle": angle - math.pi / 2, "angular_velocity": rate}
        rods[name] = {"mass": 1, "inertia": "1/12", "at": at, **motion, **ends}
        x, y = x + math.sin(angle), y - math.cos(angle)
    contact = {"kind": "contact", "place": "lower.b", "on": {"at": [0, y]}, "friction": 0.5, "restitution": 0.5}
    pins = [{"kind": "pin", "a": "upper.a", "b": [0, 0]}, {"kind": "pin", "a": "upper.b", "b": "lower.a"}]
    scene = {"bodies": rods, "connections": [*pins, contact]}
    newton, stronge = (solve_scene(read({**scene, "impacts": law}), [1e-3]) for law in ("newton", "stronge"))
    assert newton.problem is not None
    assert newton.problem.code == "energy-gain"
    assert stronge.problem is None
    assert stronge.events[0].energy_loss > 0
