"""Samples of free rotations pass their check; spoilt ones do not."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from core.arrays import Floats
from core.bodies.measured import InertiaTensor
from core.errors import AccuracyUnreachable, SelfCheckFailed
from core.rotation.sampled_rotation import SampledRotation, sample_rotation
from core.rotation.self_check import check_rotation
from core.rotation.torque_free import TorqueFree
from core.systems.methods import RungeKutta4

TIMES = np.array([0.0, 0.3, 1.7, 4.0, 11.0, 50.0, 300.0])


def drawn(random: np.random.Generator) -> tuple[Any, Floats, Floats]:
    """Return a body of matter in turned axes, a start and an attitude, of any size."""
    a, b, c = 10.0 ** random.uniform(-3, 0, 3)
    axes, _ = np.linalg.qr(random.normal(size=(3, 3)))
    tensor = 10.0 ** random.uniform(-6, 6) * (axes * [b + c, c + a, a + b]) @ axes.T
    tensor = (tensor + tensor.T) / 2
    body = InertiaTensor(tuple(map(tuple, tensor.tolist()))).mass_properties()
    return body, random.normal(size=3) * 10.0 ** random.uniform(-3, 3), random.normal(size=4)


@pytest.mark.parametrize("seed", range(6))
def test_right_samples_pass(seed: int) -> None:
    random = np.random.default_rng(seed)
    for _ in range(40):
        body, start, attitude = drawn(random)
        times = TIMES / np.abs(start).max()
        sample_rotation(body, start.tolist(), times, attitude=attitude.tolist(), accuracy=1e-3)
        try:
            method = RungeKutta4(step=float(times[-1]) / 3000)
            sample_rotation(body, start.tolist(), times, method=method, accuracy=1e-3)
        except AccuracyUnreachable:
            continue


def _spoilt(change: Callable[[Floats, Floats], None], seed: int) -> None:
    random = np.random.default_rng(seed)
    for _ in range(20):
        body, start, attitude = drawn(random)
        found: SampledRotation = sample_rotation(
            body, start.tolist(), TIMES / np.abs(start).max(), attitude=attitude.tolist(), accuracy=1e-3
        )
        assert found.attitude is not None
        rates, turns = found.motion.state.copy(), found.attitude.quaternions.copy()
        change(rates, turns)
        stated = found.motion.accuracy
        system = TorqueFree(body, start)
        error = stated.error * (stated.largest_norm or 0.0)
        with pytest.raises(SelfCheckFailed):
            check_rotation(system.tensor, start, found.motion.time, rates, error, turns, found.attitude.error)


def test_spoilt_samples_do_not_pass() -> None:
    def larger(rates: Floats, turns: Floats) -> None:
        rates[3] *= 1.0 + 1e-9

    def exchanged(rates: Floats, turns: Floats) -> None:
        rates[4] = rates[4, [1, 0, 2]]

    def mirrored(rates: Floats, turns: Floats) -> None:
        rates[2, 0] *= -1.0

    def late(rates: Floats, turns: Floats) -> None:
        rates[2] = rates[3]

    def inverse(rates: Floats, turns: Floats) -> None:
        turns[1:, 1:] *= -1.0

    def turned(rates: Floats, turns: Floats) -> None:
        turns[5] = turns[5] + 1e-7 * turns[4]
        turns[5] /= np.linalg.norm(turns[5])

    for seed, change in enumerate((larger, exchanged, mirrored, late, inverse, turned)):
        _spoilt(change, seed)
