"""How wrong samples are: largest and final, norm-wise and by component; and the drifts, which are no errors."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.peers.cases import Case
from core.arrays import Floats


def measured(case: Case, states: Floats, true: Floats) -> dict[str, Any]:
    """Return the errors of samples, shape (n, k), against pairs of value and tail, shape (n, k, 2).

    Angular velocities: norms relative to the largest norm, components relative to the largest magnitude that this
    component takes, and the drifts of energy and angular momentum. Attitudes: the angle between the computed and the
    true one (rad), whatever the sign and the length of the quaternion.
    """
    if states.shape != true.shape[:2]:
        raise ValueError(f"{states.shape} samples where {true.shape[:2]} were asked for")
    if not np.isfinite(states).all():
        raise ArithmeticError("samples are not finite")
    if case.attitude:
        angles = attitude_errors(states, true)
        return {"error": float(angles.max()), "final error": float(angles[-1])}
    wrong = (states - true[..., 0]) - true[..., 1]
    norms = np.linalg.norm(wrong, axis=1) / np.linalg.norm(true[..., 0], axis=1).max()
    components = np.abs(wrong).max(axis=0) / np.abs(true[..., 0]).max(axis=0)
    return {
        "error": float(norms.max()),
        "final error": float(norms[-1]),
        "component error": float(components.max()),
        "drifts": drifts(case, states),
    }


def attitude_errors(states: Floats, true: Floats) -> Floats:
    """Return the angles between quaternions, shape (n, 4), and the true ones, shape (n, 4, 2), in radians.

    The vector part of conj(q) p is that of conj(q) (p -+ q), in which nothing cancels.
    """
    unit = states / np.linalg.norm(states, axis=1)[:, None]
    value = true[..., 0]
    sign = np.sign((unit * value).sum(axis=1))[:, None]
    difference = (sign * unit - value) - true[..., 1]
    q0, q = value[:, :1], value[:, 1:]
    d0, d = difference[:, :1], difference[:, 1:]
    vector = q0 * d - d0 * q - np.cross(q, d)
    angles: Floats = 2.0 * np.arcsin(np.minimum(np.linalg.norm(vector, axis=1), 1.0))
    return angles


def drifts(case: Case, states: Floats) -> dict[str, float]:
    """Return the largest relative changes of energy and of the magnitude of the angular momentum."""
    moments = np.array(case.moments)
    energy = (moments * states**2).sum(axis=1)
    momentum = np.linalg.norm(moments * states, axis=1)
    return {
        name: float(np.abs(figures / figures[0] - 1.0).max())
        for name, figures in (("energy", energy), ("angular momentum", momentum))
    }
