"""The measured period against a plain forward Euler, and against the exact rate at which forward Euler turns.

For moments (I, I, I3) forward Euler is exactly solvable: a step of h multiplies w_1 + i w_2 by 1 + i h Omega, so it
turns by atan(h Omega) and grows by sqrt(1 + h^2 Omega^2).
"""

import math
import re
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.mass_properties import diagonal
from core.errors import BudgetExceeded, InvalidParameter
from core.rotation.precession.measurement import Measure, first_return, measure_period
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from core.systems.methods import ClosedFormEvaluation, DormandPrince853, ExplicitEuler, RungeKutta4
from tests.oracles.cases import T_HANDLE
from tests.oracles.free_rotation import period

STEP = 15.0 / 1999.0
SOURCE = {"duration": 15.0, "samples": 2000, "tolerance": 0.035}


def top(moments=(1.0, 1.0, 2.0), start=(1.0, 1.0, 1.0)) -> TorqueFree:
    return TorqueFree(diagonal(moments), np.array(start))


def test_the_lesson_s_own_experiment():
    found = measure_period(top(), Measure(ExplicitEuler(STEP), **SOURCE))
    assert found.grid_point == 837
    assert found.time == 6.28064032016008
    assert found.theory == pytest.approx(2.0 * math.pi, rel=4e-16)
    assert found.relative_difference == pytest.approx(-0.000405, abs=5e-7)
    assert found.work.evaluations == 1999
    for said in ("Sample 837", "6.28064032016008", "-0.0405 %", "0.02475", "0.007197", "0.01501", "coincidence"):
        assert said in found.explanation


def test_it_is_what_a_plain_loop_finds():
    """The lesson's rule, which skips the first twenty points instead of waiting for the motion to leave."""
    times = np.linspace(0.0, 15.0, 2000)
    w = start = np.array([1.0, 1.0, 1.0])
    found = None
    for k in range(1, times.size):
        x, y, z = w
        w = w + (times[1] - times[0]) * np.array([(1.0 - 2.0) * y * z, (2.0 - 1.0) * z * x, 0.0])
        if k >= 20 and np.linalg.norm(w - start) < 0.035:
            found = k
            break
    assert found == measure_period(top(), Measure(ExplicitEuler(STEP), **SOURCE)).grid_point


def test_the_three_amounts_are_right_and_add_up():
    found = measure_period(top(), Measure(ExplicitEuler(STEP), **SOURCE))
    # The exact motion is 2 w_perp sin(Omega t / 2) away from its start.
    early = 2.0 * math.asin(0.035 / (2.0 * math.sqrt(2.0)))
    assert found.from_tolerance == pytest.approx(-early, abs=4e-15)
    entry = 2.0 * math.pi - early
    assert found.from_grid == pytest.approx(math.ceil(entry / STEP) * STEP - entry, abs=4e-15)
    assert found.from_method == pytest.approx(2 * STEP, abs=4e-15)
    total = found.from_tolerance + found.from_grid + found.from_method
    assert total == pytest.approx(found.time - found.theory, abs=4e-15)


def test_the_method_s_own_rate_is_forward_euler_s():
    found = measure_period(top(), Measure(ExplicitEuler(STEP), **SOURCE))
    steps = 2.0 * math.pi / math.atan(STEP)
    assert found.crossing.time == pytest.approx(steps * STEP, abs=1e-7)
    grown = math.sqrt(2.0) * (math.exp(0.5 * steps * math.log1p(STEP * STEP)) - 1.0)
    assert found.crossing.distance == pytest.approx(grown, rel=1e-3)
    # 2E = 2 (1 + h^2)^n + 2 from 4 at the start.
    assert found.drifts["energy"] == pytest.approx(0.5 * math.expm1(837 * math.log1p(STEP * STEP)), rel=1e-12)


@pytest.mark.parametrize("method", [RungeKutta4(STEP), DormandPrince853(1e-10), ClosedFormEvaluation()])
def test_a_better_method_measures_worse_on_the_same_terms(method):
    found = measure_period(top(), Measure(method, **SOURCE))
    assert found.grid_point == 835
    assert found.from_method == 0.0
    assert found.error < 1e-8
    assert found.crossing.time == pytest.approx(2.0 * math.pi, abs=1e-7)
    assert "coincidence" not in found.explanation


def test_three_distinct_moments():
    found = measure_period(
        top(T_HANDLE, (1.0, 10.0, 1.0)), Measure(RungeKutta4(1e-3), duration=6.0, samples=6001, tolerance=0.05)
    )
    want = float(period(T_HANDLE, (1.0, 10.0, 1.0)))
    assert found.theory == pytest.approx(want, rel=4e-16)
    assert found.crossing.time == pytest.approx(want, abs=1e-6)
    assert -0.1 < found.from_tolerance < 0.0 <= found.from_grid <= 1e-3


