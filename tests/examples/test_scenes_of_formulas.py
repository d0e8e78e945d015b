"""Described scenes with forces by formula: closed forms, and Taylor's method of mpmath with 30 digits."""

from __future__ import annotations

import mpmath as mp
import numpy as np

from tests.examples.scene_columns import columns, times
from tests.oracles.elliptic import real_of
from tests.oracles.minimal_coordinates import cos, motion


def test_the_fall_with_drag(answer_of):
    """v = -u tanh(g t/u) with u^2 = m g/c, y = 100 - (u^2/g) log cosh(g t/u); the drag takes what energy is lost."""
    answer = answer_of("scenes/fall-with-drag")
    found, stated = columns(answer), answer["trajectory"]["columns"]
    with mp.workdps(30):
        g, u = mp.mpf("9.81"), mp.sqrt(mp.mpf("9.81") / mp.mpf("0.25"))
        fallen = np.array(
            [[u * mp.tanh(g * t / u), u**2 / g * mp.log(mp.cosh(g * t / u))] for t in map(mp.mpf, times(answer))]
        )
        lost = fallen[:, 0] ** 2 / 2 - g * fallen[:, 1]
    for name, expected in (
        ("stone.velocity", -fallen[:, 0]),
        ("stone.position", 100 - fallen[:, 1]),
        ("drag.work", lost),
    ):
        own = found[name][:, 1] if found[name].ndim == 2 else found[name]
        assert np.max(np.abs(own - expected.astype(float))) <= stated[name]["error"] < 1e-11


def test_the_driven_duffing_oscillator(answer_of):
    """x'' = -k (x - 1) - b (x - 1)^3 + F cos(w t)."""
    answer = answer_of("scenes/driven-duffing-oscillator")
    found, stated = columns(answer), answer["trajectory"]["columns"]
    with mp.workdps(30):
        b = mp.mpf("0.25")

        def potential(phase, x):
            square = (x - 1) * (x - 1)
            return square / 2 + square * square / 16 - x * cos(phase) * 0.3

        states = motion(lambda phase, x: [(1, x)], potential, [0, 1.5], [1.2, 0], times(answer), driven=1)
        exact = np.array([(real_of(q[1]), real_of(v[1])) for q, v in states])
        pull = (exact[:, 0] - 1) + b * (exact[:, 0] - 1) ** 3
    for name, expected in (
        ("bob.position", exact[:, 0]),
        ("bob.velocity", exact[:, 1]),
        ("spring.force", pull),
    ):
        own = found[name][:, 0] if found[name].ndim == 2 else found[name]
        assert np.max(np.abs(own - expected.astype(float))) <= stated[name]["error"] < 1e-11
