from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from core.balls import precision
from core.multibody.algebra.polynomials import BITS
from core.multibody.motion.kepler import Kepler
from core.multibody.motion.modelling import modelled
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read
from tests.drawn import draws
from tests.oracles.kepler import orbit


def central(at, velocity, strength, mass=1):
    return {
        "bodies": {"p": {"mass": mass, "at": at, "velocity": velocity}},
        "connections": [{"kind": "inverse-square", "name": "k", "a": "p", "b": [0] * len(at), "strength": strength}],
    }


def figure(low: float, high: float):
    return st.integers(round(low * 1000), round(high * 1000)).map(lambda x: str(x / 1000))


@settings(max_examples=draws(60))
@given(
    figure(0.2, 2), figure(-1, 1), figure(-2, 2), figure(0.05, 2), st.sampled_from(["1", "-1", "0.3"]), figure(-9, 9)
)
def test_places_and_rates_are_those_of_the_anomaly(x, y, u, w, mu, t):
    with mp.workdps(60):
        r = mp.hypot(mpf(x), mpf(y))
        if abs((mpf(u) ** 2 + mpf(w) ** 2) / 2 - mpf(mu) / r) < 1e-3 or abs(mpf(x) * mpf(w) - mpf(y) * mpf(u)) < 0.05:
            return
        places, rates, period = orbit((mpf(x), mpf(y)), (mpf(u), mpf(w)), mpf(mu), [float(t)])
        with precision(BITS):
            found = modelled(read(central([x, y], [u, w], mu)))
            ((_, motion),) = found.whole.parts
            assert isinstance(motion, Kepler)
            states = motion.states(np.array([float(t)]))
            own = motion.period
        for values, errors, right in ((states.q, states.q_error, places[0]), (states.v, states.v_error, rates[0])):
            for i in range(2):
                away = abs(mpf(values[0, i, 0]) + mpf(values[0, i, 1]) - right[i])
                assert away <= errors[0, i]
        assert (own is None) == (period is None)
        if period is not None:
            assert float(own) == pytest.approx(float(period), rel=4e-16)


def test_a_parabola_follows_barkers_equation():
    """From the pericentre q = 1/2, tan(f/2) = s: t sqrt(mu/2 q^3) = s + s^3/3."""
    s = 3.0
    time = math.sqrt(0.25) * (s + s**3 / 3)
    answer = solve_scene(read(central([0.5, 0], [0, 2], 1)), [time])
    assert answer.model.name == "Kepler's problem"
    assert answer.period is None
    assert column(answer, "p.position").values[0] == pytest.approx([0.5 * (1 - s * s), s], rel=1e-14)


@pytest.mark.parametrize("speed", [0.0, 1.0, -1.0, 2.0, -2.0, 3.0])
def test_what_falls_in_is_an_event_at_its_time(speed):
    """Radial motion with r'^2 = 2/r + 2 E, from r = 1: quadrature of dr/r'."""
    answer = solve_scene(read(central([1, 0], [speed, 0], 1)), [-20.0, 20.0])
    twice = speed * speed - 2

    times = sorted(event.time for event in answer.events)
    if twice < 0:
        # r = top sin^2 x: the square roots at both ends go.
        top = mpf(-2) / mpf(twice)
        here = mp.asin(1 / mp.sqrt(top))
        inward, outward = (
            float(mp.quad(lambda x: 2 * top * mp.sqrt(top / 2) * mp.sin(x) ** 2, ends))
            for ends in ([0, here], [here, mp.pi / 2])
        )
        expected = sorted([-inward - 2 * outward, inward]) if speed <= 0 else sorted([-inward, inward + 2 * outward])
    else:
        inward = float(mp.quad(lambda r: mp.sqrt(r / (2 + twice * r)), [0, 1]))
        expected = [-inward] if speed > 0 else [inward]
    assert times == pytest.approx(expected, rel=1e-13)
    assert {event.name for event in answer.events} == {"k"}


@pytest.mark.parametrize("unit", [1e-100, 1e-30, 1e30, 1e100])
def test_units_of_any_size_move_alike(unit):
    """Lengths in any unit, the rates in units of length over second."""
    answer = solve_scene(read(central([f"1.5*{unit}", 0], [0, f"0.6*{unit}"], f"1*{unit}*{unit}*{unit}")), [7.0])
    plain = solve_scene(read(central([1.5, 0], [0, 0.6], 1)), [7.0])
    assert answer.period == pytest.approx(plain.period, rel=1e-15)
    own, right = (column(one, "p.position").values / scale for one, scale in ((answer, unit), (plain, 1.0)))
    assert own == pytest.approx(right, rel=1e-14)


def test_a_billion_periods_later_the_place_is_known():
    answer = solve_scene(read(central([1.6, 0], [0, 0.5], 1)), [2.0**33])
    with mp.workdps(60):
        places, _, _ = orbit((mpf("1.6"), mpf(0)), (mpf(0), mpf("0.5")), mpf(1), [2.0**33])
    assert answer.trajectory.accuracy.error < 1e-15
    assert column(answer, "p.position").values[0] == pytest.approx([float(x) for x in places[0]], rel=1e-15)


@pytest.mark.parametrize("ratio", ["1e-12", "1e12"])
def test_masses_far_apart(ratio):
    bodies = {"a": {"mass": 1, "at": [0, 0]}, "b": {"mass": ratio, "at": [1, 0], "velocity": [0, f"sqrt(1 + {ratio})"]}}
    scene = {"bodies": bodies, "connections": [{"kind": "gravitation", "a": "a", "b": "b", "constant": 1}]}
    answer = solve_scene(read(scene), [1.0])
    # A circle about the common centre.
    angle = math.sqrt(1 + float(ratio))
    apart = column(answer, "b.position").values[0] - column(answer, "a.position").values[0]
    assert apart == pytest.approx([math.cos(angle), math.sin(angle)], abs=1e-9 if float(ratio) > 1 else 1e-14)


def test_beside_collision_a_long_ellipse_is_followed():
    answer = solve_scene(
        read(central([1, 0], [0, "1e-6"], 1)), np.linspace(0, 5, 11), ["trajectory", "energy", "energy-in-time"]
    )
    energy = column(answer, "energy.kinetic").values + column(answer, "energy.potential").values
    assert energy == pytest.approx(answer.energy.total, rel=1e-9)
    assert not answer.events
