from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.balls import precision
from core.bodies.exact import rotated, rotation
from core.bodies.exact_inertia import ExactInertia
from core.rotation.exact_start import ExactStart
from tests.core.bodies.exact_tensors import of_tensor
from tests.drawn import draws

OBLIQUE = [[2, 1, 1], [1, 3, "0.5"], [1, "0.5", 4]]


def start(inertia: ExactInertia, rates) -> ExactStart:
    x, y, z = (Fraction(w) for w in rates)
    return ExactStart(inertia, (x, y, z))


@pytest.mark.parametrize(
    ("moments", "rates", "regime", "side"),
    [
        ((1, 2, 3), (0, 0, 0), "rest", None),
        ((1, 2, 3), (0, 5, 0), "steady", None),
        ((1, 1, 3), (1, 2, 0), "steady", None),
        ((1, 1, 1), (1, 2, 3), "steady", None),
        ((1, 2, 3), (1, 1, "0.1"), "periodic", -1),
        ((1, 2, 3), ("0.1", 1, 1), "periodic", 1),
        ((3, 2, 1), (1, 1, "0.1"), "periodic", 1),
        ((1, 1, 3), (1, 1, "1e-30"), "periodic", 1),
        ((1, 3, 3), (1, 1, "1e-30"), "periodic", -1),
        ((14, 21, 24), (6, 1, 7), "separatrix", 0),
        ((14, 21, 24), (6, 0, -7), "separatrix", 0),
        ((14, 21, 24), (6, 1, "7.00000000000000000000000000000000000001"), "periodic", 1),
        ((14, 21, 24), (6, 1, "6.99999999999999999999999999999999999999"), "periodic", -1),
    ],
)
@pytest.mark.parametrize("turned", [None, (1, 2, -3, 4)], ids=["principal axes", "oblique axes"])
def test_regime_and_circled_axis_are_decided_exactly(moments, rates, regime, side, turned):
    inertia = ExactInertia.of_moments(moments)
    w = [Fraction(x) for x in rates]
    if turned is not None:
        matrix = rotation(turned)
        inertia = of_tensor(rotated(inertia.tensor, matrix))
        w = [sum(r * x for r, x in zip(row, w, strict=True)) for row in matrix]
    found = start(inertia, w)
    assert found.regime == regime
    if side is not None:
        assert found.side == side


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@given(st.tuples(*[st.integers(-9, 9)] * 3))
def test_principal_axes_diagonalise(rates):
    inertia = of_tensor(OBLIQUE)
    with precision(200):
        state = start(inertia, rates).principal_state()
    axes = np.array([[float(x) for x in row] for row in state.axes])
    tensor = np.array(inertia.tensor, dtype=float)
    assert axes.T @ tensor @ axes == pytest.approx(np.diag([float(x) for x in state.moments]), abs=1e-13)
    assert np.linalg.det(axes) == pytest.approx(1)
    assert axes @ [float(x) for x in state.rates] == pytest.approx(rates, abs=1e-13)
    assert all(x.rad() < 1e-50 for row in state.axes for x in row)


@pytest.mark.parametrize("rates", [(1, 2, 3), (3, 0, 1), (-1, "0.5", 0)])
def test_symmetric_bodies_in_oblique_axes(rates):
    inertia = of_tensor([[2, 1, 1], [1, 2, 1], [1, 1, 2]])
    with precision(200):
        state = start(inertia, rates).principal_state()
    assert state.gaps[0].is_zero()
    axes = np.array([[float(x) for x in row] for row in state.axes])
    assert axes.T @ np.array(inertia.tensor, dtype=float) @ axes == pytest.approx(np.diag([1.0, 1, 4]), abs=1e-13)
    assert np.linalg.det(axes) == pytest.approx(1)
    assert axes @ [float(x) for x in state.rates] == pytest.approx([float(w) for w in rates], abs=1e-13)


def test_body_axes_that_are_principal_are_only_sorted():
    for order in ((0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)):
        moments = [(1, 2, 3)[k] for k in order]
        with precision(100):
            state = start(ExactInertia.of_moments(moments), (5, 7, 11)).principal_state()
        axes = np.array([[float(x) for x in row] for row in state.axes])
        assert np.linalg.det(axes) == 1
        assert [float(x) for x in state.moments] == [1, 2, 3]
        assert list(axes @ [float(x) for x in state.rates]) == [5, 7, 11]
        assert all(x.is_exact() for x in (*state.rates, *state.moments, *state.gaps))


@pytest.mark.parametrize("tensor", [OBLIQUE, [[14, 0, 0], [0, 21, 0], [0, 0, 24]]], ids=["irrational", "rational"])
def test_the_middle_axis_comes_within_45_degrees_where_energy_and_momentum_say_so(tensor):
    """Where it comes nearest, the other axis that the momentum does not circle has no rate: two equations in two."""
    inertia, found = of_tensor(tensor), set()
    moments, axes = np.linalg.eigh(np.array(tensor, dtype=float))
    for rates in [(i, j, k) for i in (-9, 1, 4) for j in (-2, 0, 5) for k in (-4, 1, 3)]:
        motion = start(inertia, rates)
        if motion.regime != "periodic":
            continue
        momentum = moments * (axes.T @ rates)
        about, across = moments[1], moments[2 if motion.side > 0 else 0]
        squares = np.linalg.solve([[1, 1], [1 / about, 1 / across]], [momentum @ momentum, momentum**2 @ (1 / moments)])
        tilts = squares[0] / squares.sum() > 0.5
        assert motion.tilts_below_45_degrees() == tilts
        found.add((motion.side, bool(tilts)))
    assert len(found) == 4
