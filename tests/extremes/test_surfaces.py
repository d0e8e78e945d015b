"""Energy ellipsoids, polhodes and starts of every shape and size: on both ellipsoids, in exact arithmetic."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

from tests.extremes.asking import ask
from tests.extremes.questions import MOTIONS

SURFACE, STATES = "/v1/rotation/energy-ellipsoid", "/v1/rotation/initial-states"
UNIT = Fraction(2) ** -53


def energy_of(moments: Any, rates: Any) -> Fraction:
    return sum((Fraction(i) * Fraction(w) ** 2 for i, w in zip(moments, rates, strict=True)), Fraction(0)) / 2


def momentum_of(moments: Any, rates: Any) -> Fraction:
    return sum((Fraction(i) ** 2 * Fraction(w) ** 2 for i, w in zip(moments, rates, strict=True)), Fraction(0))


def test_every_point_lies_on_the_surface_and_semi_axes_are_right() -> None:
    answered = 0
    for motion in MOTIONS:
        question = {"body": motion.question["body"], "energy": 1.0, "resolution": 2, "points": 12, "separatrix": True}
        reply = ask(SURFACE, question | {"polhodes": {"count": 2, "seed": 3}})
        if not reply.answered:
            continue
        answered += 1
        answer = reply.answer
        for moment, axis in zip(motion.moments, answer["semi_axes"], strict=True):
            assert abs(Fraction(axis) ** 2 * Fraction(moment) / 2 - 1) <= 4 * UNIT, motion.name
        curves = [*answer["polhodes"], *answer["separatrix"]]
        points = [*answer["mesh"]["vertices"], *(point for curve in curves for point in curve["points"])]
        for point in points:
            if min((abs(x) for x in point if x), default=0.0) > 1e-290:
                assert abs(energy_of(motion.moments, point) - 1) <= 24 * UNIT, motion.name
        assert answer["mesh"]["quality"]["watertight"]
        middle = sorted(motion.moments)[1]
        for curve in answer["separatrix"]:
            # The separatrix has the momentum of a spin about the middle axis: L^2 = 2 E B.
            for point in curve["points"]:
                assert abs(momentum_of(motion.moments, point) / (2 * Fraction(middle)) - 1) <= 24 * UNIT, motion.name
    assert answered > 250


def test_a_polhode_has_the_momentum_of_its_start() -> None:
    checked = 0
    for motion in MOTIONS:
        reply = ask(SURFACE, motion.question | {"resolution": 1, "layout": "triangles", "points": 16})
        if not reply.answered:
            continue
        (curve,) = reply.answer["polhodes"]
        energy, momentum = energy_of(motion.moments, motion.rates), momentum_of(motion.moments, motion.rates)
        for point in curve["points"]:
            assert abs(energy_of(motion.moments, point) / energy - 1) <= 24 * UNIT, motion.name
            assert abs(momentum_of(motion.moments, point) / momentum - 1) <= 24 * UNIT, motion.name
            checked += 1
    assert checked > 1000


def test_polhodes_on_both_sides_of_the_separatrix_differ_by_their_distance() -> None:
    """The curves that circle the smallest and the largest axis come together as the separatrix is approached."""
    body = {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]}
    for hair in (1e-1, 1e-3, 1e-6, 1e-10):
        nearest = []
        for start in ((1.5 * hair, 1.3, 0.5 * hair), (0.7 * hair, 1.3, -0.9 * hair)):
            question = {"body": body, "angular_velocity": list(start), "resolution": 1, "points": 4096}
            (curve,) = ask(SURFACE, question).of()["polhodes"]
            nearest.append(min(math.hypot(p[0] - 0.0, p[2] - 0.0) for p in curve["points"]))
        # Both pass the middle axis at a distance of the order of the hair's.
        assert all(hair / 10 < near < 3 * hair + 4e-3 for near in nearest), hair


def test_starts_have_their_energy_wherever_doubles_can_say_it() -> None:
    for motion in MOTIONS[::2]:
        for energy in (1e-150, 1.0, 1e150):
            question = {"body": motion.question["body"], "energy": energy, "count": 3, "seed": 5}
            reply = ask(STATES, question)
            if reply.answered:
                for rates in reply.answer["angular_velocities"]:
                    assert abs(energy_of(motion.moments, rates) / Fraction(energy) - 1) <= 16 * UNIT, motion.name
