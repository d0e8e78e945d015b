"""Forward Euler, against the source document's figures and its exact identities."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.systems.methods import ExplicitEuler
from tests.core.systems.systems import rigid_body
from tests.drawn import draws


def test_first_return_of_the_source_document() -> None:
    times = np.linspace(0, 15, 2000)
    states = ExplicitEuler(times[1] - times[0]).integrate(rigid_body((1, 1, 2), (1, 1, 1)), times).states
    near = np.linalg.norm(states - states[0], axis=1) < 0.035
    assert 20 + int(near[20:].argmax()) == 837
    assert times[837] == pytest.approx(6.28064032016008, abs=1e-14)


def test_every_sample_is_one_step_of_the_recurrence_to_the_last_bit() -> None:
    inertia = np.array([1.0, 2.0, 3.5])
    times = np.linspace(0, 15, 2000)
    h = times[1] - times[0]
    states = ExplicitEuler(h).integrate(rigid_body((1, 2, 3.5), (1, 0.5, -1)), times).states
    w = states[0].copy()
    for row in states[1:]:
        slope = [(inertia[i - 2] - inertia[i - 1]) / inertia[i] * w[i - 2] * w[i - 1] for i in range(3)]
        w = np.array([w[i] + h * slope[i] for i in range(3)])
        assert w == pytest.approx(row, rel=1e-13, abs=1e-13)
        w = row


@settings(deadline=None, max_examples=draws(50))
@given(
    # Moments so near each other that no motion runs away from Euler within its forty steps.
    st.tuples(*[st.floats(0.5, 2)] * 3),
    st.tuples(*[st.floats(-3, 3)] * 3),
    st.floats(1e-3, 1e-2),
)
def test_energy_and_momentum_grow_at_every_step_by_exactly_what_theory_says(moments, rates, h) -> None:
    # One step adds h^2/2 sum I f^2 to the energy and h^2 sum (I f)^2 to the squared momentum, f being the acceleration.
    inertia = np.array(moments)
    w = ExplicitEuler(h).integrate(rigid_body(moments, rates), h * np.arange(40.0)).states
    # Component by component: the cross product of two large vectors that are nearly parallel would cancel.
    torque = (np.roll(inertia, -1) - np.roll(inertia, 1)) * np.roll(w, -1, axis=1) * np.roll(w, 1, axis=1)
    energy, momentum = (w**2 @ inertia) / 2, ((inertia * w) ** 2).sum(axis=1)
    gained = h * h / 2 * (torque**2 / inertia).sum(axis=1)[:-1]
    assert np.diff(energy) == pytest.approx(gained, abs=1e-14 * energy.max())
    assert np.diff(momentum) == pytest.approx(h * h * (torque**2).sum(axis=1)[:-1], abs=1e-14 * momentum.max())


@settings(deadline=None, derandomize=True, max_examples=draws(50))
@given(st.tuples(*[st.floats(0.5, 2)] * 3), st.tuples(*[st.floats(-3, 3)] * 3), st.floats(1e-3, 1e-2), st.floats(0, 1))
def test_between_grid_points_it_is_the_straight_line(moments, rates, h, share) -> None:
    for way in (h, -h):
        system, points = rigid_body(moments, rates), way * np.arange(8.0)
        w = ExplicitEuler(h).integrate(system, points).states
        between = ExplicitEuler(h).integrate(system, points[:-1] + share * way).states
        # The times are rounded by an ulp of 8 h, as shares of a step by 8 ulps; so are states of size 3.
        assert between == pytest.approx(w[:-1] + share * np.diff(w, axis=0), abs=64 * 3 * 2.0**-53)


@pytest.mark.parametrize("step", [20 / 9999, 0.002])
@pytest.mark.parametrize(
    ("moments", "gain"),
    [
        ((837.195503014, 714.008200689, 437.685185185), 0.093),
        ((795.792181070, 713.509259259, 395.782921811), 0.102),
    ],
)
def test_energy_gained_by_the_handle_in_the_source_document(moments, gain, step) -> None:
    """20 s in 10000 samples from (1, 10, 1): 9.3 % about the origin, 10.2 % about the centre of mass.

    The samples are 20/9999 s apart; a step of 0.002 s, which README has, ends at the first and the last of them alone.
    """
    times = np.linspace(0, 20, 10_000)
    system = rigid_body(moments, (1, 10, 1))
    run = ExplicitEuler(step).integrate(system, times)
    assert (run.work.steps, run.work.step) == (round(20 / step), step)
    assert run.work.evaluations == (9999 if step > 0.002 else 10_000 + 9998)
    energy = system.invariants(run.states)["energy"]
    assert energy[-1] / energy[0] - 1 == pytest.approx(gain, abs=5e-4)
