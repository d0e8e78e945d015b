"""Dry friction: sticking, slipping, slackness that friction makes, and a tension that nothing fixes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.errors import InvalidParameter
from core.scenes.friction import Friction
from core.scenes.unwinding_shafts import UnwindingShafts
from tests.core.scenes.oracles import time_stepped_shafts
from tests.drawn import draws

PLAIN = UnwindingShafts(masses=(2.0, 3.0), radii=(0.1, 0.2), slopes=(0.6, 0.9), gravity=9.81, positions=(500.0, 500.0))
ROUGH = Friction(static=(0.6, 0.6), kinetic=(0.5, 0.5))


def test_no_coefficients_is_no_friction() -> None:
    none = replace(PLAIN, friction=Friction((0.0, 0.0), (0.0, 0.0)), velocities=(1.0, 0.3), restitution=0.4)
    times = np.linspace(0, 3, 31)
    rough, smooth = none.answer(times), replace(none, friction=None).answer(times)
    assert rough.figures["tension"] == pytest.approx(smooth.figures["tension"], rel=1e-15)
    assert rough.trajectory is not None
    assert smooth.trajectory is not None
    for name in ("positions", "velocities", "spins"):
        assert rough.trajectory[name] == pytest.approx(smooth.trajectory[name], rel=1e-12)


def test_sticking_shafts_roll_and_the_tension_is_said_to_be_open() -> None:
    answer = replace(PLAIN, friction=ROUGH).answer(np.linspace(0, 1, 5))
    mu = (2 / 3, 1.0)
    pulls = [9.81 * math.sin(s) for s in PLAIN.slopes]
    holds = [0.6 * m * 9.81 * math.cos(s) for m, s in zip(PLAIN.masses, PLAIN.slopes, strict=True)]
    assert answer.figures["tension"] is None
    assert answer.figures["friction_forces"] is None
    assert answer.figures["accelerations"] == pytest.approx([2 * p / 3 for p in pulls], rel=1e-15)
    low, high = answer.figures["tension_range"]
    assert low == pytest.approx(max(0.0, *(m * p - h for m, p, h in zip(mu, pulls, holds, strict=True))), abs=1e-12)
    assert high == pytest.approx(min(m * p + h for m, p, h in zip(mu, pulls, holds, strict=True)), rel=1e-14)
    assert answer.trajectory is not None
    assert "tension" not in answer.trajectory.columns
    assert {notice.code for notice in answer.warnings} == {"indeterminate"}
    assert answer.figures["phases"][0]["kind"] == "stick"
    assert answer.model.degrees_of_freedom == 2


def test_sticking_begins_exactly_where_the_page_says() -> None:
    pulls = [9.81 * math.sin(s) for s in PLAIN.slopes]
    loads = [m * 9.81 * math.cos(s) for m, s in zip(PLAIN.masses, PLAIN.slopes, strict=True)]
    least = abs(2 / 3 * pulls[0] - pulls[1]) / sum(loads)
    for factor, kind in ((1 + 1e-12, "stick"), (1 - 1e-12, "taut")):
        mu = least * factor
        scene = replace(PLAIN, friction=Friction((mu, mu), (0.5 * mu, 0.5 * mu)))
        assert scene.answer().figures["phases"][0]["kind"] == kind


def test_the_tension_while_sliding_is_the_page_s() -> None:
    scene = replace(PLAIN, friction=Friction((0.1, 0.05), (0.08, 0.04)))
    pulls = [9.81 * math.sin(s) for s in PLAIN.slopes]
    loads = [m * 9.81 * math.cos(s) for m, s in zip(PLAIN.masses, PLAIN.slopes, strict=True)]
    mu = (2 / 3, 1.0)
    way = math.copysign(1, mu[0] * pulls[0] - mu[1] * pulls[1])
    forces = [0.08 * loads[0] * way, -0.04 * loads[1] * way]
    tension = (sum(pulls) - forces[0] / mu[0] - forces[1] / mu[1]) / (1 / mu[0] + 1 / mu[1])
    figures = scene.answer().figures
    assert figures["friction_forces"] == pytest.approx(forces, rel=1e-14)
    assert figures["tension"] == pytest.approx(tension, rel=1e-14)


coefficient = st.floats(0, 1.2)


@settings(deadline=None, max_examples=12, derandomize=True)
@given(
    slopes=st.tuples(st.floats(0.05, 1.5), st.floats(0.05, 1.5)),
    velocities=st.tuples(st.floats(-3, 3), st.floats(-3, 3)),
    rims=st.tuples(st.floats(-3, 3), st.floats(-3, 3)),
    static=st.tuples(coefficient, coefficient),
    fraction=st.floats(0.5, 1),
)
def test_agrees_with_time_stepping(slopes, velocities, rims, static, fraction) -> None:  # type: ignore[no-untyped-def]
    kinetic = (static[0] * fraction, static[1] * fraction)
    spins = (rims[0] / 0.1, rims[1] / 0.2)
    scene = replace(PLAIN, slopes=slopes, velocities=velocities, spins=spins, friction=Friction(static, kinetic))
    times = np.array([0.1, 0.3, 0.6])
    answer = scene.answer(times)
    assert answer.trajectory is not None
    v, r = time_stepped_shafts(
        scene.masses, scene.radii, (0.5, 0.5), slopes, 9.81, velocities, spins, kinetic, static, times, 1e-3
    )
    near = [phase["start"] for phase in answer.figures["phases"]]
    for i, t in enumerate(times):
        if min(abs(t - start) for start in near) > 0.01:
            assert np.max(np.abs(answer.trajectory["velocities"][i] - v[i])) < 0.02
            assert np.max(np.abs(answer.trajectory["spins"][i] * [0.1, 0.2] - r[i])) < 0.02


@settings(deadline=None, max_examples=draws(60), derandomize=True)
@given(
    velocities=st.tuples(st.floats(-3, 3), st.floats(-3, 3)),
    static=st.tuples(coefficient, coefficient),
    restitution=st.floats(0, 1),
)
def test_energy_never_grows_and_coulomb_s_law_holds(velocities, static, restitution) -> None:  # type: ignore[no-untyped-def]
    friction = Friction(static, (0.7 * static[0], 0.7 * static[1]))
    scene = replace(PLAIN, velocities=velocities, friction=friction, restitution=restitution)
    times = np.linspace(0, 2, 401)
    answer = scene.answer(times)
    assert answer.trajectory is not None
    x, v = answer.trajectory["positions"], answer.trajectory["velocities"]
    rims = answer.trajectory["spins"] * np.array(scene.radii)
    masses, pulls = np.array(scene.masses), 9.81 * np.sin(scene.slopes)
    energy = (masses * (v**2 + 0.5 * rims**2) / 2 - masses * pulls * x).sum(axis=1)
    assert np.max(np.diff(energy)) < 1e-10 * np.max(np.abs(energy))
    slack = (answer.trajectory["unwound"] - x).sum(axis=1) + 1000
    assert np.min(slack) > -1e-10


@pytest.mark.parametrize(
    ("static", "kinetic", "path"),
    [((0.1, 0.1), (0.1, 0.2), ("kinetic", 1)), ((-0.1, 0.1), (0.0, 0.0), ("static", 0))],
)
def test_what_is_no_friction_is_refused(
    static: tuple[float, float], kinetic: tuple[float, float], path: object
) -> None:
    with pytest.raises(InvalidParameter) as refusal:
        Friction(static, kinetic)
    assert refusal.value.path == path
