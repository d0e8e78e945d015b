"""Samples that are wrong: how much, since when, how late, and across the separatrix."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest

from core.assessment.compare import exchanged
from core.assessment.sample_findings import SampleErrors
from core.assessment.samples import ExactSamples
from core.bodies import PrincipalMoments
from core.rotation.torque_free import TorqueFree
from tests.core.assessment.student_integrators import euler, gyration, marched, motion


def errors_of_samples(
    system: TorqueFree, times: np.ndarray, rows: np.ndarray, right: np.ndarray, tolerance: float
) -> SampleErrors:
    return ExactSamples(system, times, right).errors(rows, tolerance)


def test_errors_say_how_much_and_since_when() -> None:
    moments, _, system = motion(Random(4))
    times = np.array([0.0, 3.0, 1.0, -2.0, 4.0])
    right = system.closed_form().sample(times)
    rows = right + np.array([[0.0, 0.0, 0.0], [0.3, 0.4, 0.0], [0.01, 0.0, 0.0], [0.0, 0.0, 0.02], [0.0, 0.2, 0.0]])
    found = errors_of_samples(system, times, rows, right, 0.015)
    assert found.largest == pytest.approx(0.5)
    assert found.final == pytest.approx(0.2)
    assert found.within_until == -2.0
    energy = (moments * rows**2).sum(axis=1)
    assert found.energy_drift == pytest.approx(np.abs(energy / energy[0] - 1).max())
    within = errors_of_samples(system, times, rows, right, 1.0)
    assert within.within_until is None
    assert within.sentence is None
    assert found.sentence is not None
    assert found.sentence.text("en") == "The samples are correct until t = -2 s."


def test_the_drift_of_explicit_euler_obeys_its_identity() -> None:
    """Every step adds h^2/2 sum I f^2 to the energy, and h^2 sum (I f)^2 to the square of the angular momentum."""
    moments, start, system = motion(Random(5))
    f, h = gyration(moments), 0.01
    times = np.arange(301) * h
    states = marched(euler, f, start, h, times)
    slopes = np.array([f(w) for w in states[:-1]])
    found = errors_of_samples(system, times, states, system.closed_form().sample(times), 1.0)
    energy = 0.5 * (moments * start**2).sum()
    gained = 0.5 * h * h * (moments * slopes**2).sum()
    assert found.energy_drift == pytest.approx(gained / energy, rel=1e-9)
    square = ((moments * start) ** 2).sum()
    momentum = np.sqrt(1.0 + h * h * ((moments * slopes) ** 2).sum() / square) - 1.0
    assert found.angular_momentum_drift == pytest.approx(momentum, rel=1e-9)


def test_samples_that_run_away_have_no_drift() -> None:
    _, _, system = motion(Random(6))
    times = np.array([0.0, 1.0])
    rows = np.array([[1.0, 1.0, 1.0], [1e200, 1e200, 1e200]])
    found = errors_of_samples(system, times, rows, system.closed_form().sample(times), 1.0)
    assert found.energy_drift is None
    assert found.phase_lag is None
    assert found.largest == pytest.approx(3**0.5 * 1e200)


@pytest.mark.parametrize("lag", [0.05, -0.05, 0.9, 1e-4])
def test_late_samples_are_late(lag: float) -> None:
    for seed in range(5):
        _, _, system = motion(Random(seed))
        times = np.linspace(0.0, 12.0, 300)
        exact = system.closed_form()
        assert exact.period is not None
        found = errors_of_samples(system, times, exact.sample(times - lag), exact.sample(times), 1e-3)
        assert found.phase_lag is not None
        whole = round((found.phase_lag - lag) / exact.period) * exact.period
        assert found.phase_lag - whole == pytest.approx(lag, rel=1e-5)


def test_noise_is_not_late() -> None:
    _, _, system = motion(Random(7))
    times = np.linspace(0.0, 12.0, 300)
    right = system.closed_form().sample(times)
    noisy = right + np.random.default_rng(1).normal(0.0, 0.01, right.shape)
    assert errors_of_samples(system, times, noisy, right, 1e-3).phase_lag is None


def near_separatrix(side: float) -> TorqueFree:
    start = np.array([3**0.5 * side * 0.02, 1.0, 0.02])
    return TorqueFree(PrincipalMoments((1.0, 2.0, 3.0)).mass_properties(), start)


def test_what_is_lost_at_the_separatrix_circles_another_axis() -> None:
    """With a start that is rounded to three digits, the motion is on the other side: at first it looks the same."""
    system, rounded = near_separatrix(0.9995), near_separatrix(1.0005)
    times = np.linspace(0.0, 30.0, 600)
    right, rows = (one.closed_form().sample(times) for one in (system, rounded))
    found = errors_of_samples(system, times, rows, right, 0.01)
    first = times[np.linalg.norm(rows - right, axis=1) > 0.01][0]
    assert first > 5.0
    assert found.within_until == found.separatrix_crossed == first
    assert found.sentence is not None
    shown = f"The samples are correct until t = {first:.3g} s. Then they are lost at the separatrix"
    assert found.sentence.text("en").startswith(shown)
    # A little more energy on the same side is no crossing.
    other = near_separatrix(0.9).closed_form().sample(times)
    assert errors_of_samples(system, times, other, right, 0.01).separatrix_crossed is None


def test_noise_is_not_lost_at_the_separatrix() -> None:
    system = near_separatrix(0.999)
    times = np.linspace(0.0, 30.0, 600)
    right = system.closed_form().sample(times)
    noisy = right + np.random.default_rng(2).normal(0.0, 0.01, right.shape)
    found = errors_of_samples(system, times, noisy, right, 0.005)
    assert found.within_until is not None
    assert found.separatrix_crossed is None


@pytest.mark.parametrize(
    ("order", "sentence"),
    [((0, 2, 1), "Axes 2 and 3 are exchanged."), ((1, 2, 0), "The axes are in the order 2, 3, 1.")],
)
def test_exchanged_axes_are_named(order: tuple[int, ...], sentence: str) -> None:
    _, _, system = motion(Random(8))
    right = system.closed_form().sample(np.linspace(0.0, 3.0, 20))
    assert exchanged(right[:, list(order)], right).text("en") == sentence
