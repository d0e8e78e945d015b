"""The peers' benchmark measures what it says: its questions, its references and its errors."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from benchmarks.peers.cases import A123, ATTITUDES, CASES, DETEST_B5, NEAR_SEPARATRIX, SCIML, T_HANDLE
from benchmarks.peers.catalogue import PEERS
from benchmarks.peers.equations import array_function, initial_state
from benchmarks.peers.measures import attitude_errors, drifts, measured
from benchmarks.peers.picture import SHOWN
from benchmarks.peers.reference import confirmed, reference
from benchmarks.peers.sweep import best, closest
from tests.oracles.free_rotation import reference_angular_velocity

TIMES = np.linspace(0.0, 10.0, 21)
NAMES = {peer.name: peer for peer in PEERS}


def pairs(rows):
    """Numbers that double precision holds, as value and tail."""
    return np.stack((np.asarray(rows, dtype=float), np.zeros(np.shape(rows))), axis=-1)


def test_sciml_is_its_published_coefficients():
    """SciMLBenchmarks, NonStiffODE/RigidBody: y' = (-2 y2 y3, 1.25 y1 y3, -0.5 y1 y2)."""
    assert SCIML.coefficients == (-2.0, 1.25, -0.5)
    assert (SCIML.start, SCIML.stop) == ((1.0, 0.0, 0.9), 10.0)


def test_detest_b5_is_euler_s_equation_in_scaled_components():
    """Hull, Enright, Fellen, Sedgwick 1972, problem B5: y' = (y2 y3, -y1 y3, -0.51 y1 y2) from (0, 1, 1)."""
    scale = np.sqrt([1.53, 0.51, 3.0])
    np.testing.assert_allclose(np.array(DETEST_B5.start) / scale, (0.0, 1.0, 1.0), rtol=1e-15)
    for y in np.random.default_rng(5).normal(size=(5, 3)):
        slope = np.array(array_function(DETEST_B5)(0.0, scale * y)) / scale
        np.testing.assert_allclose(slope, (y[1] * y[2], -y[0] * y[2], -0.51 * y[0] * y[1]), rtol=1e-14)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_factors_are_those_of_some_body(case):
    """For any moments p + q + r + p q r = 0."""
    a, b, c = map(Fraction, case.moments)
    p, q, r = (b - c) / a, (c - a) / b, (a - b) / c
    assert p + q + r + p * q * r == 0
    np.testing.assert_allclose(case.coefficients, [float(x) for x in (p, q, r)], rtol=4e-16)


@pytest.mark.parametrize("case", [A123, SCIML, NEAR_SEPARATRIX, *ATTITUDES], ids=lambda case: case.name)
def test_two_references_agree(case):
    assert confirmed(case, TIMES, reference(case, TIMES)) < 1e-30


def test_a_wrong_reference_stops_the_run():
    wrong = reference(A123, TIMES)
    wrong[-1, 0, 1] += 1e-28
    with pytest.raises(ArithmeticError, match="differ by"):
        confirmed(A123, TIMES, wrong)


def test_errors_are_relative_to_the_largest_norm_and_components_to_their_own():
    true = pairs([[3.0, 4.0, 0.0], [0.0, 0.0, 2.0]])  # norms 5 and 2
    states = true[..., 0] + [[0.0, 0.4, 0.0], [0.0, 0.0, 0.1]]
    found = measured(A123, states, true)
    assert found["error"] == pytest.approx(0.4 / 5)
    assert found["final error"] == pytest.approx(0.1 / 5)
    assert found["component error"] == pytest.approx(0.4 / 4)


def test_the_tail_of_the_reference_counts():
    true = pairs([[1.0, 2.0, 2.0]])
    true[0, 0, 1] = 3e-20
    assert measured(A123, true[..., 0], true)["error"] == pytest.approx(1e-20)


def test_drifts_are_of_energy_and_of_momentum():
    found = drifts(A123, np.array([[1.0, 0.0, 0.0], [1.1, 0.0, 0.0]]))
    assert found["energy"] == pytest.approx(0.21)
    assert found["angular momentum"] == pytest.approx(0.1)


@pytest.mark.parametrize("angle", [1e-17, 1e-9, 0.3, 3.0])
def test_attitude_error_is_the_angle_whatever_sign_and_length(angle):
    rng = np.random.default_rng(7)
    q = rng.normal(size=(4, 4))
    q /= np.linalg.norm(q, axis=1)[:, None]
    # q times a turn by `angle` about x, as the reference gives it: rounded, with what that took away as the tail.
    a, b, c, d = q.T
    turned = np.stack((-b, a, d, -c), axis=1) * math.sin(angle / 2)
    value = q * math.cos(angle / 2) + turned
    true = np.stack((value, (q * math.cos(angle / 2) - value) + turned), axis=-1)
    found = attitude_errors(-2.0 * q, true)
    np.testing.assert_allclose(found, angle, rtol=1e-6, atol=3e-16)


def test_samples_of_another_shape_or_not_finite_are_no_answer():
    true = pairs(np.ones((2, 3)))
    with pytest.raises(ValueError, match="asked for"):
        measured(A123, np.ones((3, 3)), true)
    with pytest.raises(ArithmeticError, match="finite"):
        measured(A123, np.full((2, 3), np.nan), true)


CHECKED = ("Polhode", "SciPy ellipj, textbook form", "Dormand-Prince 853, Numba", "SciPy solve_ivp DOP853")
ASKED = [
    pytest.param(case, NAMES[name], id=f"{case.name}, {name}")
    for case in (A123, SCIML, DETEST_B5, ATTITUDES[1])
    for name in CHECKED
    if NAMES[name].answers(case)
]


@pytest.mark.parametrize(("case", "peer"), ASKED)
def test_peers_answer_the_question(case, peer):
    """One wrong coefficient or sign in any of them shows at once."""
    states = peer.prepare(case, 1e-12)()
    rows = [0, 4000, 9999]
    found = measured(case, states[rows], reference(case, case.times[rows]))
    assert found["error"] < 1e-9


def test_the_textbook_form_fails_near_the_separatrix():
    """It is why the peers' page measures it: m by subtraction is 1 there."""
    states = NAMES["SciPy ellipj, textbook form"].prepare(NEAR_SEPARATRIX, 0.0)()
    (want,) = reference_angular_velocity(NEAR_SEPARATRIX.moments, NEAR_SEPARATRIX.start, [60.0], digits=20)
    at = int(np.argmin(np.abs(NEAR_SEPARATRIX.times - 60.0)))
    assert not np.linalg.norm(states[at] - [float(x) for x in want]) < 1e-3


def test_the_fastest_setting_that_reaches_an_error_is_compared():
    points = [
        {"error": 1e-3, "milliseconds": 1.0},
        {"error": 1e-7, "milliseconds": 3.0},
        {"error": 1e-9, "milliseconds": 2.0},
        {"failure": "no"},
    ]
    assert best(points, 1e-6) == points[2]
    assert best(points, 1e-12) is None
    assert closest(points) == points[2]


def test_states_hold_the_attitude_where_it_is_requested():
    assert initial_state(T_HANDLE).tolist() == [1.0, 10.0, 1.0]
    assert initial_state(replace(T_HANDLE, attitude=True)).tolist() == [1.0, 10.0, 1.0, 1.0, 0.0, 0.0, 0.0]


def test_names_are_unique_and_those_that_are_drawn_exist():
    assert len(NAMES) == len(PEERS)
    assert set(SHOWN) <= set(NAMES)
