"""Integrals along a motion, of integrands that are known to their own errors only."""

from __future__ import annotations

import numpy as np

from core.arrays import Floats
from core.multibody.trajectory.integrals import integrated


def test_what_an_integrand_is_wrong_by_is_not_sought_in_shorter_intervals() -> None:
    """One that is known to 1e-11 takes no more points than an exact one, and its error says so."""
    rng, asked = np.random.default_rng(7), []

    def integrand(times: Floats) -> tuple[Floats, Floats, Floats]:
        asked.append(len(times))
        power = 4.5 + 1e-11 * rng.uniform(-1.0, 1.0, len(times))
        return power, np.full(len(times), 4.5), np.abs(power)

    values, errors = integrated(integrand, np.linspace(0.0, 3.0, 7), np.array([1.0, 3.0]))
    assert sum(asked) < 500
    assert np.all(np.abs(values - [4.5, 13.5]) <= errors)
    assert errors[1] < 1e-10