@pytest.mark.parametrize("size", [2.0**-490, 2.0**490])
@pytest.mark.parametrize("rate", [2.0**-490, 2.0**490])
def test_free_of_scale(size, rate):
    scaled = top((size, size, 2.0 * size), (rate, rate, rate))
    found = measure_period(scaled, Measure(ExplicitEuler(STEP / rate), 15.0 / rate, 2000, 0.035 * rate))
    unit = measure_period(top(), Measure(ExplicitEuler(STEP), **SOURCE))
    assert found.grid_point == unit.grid_point
    assert (found.time * rate, found.theory * rate) == (unit.time, unit.theory)
    for name in ("from_tolerance", "from_grid", "from_method"):
        assert getattr(found, name) * rate == pytest.approx(getattr(unit, name), abs=2e-15)
    assert found.crossing.distance == pytest.approx(unit.crossing.distance * rate)


def test_what_never_leaves_cannot_return():
    for system in (top((1.0, 1.0, 1.0)), top(start=(0.0, 0.0, 0.0)), top(start=(0.0, 0.0, 2.0))):
        found = measure_period(system, Measure(RungeKutta4(0.01), **SOURCE))
        assert (found.time, found.grid_point, found.theory, found.crossing) == (None, None, None, None)
        assert "nothing can return" in found.explanation


def test_a_motion_that_does_not_return_reports_its_least_distance():
    # Forward Euler gains so much in a turn that it misses this smaller ball.
    found = measure_period(top(), Measure(ExplicitEuler(STEP), 15.0, 2000, 0.03))
    assert found.time is None
    assert found.theory == pytest.approx(2.0 * math.pi)
    nearest = math.sqrt(2.0) * math.expm1(math.pi / math.atan(STEP) * math.log1p(STEP * STEP))
    # That is where the turn is complete; some sample lies within half a step of it.
    said = float(re.search(r"nearest is (\S+) rad/s", found.explanation)[1])
    assert nearest - 1e-4 < said < math.hypot(nearest, STEP * math.sqrt(2.0) / 2.0) + 1e-4
    for duration in (2.0, 5.0):
        short = measure_period(top(), Measure(RungeKutta4(STEP), duration, 2000, 0.03))
        assert short.time is None
        assert "longer duration" in short.explanation


def test_a_motion_without_period():
    separatrix = top((14.0, 21.0, 24.0), (6.0, 2.0, 7.0))
    found = measure_period(separatrix, Measure(ClosedFormEvaluation(), 100.0, 1000, 0.1))
    assert (found.time, found.theory) == (None, None)
    assert "no period" in found.explanation
    # Every integrator falls off the separatrix sooner or later, and then it turns over and comes back.
    led_astray = measure_period(separatrix, Measure(RungeKutta4(1e-2), 50.0, 5001, 0.1))
    assert led_astray.time is not None
    assert led_astray.from_method is None
    assert led_astray.error > 1.0
    assert "no period: what came back is the method" in led_astray.explanation


def test_a_method_may_return_where_the_motion_does_not():
    # At t = 6.3 the exact motion is 2 sqrt 2 sin(0.0084) = 0.0238 from its start; the method happens to be nearer.
    found = measure_period(top(), Measure(RungeKutta4(0.7), 14.0, 21, 0.02))
    assert found.grid_point == 9
    assert found.from_tolerance is found.from_grid is found.from_method is None
    assert "exact motion, sampled at the same times, does not come back" in found.explanation


def test_refusals_name_the_field():
    with pytest.raises(BudgetExceeded) as many:
        measure_period(top(), Measure(ExplicitEuler(0.1), 15.0, 2000, 0.1), Budget(samples=1000))
    assert many.value.path == ("measure", "samples")
    with pytest.raises(BudgetExceeded) as dear:
        measure_period(top(), Measure(ExplicitEuler(1e-9), 15.0, 2000, 0.1))
    assert dear.value.path == ("measure", "method", "step")
    with pytest.raises(InvalidParameter) as wild:
        measure_period(top(start=(1e3, 1e3, 1e3)), Measure(ExplicitEuler(1.0), 1e3, 1000, 0.1))
    assert wild.value.path == ("measure", "method", "step")
    with pytest.raises(InvalidParameter, match="duration"):
        measure_period(top(), Measure(ExplicitEuler(1.0), 5e-324, 3, 0.1))
    for field, value in (
        ("duration", 0.0),
        ("samples", 2),
        ("samples", 10**9 + 1),
        ("tolerance", 0.0),
        ("tolerance", math.nan),
    ):
        with pytest.raises(InvalidParameter, match=field):
            Measure(ExplicitEuler(STEP), **(SOURCE | {field: value}))


@given(st.lists(st.floats(0.0, 2.0), min_size=1, max_size=12), st.floats(0.1, 1.9))
@settings(deadline=None, derandomize=True)
def test_first_return_is_the_first_sample_inside_after_one_outside(distances, tolerance):
    want = None
    left = False
    for k, distance in enumerate(distances):
        left = left or Fraction(distance) >= Fraction(tolerance)
        if left and distance < tolerance:
            want = k
            break
    assert first_return(np.array(distances), tolerance) == want
