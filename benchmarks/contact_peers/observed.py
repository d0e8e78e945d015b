"""What is measured of a run: times of events and places, from what an engine has at every step."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from benchmarks.contact_peers.cases import BETWEEN, BOUNCE, HIGH, LADDER, SLIP, SLOW, ContactCase

State = tuple[float, float, float, float, float, float]
"""Place of the centre of mass (m) and angle (rad), and their rates."""

FALL = 9.81


@dataclass(frozen=True)
class Step:
    """What an engine has after a step.

    Attributes
    ----------
    wall, floor, friction : float
        Forces of the step that ended here (N): normal ones, and that along the floor.
    """

    time: float
    state: State
    wall: float = 0.0
    floor: float = 0.0
    friction: float = 0.0


def figures(case: ContactCase, final: State, steps: Sequence[Step]) -> dict[str, float]:
    """Return what is measured, by its name."""
    if not all(map(math.isfinite, final)):
        raise ArithmeticError("the motion is not finite")
    if case is LADDER:
        return {"leaves the wall at": _last_force(steps), "angle at 0.8 s": final[2]}
    if case is SLIP:
        return {
            "slips below 10 mm/s from": _slow(steps, case.balls[0][2]),
            "velocity at 1 s": final[3],
            "place at 1 s": final[0],
        }
    if case is BOUNCE:
        found = {"height at 2.2 s": _height(steps, BETWEEN)}
        if steps[-1].state[1] < HIGH:
            found["last above 1 mm"] = _last_above(steps, HIGH)
        return found
    first = next((one for one in steps if one.time > 1e-3), steps[-1])
    return {
        "foot after 1 ms": _foot_rate(first.state),
        "largest force": max(one.floor for one in steps),
        "spin at 0.1 s": final[5],
        "height at 0.1 s": final[1],
    }


def _slow(steps: Sequence[Step], radius: float) -> float:
    """Return when the rim hardly slips any more, on the line through two steps."""
    slips = [abs(one.state[3] + radius * one.state[5]) for one in steps]
    i = next((i for i, slip in enumerate(slips) if slip < SLOW), None)
    if i is None:
        raise ArithmeticError("the disc does not roll")
    a, b = steps[i - 1].time, steps[i].time
    return a + (b - a) * (slips[i - 1] - SLOW) / (slips[i - 1] - slips[i])


def _foot_rate(state: State) -> float:
    """Return how fast the chalk's foot slides (m/s)."""
    return state[3] + state[5] * math.sin(state[2])


def _last_force(steps: Sequence[Step]) -> float:
    """Return when the wall's force becomes zero: the line through its last two values, at most a step further."""
    last = max((i for i, one in enumerate(steps) if one.wall > 0.0), default=0)
    if last == 0:
        return 0.0
    a, b = steps[last - 1], steps[last]
    step = b.time - a.time
    return b.time + (min(1.0, b.wall / (a.wall - b.wall)) * step if a.wall > b.wall else 0.0)


def _hermite(a: Step, b: Step, time: float) -> float:
    """Return the height between two steps: the cubic with their heights and rates."""
    h = b.time - a.time
    s = (time - a.time) / h
    (y, v), (z, w) = (a.state[1], a.state[4]), (b.state[1], b.state[4])
    return (1 + 2 * s) * (1 - s) ** 2 * y + s * (1 - s) ** 2 * h * v + s * s * (3 - 2 * s) * z + s * s * (s - 1) * h * w


def _height(steps: Sequence[Step], time: float) -> float:
    i = next(i for i, one in enumerate(steps) if one.time >= time - 1e-12)
    return _hermite(steps[i - 1], steps[i], time)


def _last_above(steps: Sequence[Step], height: float) -> float:
    """Return when the centre of the ball's contact is last above a height."""
    last = max((i for i, one in enumerate(steps) if one.state[1] > height), default=0)
    a, b = steps[last], steps[last + 1]
    low, high = a.time, b.time
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if _hermite(a, b, middle) > height else (low, middle)
    return low
