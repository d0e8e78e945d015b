"""Methods on named scenes: their errors are true, fall with their order, and events stay those of the motion itself."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.errors import BudgetExceeded, NotApplicable
from core.scenes.chain_on_wedge import ChainOnWedge
from core.scenes.friction import Friction
from core.scenes.named_scene import NamedScene
from core.scenes.rod_in_hole import RodInHole
from core.scenes.sampled_motion import ComparableEquation
from core.scenes.unwinding_shafts import UnwindingShafts
from core.systems.budget import Budget
from core.systems.methods import (
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
from core.systems.trajectory import Trajectory

ROD = RodInHole(1.0, 1.0, 1.0, 9.81)
WHIRLING = RodInHole(1.0, 1.2, 2.0, 9.81, angle=0.3, angular_velocity=9.0, hole="cylinder")
CHAIN = ChainOnWedge((1.0, 1.2), (0.6, 0.8), 9.81, 2.0, 0.5, 1.0)
STRING = ChainOnWedge((1.0, 1.2), (0.6, 0.8), 9.81, 2.0, 0.0, 1.0)
SHAFTS = UnwindingShafts((2.0, 1.0), (0.1, 0.2), (0.5, 0.9), 9.81, positions=(1.0, 1.5), wound=(0.5, 0.8))
JERKED = UnwindingShafts((2.0, 1.0), (0.1, 0.2), (0.5, 0.9), 9.81, positions=(1.0, 1.5), spins=(5.0, 0.0))
ROUGH = UnwindingShafts(
    (2.0, 1.0),
    (0.1, 0.2),
    (0.5, 0.9),
    9.81,
    positions=(1.0, 1.5),
    velocities=(-0.5, 0.5),
    friction=Friction((0.3, 0.3), (0.2, 0.2)),
)
SCENES: dict[str, tuple[NamedScene, float]] = {
    "rod": (ROD, 2.0),
    "whirling rod": (WHIRLING, 2.0),
    "chain": (CHAIN, 0.5),
    "massless chain": (STRING, 0.5),
    "shafts": (SHAFTS, 0.4),
}


def trajectory_of(scene: NamedScene, times: Any, method: Any) -> Trajectory:
    found = scene.answer(np.asarray(times, dtype=np.float64), method=method).trajectory
    assert found is not None
    return found


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize(
    "method",
    [
        ExplicitEuler(1e-3),
        RungeKutta4(0.01),
        ImplicitMidpoint(0.01),
        SymmetricSplitting(0.01),
        DormandPrince853(1e-9),
        Lsoda(1e-8),
        Radau(1e-6),
    ],
    ids=lambda method: method.kind,
)
def test_every_method_states_the_distance_from_the_motion(name: str, method: Any) -> None:
    scene, end = SCENES[name]
    times = np.linspace(0.0, end, 9)
    found, right = trajectory_of(scene, times, method), trajectory_of(scene, times, None)
    assert found.method == method.kind
    assert found.accuracy.how == "measured against closed form"
    assert found.work.evaluations > 0
    assert found.ended == right.ended
    assert found.events == right.events
    for column, values in found.columns.items():
        apart = float(np.max(np.abs(values.values - right[column])))
        assert apart <= values.error <= apart + right.columns[column].error * (1 + 1e-12)
        assert values.error <= found.accuracy.error * float(values.scale or 0.0) * (1 + 1e-12)
        assert values.unit == scene.units()[column]
    assert found.accuracy.error < (0.1 if method.kind == "explicit-euler" else 3e-3)


@pytest.mark.parametrize(
    ("method", "order"),
    [(ExplicitEuler, 1), (SymmetricSplitting, 2), (ImplicitMidpoint, 2), (RungeKutta4, 4)],
    ids=lambda entry: getattr(entry, "kind", ""),
)
@pytest.mark.parametrize("name", ["rod", "whirling rod", "chain"])
def test_errors_fall_with_the_order(name: str, method: Any, order: int) -> None:
    scene, end = SCENES[name]
    steps = {1: 4000, 2: 400, 4: 100}[order]
    coarse, fine = (trajectory_of(scene, [0.5 * end, end], method(end / n)).accuracy.error for n in (steps, 2 * steps))
    assert np.log2(coarse / fine) == pytest.approx(order, abs=0.2)


def test_the_splitting_has_no_drift_of_energy() -> None:
    """Over 200 periods of the rod the energy oscillates, where that of a method of the same order grows."""
    (period,) = (ROD.answer(outputs=frozenset({"period"})).figures["period"],)
    times = np.linspace(0.0, 200 * period, 2001)
    rod, gains = ROD.answer(), {}
    length = rod.figures["equivalent_length"]
    for method in (SymmetricSplitting(0.01), ExplicitEuler(0.01)):
        found = trajectory_of(ROD, times, method)
        energy = 0.5 * found["angular_velocity"] ** 2 - 9.81 / length * np.cos(found["angle"])
        gains[method.kind] = float(np.max(np.abs(energy - energy[0]))) / (9.81 / length)
    assert gains["symmetric-splitting"] < 1e-4
    assert gains["explicit-euler"] > 1.0


@given(st.floats(0.1, 0.9), st.floats(0.5, 30.0), st.floats(-1.3, 1.3), st.floats(-2.0, 2.0))
def test_a_fine_method_agrees_with_the_closed_form(length: float, gravity: float, angle: float, rate: float) -> None:
    """Two ways to one motion, whichever the signs of angle, rate and forces."""
    scene = RodInHole(1.0, length, 1.0, gravity, angle=angle, angular_velocity=rate, hole="cylinder")
    assert trajectory_of(scene, [0.0, 0.3, 1.0], DormandPrince853(1e-13)).accuracy.error < 1e-10


def test_solve_runs_methods_and_warns() -> None:
    found = solve(CHAIN, [0.5], method=ExplicitEuler(0.01))
    assert [notice.code for notice in found.warnings] == ["accuracy-not-reached"]
    assert found.accuracy.error > 1e-9
    short = CHAIN.answer(np.array([0.5]), digits=3, method=ExplicitEuler(0.01))
    assert short.warnings[-1].code == "accuracy-not-reached"
    assert short.trajectory is not None
    assert short.trajectory["position"][0] == float(f"{found['position'][0]:.2e}")
    assert short.accuracy.error >= found.accuracy.error


def test_the_time_of_an_event_states_how_near_it_is() -> None:
    """Solid shafts: T = g (sin a + sin b) M1 M2/(3 (M1 + M2)), and string 2 unwinds at 2 T/M2."""
    (end,) = trajectory_of(SHAFTS, [1.0], None).events
    with mp.workdps(40):
        tension = mp.mpf(9.81) * (mp.sin(mp.mpf(0.5)) + mp.sin(mp.mpf(0.9))) * 2 / 9
        right = mp.sqrt(2 * mp.mpf(0.8) / (2 * tension))
        assert abs(mp.mpf(end.time) - right) <= end.error <= mp.mpf(2) ** -53 * right * 2
    assert (end.kind, end.name, dict(end.impulses)) == ("string-2-unwound", "", {})


def test_figures_are_not_the_methods() -> None:
    plain, by_method = CHAIN.answer(np.array([0.5])), CHAIN.answer(np.array([0.5]), method=ExplicitEuler(0.1))
    assert plain.figures == by_method.figures
    bare = CHAIN.answer(np.array([0.5]), frozenset({"acceleration"}), method=ExplicitEuler(0.1))
    assert bare.work.evaluations == 0
    assert bare.accuracy.how == "closed form"


def test_times_beyond_the_end_take_no_steps() -> None:
    found = trajectory_of(SHAFTS, [0.1, 0.2, 50.0], RungeKutta4(0.01))
    assert found.ended == "string-2-unwound"
    assert found.work.steps == 20
    assert list(found.rows if found.rows is not None else ()) == [0, 1]
    none = trajectory_of(SHAFTS, [50.0], RungeKutta4(0.01))
    assert none.time.size == none.work.steps == 0


@pytest.mark.parametrize("scene", [JERKED, ROUGH], ids=["jerks", "slip"])
def test_no_method_steps_over_an_event(scene: UnwindingShafts) -> None:
    events = trajectory_of(scene, [1.0], None).events
    assert events
    with pytest.raises(NotApplicable, match="interrupt") as refusal:
        trajectory_of(scene, [1.0], RungeKutta4(0.01))
    assert refusal.value.path == ("times",)
    with pytest.raises(NotApplicable):
        ComparableEquation.of(scene.motion_to(1.0))
    before = 0.5 * next(event.time for event in events if event.time > 0.0)
    assert trajectory_of(scene, [before], RungeKutta4(0.1 * before)).accuracy.error < 1e-12


def test_methods_that_cannot_are_refused() -> None:
    with pytest.raises(NotApplicable) as refusal:
        trajectory_of(ROD, [1.0], DiscreteMoserVeselov(0.01))
    assert refusal.value.path == ("method", "kind")
    with pytest.raises(BudgetExceeded) as too_long:
        ROD.answer(np.array([1.0]), method=RungeKutta4(1e-3), budget=Budget(evaluations=100))
    assert too_long.value.path == ("method", "step")
