"""The motion of a named scene held against its equation, between its samples.

About one time the rates of its states, by the polynomial through seven samples, are those of the equation that methods
integrate: y'' = a + b (y - c) + d sin y for each coordinate. The closed forms do not come from it.
"""

from __future__ import annotations

from math import sqrt, ulp

import numpy as np

from core.arrays import Floats
from core.errors import NotApplicable, SelfCheckFailed
from core.scenes.equation import SceneEquation
from core.scenes.motion import NamedSceneMotion

STEPS = np.arange(-3.0, 4.0)
WEIGHTS = np.array([-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0]) / 60.0
"""Rate of a function from its values at whole steps."""

WEIGHT = 2.0
"""Bound of the sum of the sizes of the weights, by which they multiply errors: it is 11/6."""

SHARE = (5.0**0.5 - 1.0) / 2.0
"""Where the time is between the first and the last sample: at none of the simple fractions."""

TURN = 2.0**-6
"""Step, in units of the quickest rate of the equation."""

KNOWN = 1e-9
"""Share of the terms to which rates are known: the sixth power of the step, over 140, is less by far."""

COARSE = 2.0**-24
"""Share of its time below which a step is too small beside the doubles."""

UNDERFLOW = float(np.finfo(float).smallest_subnormal)
"""What a double is rounded by at least, however small it is: a place after 1e-236 s is none."""


def check_motion(motion: NamedSceneMotion, times: Floats) -> None:
    """Check the motion about a time between the first and the last of its samples.

    Parameters
    ----------
    times : ndarray, shape (n,)
        Those of the samples (s).

    Raises
    ------
    SelfCheckFailed
        If rates and equation differ by more than the stated errors allow.
    """
    try:
        equation = motion.equation()
    except NotApplicable:
        # Events change the equation on the way.
        return
    first, last = min(float(times.min(initial=0.0)), 0.0), max(float(times.max(initial=0.0)), 0.0)
    _, b, _, d = equation.parameters.reshape(-1, 4).T
    rate = sqrt(float(np.abs(b).max() + np.abs(d).max())) + float(
        np.abs(equation.initial_state[len(d) :][d != 0.0]).max(initial=0.0)
    )
    time = first + SHARE * (last - first)
    room = min(time - first, last - time) / 4.0
    step = min(room, TURN / rate) if rate > 0.0 else room
    if not step > COARSE * abs(time):
        return
    with np.errstate(over="ignore", invalid="ignore"):
        _compare(motion, equation, time, step, rate, ulp(max(abs(first), abs(last))))


def _compare(
    motion: NamedSceneMotion, equation: SceneEquation, time: float, step: float, rate: float, rounding: float
) -> None:
    """Compare rates about a time with the equation.

    Parameters
    ----------
    rate : float
        The quickest of the equation (1/s).
    rounding : float
        Of the times (s).
    """
    a, b, c, d = equation.parameters.reshape(-1, 4).T
    moments, count = time + step * STEPS, len(a)
    # The steps as they are in doubles.
    step = float(moments[4] - moments[2]) / 2.0
    samples = motion.sample(moments)
    if samples.notices:
        # A column is too small for doubles.
        return
    states = motion.states(samples.values)
    errors = {name: np.broadcast_to(samples.errors[name], values.shape) for name, values in samples.values.items()}
    unsure = np.abs(motion.states(errors)).max(axis=0) + UNDERFLOW
    y, v = states[3, :count], states[3, count:]
    gained = WEIGHTS @ states / step
    expected = np.concatenate([v, a + b * (y - c) + d * np.sin(y)])
    terms = np.abs(a) + np.abs(b) * (np.abs(y) + np.abs(c)) + np.abs(d)
    sizes = np.concatenate([np.abs(v) + 4.0 * step * terms, terms + rate * np.abs(v)])
    late = rounding / step
    unknown = np.concatenate([unsure[count:], np.abs(b) * unsure[:count] + np.abs(d) * unsure[:count]])
    allowed = WEIGHT * unsure / step + unknown + (KNOWN + late) * sizes
    off = np.abs(gained - expected)
    worst = int(np.argmax(off - allowed))
    if off[worst] > allowed[worst]:
        law = "rate of a coordinate" if worst < count else "equation of the motion"
        raise SelfCheckFailed(law, motion.model.name, time, float(off[worst]), float(allowed[worst]))
