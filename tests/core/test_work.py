"""Every loop of core that a request can make long is counted, and ends at the limit; no answer depends on it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from math import inf
from typing import Any

import numpy as np
import pytest

from core.bodies.composite import WORK_OF_A_PART, Composite, Part
from core.bodies.measured import PointMasses, PrincipalMoments
from core.bodies.solids import Ball
from core.digits.adaptive_precision import each_determined, until_determined
from core.errors import BudgetExceeded
from core.rotation.ensemble import WORK_OF_A_MEMBER, ensemble
from core.rotation.precession.measurement import Measure, measure_period
from core.rotation.surfaces.energy_surface import EnergyEllipsoid
from core.rotation.surfaces.initial_states import initial_states
from core.rotation.surfaces.polhodes import WORK_OF_A_CURVE, polhode, separatrix
from core.rotation.torque_free import TorqueFree
from core.scenes.friction import Friction
from core.scenes.named_scene import WORK_OF_A_SCENE
from core.scenes.string_phases import WORK_OF_A_PHASE
from core.scenes.unwinding_shafts import UnwindingShafts
from core.systems.budget import Budget
from core.systems.methods import (
    ClosedFormEvaluation,
    DiscreteMoserVeselov,
    DormandPrince853,
    ExplicitEuler,
    ImplicitMidpoint,
    Lsoda,
    Radau,
    RungeKutta4,
    SymmetricSplitting,
)
from core.systems.solve import solve
from core.work import WorkLimitReached, remaining, spend, work_limit

BODY = PrincipalMoments((1.0, 2.0, 2.5)).mass_properties()
START = np.array([0.1, 1.0, 0.2])
SYSTEM = TorqueFree(BODY, START)
TIMES = np.linspace(0.0, 5.0, 40)
SHAFTS = UnwindingShafts(
    masses=(2.0, 1.0), radii=(0.1, 0.2), slopes=(0.5, 0.9), gravity=9.81, positions=(1.0, 1.5), wound=(0.5, 0.8),
    velocities=(0.1, 0.2), spins=(5.0, 1.0), restitution=0.9,
    friction=Friction(kinetic=(0.1, 0.1), static=(0.12, 0.12)),
)  # fmt: skip

COUNTED: dict[str, tuple[Callable[[], Any], float]] = {
    "times": (lambda: solve(SYSTEM, TIMES), 40),
    "rows": (lambda: PointMasses(masses=1.0, positions=[[1.0, 2.0, 3.0], [0.0, 1.0, 0.0]] * 30), 60),
    "parts": (lambda: Composite((Part(Ball(radius=1.0, mass=1.0)),) * 3).mass_properties(), 3 * WORK_OF_A_PART),
    "members": (lambda: ensemble(BODY, np.tile(START, (3, 1)), TIMES), 3 * (WORK_OF_A_MEMBER + 40)),
    "a measurement": (
        lambda: measure_period(SYSTEM, Measure(ExplicitEuler(0.01), duration=20.0, samples=50, tolerance=0.1)),
        50 + 2000,
    ),
    "points of a polhode": (lambda: polhode(BODY, START, 100), 100 + WORK_OF_A_CURVE),
    "points of a separatrix": (lambda: separatrix(BODY, 1.0, 100), 100 + WORK_OF_A_CURVE),
    "triangles": (lambda: EnergyEllipsoid.of(BODY, 1.0).triangles(5), 500),
    "a grid": (lambda: EnergyEllipsoid.of(BODY, 1.0).grid(5), 50),
    "states": (lambda: initial_states(BODY, 1.0, 70, 0), 70),
    "phases": (lambda: SHAFTS.answer(np.array([0.0, 0.5])), WORK_OF_A_SCENE + 2 + 20 * WORK_OF_A_PHASE),
    "digits": (lambda: until_determined(lambda: 1, 4096), 4096),
    "each of some digits": (lambda: each_determined(lambda: lambda i: i, 1000, 128), 128 + 8000),
    "a closed form": (lambda: ClosedFormEvaluation().integrate(SYSTEM, TIMES), 40),
    "explicit Euler": (lambda: ExplicitEuler(0.01).integrate(SYSTEM, TIMES), 500),
    "Runge-Kutta": (lambda: RungeKutta4(0.01).integrate(SYSTEM, TIMES), 2000),
    "the implicit midpoint": (lambda: ImplicitMidpoint(0.01).integrate(SYSTEM, TIMES), 1000),
    "splitting": (lambda: SymmetricSplitting(0.01).integrate(SYSTEM, TIMES), 2500),
    "Moser and Veselov": (lambda: DiscreteMoserVeselov(0.01).integrate(SYSTEM, TIMES), 500),
    "Dormand and Prince": (lambda: DormandPrince853(1e-12).integrate(SYSTEM, TIMES), 200),
    "LSODA": (lambda: Lsoda(1e-9).integrate(SYSTEM, TIMES), 50),
    "Radau": (lambda: Radau(1e-6).integrate(SYSTEM, TIMES), 100),
}
"""What is long, and the units that it takes at least."""


@pytest.mark.parametrize("name", COUNTED)
def test_what_can_be_long_is_counted_and_ends_at_the_limit(name: str) -> None:
    work, least = COUNTED[name]
    with work_limit(inf) as meter:
        work()
    assert least <= meter.spent
    with work_limit(meter.spent):
        work()
    for limit in (meter.spent - 1, 0.5 * meter.spent, 1.0, 0.0):
        with pytest.raises(WorkLimitReached), work_limit(limit):
            work()


def test_judging_the_error_of_a_method_is_counted() -> None:
    """Times beyond the closed form leave the judgement to runs of far more evaluations than the method's own."""
    system = TorqueFree(BODY, np.array([1e57, 2e57, 1e57]))
    with pytest.raises(WorkLimitReached), work_limit(2000):
        solve(system, [1.0], method=SymmetricSplitting(269.0))


def test_what_is_over_the_budget_is_refused_as_such_where_the_limit_is_farther() -> None:
    with pytest.raises(BudgetExceeded), work_limit(1e6):
        ExplicitEuler(0.01).integrate(SYSTEM, TIMES, Budget(evaluations=100))
    with pytest.raises(WorkLimitReached), work_limit(50):
        ExplicitEuler(0.01).integrate(SYSTEM, TIMES, Budget(evaluations=100))


@pytest.mark.parametrize("method", [DormandPrince853(1e-9), RungeKutta4(0.01), None])
def test_an_answer_does_not_depend_on_the_limit(method: Any) -> None:
    free = solve(SYSTEM, TIMES, method=method)
    with work_limit(1e6):
        limited = solve(SYSTEM, TIMES, method=method)
    assert free.state.tobytes() == limited.state.tobytes()
    assert free.accuracy == limited.accuracy


def test_without_a_limit_nothing_is_counted() -> None:
    spend(1e9)
    assert remaining() == inf


def test_a_limit_within_another_counts_for_itself() -> None:
    with work_limit(10) as outer:
        spend(4)
        with work_limit(5):
            spend(5)
        assert (outer.spent, remaining()) == (4, 6)
    assert remaining() == inf


def test_tasks_have_their_own_counts() -> None:
    async def limited(units: float) -> float:
        with work_limit(10) as meter:
            spend(units)
            await asyncio.sleep(0)
            spend(units)
            return meter.spent

    async def both() -> list[float]:
        return await asyncio.gather(limited(3), limited(4))

    assert asyncio.run(both()) == [6, 8]
