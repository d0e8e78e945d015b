"""Euler's equations against the torque balance in the body, and forward Euler against its exact identities."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.mass_properties import MassProperties, diagonal
from core.errors import InvalidParameter
from core.integration.methods import ExplicitEuler, SymmetricSplitting
from core.rotation.torque_free import TorqueFree

positive = st.floats(1e-2, 1e2)
spin = st.floats(-10, 10)
triple = st.tuples(positive, positive, positive)
start = st.tuples(spin, spin, spin)


def slope(system: TorqueFree, state=None) -> np.ndarray:
    out = np.empty(3)
    system.equation(0.0, np.array(system.initial_state if state is None else state), system.parameters, out)
    return out


def turned(angle_xy: float, angle_yz: float) -> np.ndarray:
    a, b, c, d = math.cos(angle_xy), math.sin(angle_xy), math.cos(angle_yz), math.sin(angle_yz)
    return np.array([[a, -b, 0], [b, a, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, c, -d], [0, d, c]])


def cross(a, b) -> list[Fraction]:
    return [a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3] for k in range(3)]


@given(triple, start)
@settings(deadline=None, derandomize=True)
def test_the_momentum_turns_against_the_body(moments, w):
    """(I w)' = (I w) x w, in rational arithmetic; the signs of all three equations follow from it."""
    i, v = [Fraction(x) for x in moments], [Fraction(x) for x in w]
    momentum = [a * b for a, b in zip(i, v, strict=True)]
    wanted = [float(t / a) for t, a in zip(cross(momentum, v), i, strict=True)]
    # The difference of two moments is rounded, which is all that can be lost.
    size = [4e-16 * max(moments) / own * max(map(abs, w)) ** 2 for own in moments]
    for got, want, slack in zip(slope(TorqueFree(diagonal(moments), np.array(w))), wanted, size, strict=True):
        assert abs(got - want) <= slack + 1e-300


def test_the_second_equation_has_the_cyclic_sign():
    assert slope(TorqueFree(diagonal((1.0, 2.0, 3.0)), np.ones(3))) == pytest.approx([-1.0, 1.0, -1.0 / 3.0], rel=1e-15)


@given(triple, start, st.floats(-3, 3), st.floats(-3, 3))
@settings(deadline=None, derandomize=True)
def test_turned_axes_describe_the_same_motion(moments, w, first, second):
    turn = turned(first, second)
    tensor = turn @ np.diag(moments) @ turn.T
    body = MassProperties(0.5 * (tensor + tensor.T), np.zeros((3, 3)))
    there = slope(TorqueFree(body, turn @ np.array(w)))
    here = turn @ slope(TorqueFree(diagonal(moments), np.array(w)))
    scale = max(moments) / min(moments) * max(map(abs, w)) ** 2
    assert there == pytest.approx(here, abs=1e-13 * scale + 1e-300)


@given(triple, start, st.integers(0, 2), st.floats(-5, 5))
@settings(deadline=None, derandomize=True)
def test_each_part_of_the_energy_turns_the_momentum_about_its_axis(moments, w, part, duration):
    system = TorqueFree(diagonal(moments), np.array(w))
    moved = np.array(w)
    assert system.structure.splitting is not None
    system.structure.splitting.flow(part, duration, moved, system.parameters)
    angle = duration * w[part]
    j, k = (part + 1) % 3, (part + 2) % 3
    # M' = M x w_part e_part: it turns backwards.
    before, after = complex(moments[j] * w[j], moments[k] * w[k]), complex(moments[j] * moved[j], moments[k] * moved[k])
    assert moved[part] == w[part]
    assert after == pytest.approx(before * np.exp(-1j * angle), abs=1e-12 * max(moments) * 10)


@given(triple, start, st.floats(1e-4, 0.1))
@settings(deadline=None, derandomize=True)
def test_forward_euler_gains_what_the_identities_say_at_every_step(moments, w, h):
    """2 dE = h^2 sum I f^2 and d(L^2) = h^2 sum (I f)^2, exactly: the terms of first order vanish."""
    system = TorqueFree(diagonal(moments), np.array(w))
    stepped = ExplicitEuler(h).integrate(system, np.array([h])).states[0]
    f = slope(system)
    for power in (1, 2):
        i = np.array(moments) ** power
        gained = (i * stepped * stepped).sum() - (i * np.array(w) ** 2).sum()
        size = (i * stepped * stepped).sum()
        assert gained == pytest.approx(h * h * (i * f * f).sum(), rel=1e-9, abs=1e-14 * size)


def test_splitting_keeps_the_momentum_of_a_body_in_turned_axes():
    turn = turned(0.7, -1.1)
    tensor = turn @ np.diag([1.0, 2.0, 3.0]) @ turn.T
    system = TorqueFree(MassProperties(0.5 * (tensor + tensor.T), np.zeros((3, 3))), np.array([0.3, 1.0, -0.4]))
    states = SymmetricSplitting(0.05).integrate(system, np.linspace(0, 50, 101)).states
    size = system.invariants(states)["angular_momentum"]
    assert np.ptp(size) < 1e-12 * size[0]


def test_invariants_and_figures_agree_and_leave_the_range_in_words():
    system = TorqueFree(diagonal((1.0, 2.0, 3.0)), np.array([1.0, 2.0, -1.0]))
    assert system.energy == 6.0
    assert system.angular_momentum == pytest.approx(math.sqrt(26.0), rel=4e-16)
    found = system.invariants(np.array([[1.0, 2.0, -1.0], [2.0, 4.0, -2.0]]))
    assert found["energy"][1] / found["energy"][0] == 4.0
    assert found["angular_momentum"][1] / found["angular_momentum"][0] == 2.0
    far = TorqueFree(diagonal((1e150, 2e150, 3e150)), np.array([1e150, 2e150, -1e150]))
    assert far.energy is None
    assert far.angular_momentum == pytest.approx(math.sqrt(26.0) * 1e300, rel=1e-15)
    assert [notice.code for notice in far.warnings] == ["out-of-range"]
    near = TorqueFree(diagonal((1e-150, 2e-150, 3e-150)), np.array([1e-150, 2e-150, -1e-150]))
    assert (near.energy, near.angular_momentum) == (None, pytest.approx(math.sqrt(26.0) * 1e-300, rel=1e-15))
    assert TorqueFree(diagonal((1.0, 2.0, 3.0)), np.zeros(3)).energy == 0.0


@pytest.mark.parametrize("scale", [2.0**-490, 2.0**490])
def test_equations_do_not_know_the_unit_of_mass(scale):
    unit, scaled = ((1.0, 2.0, 3.0), (scale, 2.0 * scale, 3.0 * scale))
    w = np.array([0.3, 1.0, -0.4])
    assert np.array_equal(slope(TorqueFree(diagonal(unit), w)), slope(TorqueFree(diagonal(scaled), w)))


def test_what_has_no_extent_does_not_rotate():
    with pytest.raises(InvalidParameter, match="greater than 0"):
        TorqueFree(diagonal((0.0, 1.0, 1.0)), np.ones(3))
