"""Strang's composition against exponentials of matrices, and its invariants."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from core.systems.methods import SymmetricSplitting
from tests.core.systems.systems import elliptic_functions, oscillator, rigid_body

U = 2.0**-53
CROSS = np.array([np.cross(np.eye(3), axis).T for axis in np.eye(3)])
"""Turning a momentum backwards about each axis: M' = M x e_k."""


@settings(deadline=None, derandomize=True, max_examples=25)
@given(st.tuples(*3 * [st.floats(0.5, 4.0)]), st.tuples(*3 * [st.floats(-2.0, 2.0)]), st.floats(1e-3, 0.5))
def test_a_step_turns_the_momentum_about_the_axes_there_and_back(moments, rates, h) -> None:
    inertia = np.array(moments)
    momentum = inertia * np.array(rates)
    for axis, part in ((0, 0.5), (1, 0.5), (2, 1.0), (1, 0.5), (0, 0.5)):
        momentum = expm(part * h * momentum[axis] / inertia[axis] * CROSS[axis]) @ momentum
    got = SymmetricSplitting(h).integrate(rigid_body(moments, rates), np.array([h])).states[0]
    # Five rotations, each of a sine, a cosine, products and a sum, and divided by its moments; expm as good.
    size = np.abs(inertia * np.array(rates)).max()
    assert np.abs(inertia * got - momentum).max() <= 5 * 16 * U * 2 * size


@settings(deadline=None, derandomize=True, max_examples=25)
@given(st.floats(0.01, 1.5), st.integers(1, 50))
def test_an_oscillator_is_kicked_and_drifts(h, n) -> None:
    """exp(hA/2) exp(hB) exp(hA/2) with nilpotent parts: shears, of determinant one."""
    system = oscillator()
    first, second = np.zeros((2, 2)), np.zeros((2, 2))
    unit = np.eye(2)
    for k in range(2):
        state = unit[k].copy()
        system.structure.splitting.flow(0, 1.0, state, system.parameters)
        first[:, k] = state
        state = unit[k].copy()
        system.structure.splitting.flow(1, 1.0, state, system.parameters)
        second[:, k] = state
    a, b = first - unit, second - unit
    assert not (a @ a).any()
    assert not (b @ b).any()
    assert (a + b).tolist() == [[0.0, 1.0], [-1.0, 0.0]]
    step = expm(0.5 * h * a) @ expm(h * b) @ expm(0.5 * h * a)
    want = np.linalg.matrix_power(step, n) @ [1.0, 0.0]
    got = SymmetricSplitting(h).integrate(system, h * np.arange(1.0, n + 1)).states[-1]
    # The step is conjugate to a rotation by a matrix of condition 1/(1 - h^2/4)^(1/2) < 1.6.
    assert np.abs(got - want).max() <= 16 * n * U * 1.6


@pytest.mark.parametrize("system", [rigid_body((1.0, 2.0, 2.5), (0.4, 1.0, -0.7)), oscillator(), elliptic_functions()])
def test_it_goes_back_the_way_it_came(system) -> None:
    there = SymmetricSplitting(0.05).integrate(system, np.array([4.0])).states[0]
    back = SymmetricSplitting(0.05).integrate(replace(system, initial_state=there.copy()), np.array([-4.0])).states[0]
    # Eighty steps of at most five flows there and back, each flow rounding a few times.
    assert np.abs(back - system.initial_state).max() <= 160 * 5 * 4 * U


def test_momentum_is_conserved_to_rounding_and_energy_within_a_band_proportional_to_the_square_of_the_step() -> None:
    system = rigid_body((1.0, 2.0, 3.0), (0.1, 1.0, 0.1))
    bands = []
    for h in (0.1, 0.05):
        run = SymmetricSplitting(h).integrate(system, np.linspace(0.0, 500.0, 1001))
        values = system.invariants(run.states)
        names = sorted(values)
        momentum, energy = (values[next(n for n in names if word in n)] for word in ("momentum", "energy"))
        # Ten thousand steps of five rotations: at random, sqrt(50000) roundings.
        assert np.abs(momentum / momentum[0] - 1).max() <= 2 * U * 4 * (5 * run.work.steps) ** 0.5
        bands.append(np.abs(energy / energy[0] - 1).max())
    assert bands[0] / bands[1] == pytest.approx(4.0, rel=0.05)
    assert bands[0] > 1e-6
