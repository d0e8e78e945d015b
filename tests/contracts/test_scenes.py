"""Laws that every scene in the catalogue obeys: energy, constraints, forces that balance the motion of the samples."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.quantities import members_of
from core.scenes import Scene
from core.scenes.chain_on_wedge import ChainOnWedge
from core.scenes.rod_in_hole import RodInHole
from core.scenes.unwinding_shafts import UnwindingShafts
from tests.contracts.scene_contracts import (
    Samples,
    columns_of,
    each_output_alone_is_what_it_is_among_all,
    figures_of,
    it_is_a_system,
    samples_depend_on_their_own_time_only,
    samples_of,
    span_of,
    what_makes_no_sense_is_refused,
)
from tests.drawn import draws

slope = st.floats(0.02, math.pi / 2)
size = st.floats(-6, 6).map(lambda power: 10.0**power)
shafts = st.builds(
    UnwindingShafts,
    masses=st.tuples(size, size),
    radii=st.tuples(st.floats(0.01, 1), st.floats(0.01, 1)),
    slopes=st.tuples(slope, slope),
    gravity=st.floats(0.1, 100),
    inertia_factors=st.tuples(st.floats(0.01, 10), st.floats(0.01, 10)),
    positions=st.tuples(st.floats(1, 50), st.floats(1, 50)),
    velocities=st.tuples(st.floats(-3, 3), st.floats(-3, 3)),
    spins=st.tuples(st.floats(-30, 30), st.floats(-30, 30)),
    wound=st.tuples(st.floats(0.1, 50), st.floats(0.1, 50)),
    restitution=st.one_of(st.just(0.0), st.floats(0, 1)),
)
rods = st.builds(
    lambda radius, part, kappa, angle, rate, mass: RodInHole(
        hole_radius=radius,
        length=2 * radius * part,
        mass=mass,
        gravity=9.81,
        inertia_factor=kappa,
        angle=angle * math.acos(part),
        angular_velocity=rate * math.sqrt(9.81 / radius),
    ),
    st.floats(0.1, 10),
    st.floats(0.01, 0.99),
    st.floats(0, 0.25),
    st.floats(-0.99, 0.99),
    st.floats(-1, 1),
    size,
)
chains = st.builds(
    lambda masses, slopes, density, length, part, velocity: ChainOnWedge(
        masses, slopes, 9.81, length, density, part * length, velocity
    ),
    st.tuples(st.floats(0.1, 10), st.floats(0.1, 10)),
    st.tuples(slope, slope),
    st.floats(0, 5),
    st.floats(0.5, 10),
    st.floats(0.05, 0.95),
    st.floats(-2, 2),
)
STRATEGIES: dict[type, Any] = {UnwindingShafts: shafts, RodInHole: rods, ChainOnWedge: chains}
any_scene = st.one_of(*STRATEGIES.values())


def shafts_energy(scene: UnwindingShafts, s: Samples) -> tuple[np.ndarray, np.ndarray]:
    masses, factors = np.array(scene.masses), np.array(scene.inertia_factors)
    rims = s["spins"] * np.array(scene.radii)
    kinetic = (masses * (s["velocities"] ** 2 + factors * rims**2) / 2).sum(axis=1)
    depth = s["positions"] * np.sin(scene.slopes)
    return kinetic, -(masses * scene.gravity * depth).sum(axis=1)


def rod_energy(scene: RodInHole, s: Samples) -> tuple[np.ndarray, np.ndarray]:
    depth = math.sqrt(scene.hole_radius**2 - scene.length**2 / 4)
    x, y = depth * np.sin(s["angle"]), -depth * np.cos(s["angle"])
    centre = depth * s["angular_velocity"]
    moment = scene.inertia_factor * scene.mass * scene.length**2
    kinetic = scene.mass * centre**2 / 2 + moment * s["angular_velocity"] ** 2 / 2
    assert x.shape == y.shape
    return kinetic, scene.mass * scene.gravity * y


def chain_energy(scene: ChainOnWedge, s: Samples) -> tuple[np.ndarray, np.ndarray]:
    x, g, rho = s["position"], scene.gravity, scene.linear_density
    y = scene.length - x
    (m1, m2), (a, b) = scene.masses, np.sin(scene.slopes)
    kinetic = (m1 + m2 + rho * scene.length) * s["velocity"] ** 2 / 2
    return kinetic, -g * (m1 * x * a + m2 * y * b + rho * (x * x * a + y * y * b) / 2)


ENERGY: dict[type, Callable[[Any, Samples], tuple[np.ndarray, np.ndarray]]] = {
    UnwindingShafts: shafts_energy,
    RodInHole: rod_energy,
    ChainOnWedge: chain_energy,
}


def shafts_balance(scene: UnwindingShafts, s: Samples, change: Samples, h: float) -> list[tuple[Any, Any]]:
    masses, radii = np.array(scene.masses), np.array(scene.radii)
    pull = masses * scene.gravity * np.sin(scene.slopes)
    torque = np.array(scene.inertia_factors) * masses * radii**2 * change["spins"]
    tension = s["tension"][:, None]
    return [(masses * change["velocities"], pull - tension), (torque, radii * tension)]


def rod_balance(scene: RodInHole, s: Samples, change: Samples, h: float) -> list[tuple[Any, Any]]:
    """Newton for the centre and Euler about it, with the wall's forces along the radii through the ends."""
    half, radius = scene.length / 2, scene.hole_radius
    depth = math.sqrt(radius**2 - half**2)
    psi, w, alpha = s["angle"], s["angular_velocity"], change["angular_velocity"]
    outward = np.stack((np.sin(psi), -np.cos(psi)), axis=1)
    along = np.stack((np.cos(psi), np.sin(psi)), axis=1)
    acceleration = depth * (alpha[:, None] * along - (w**2)[:, None] * outward)
    ends = [depth * outward - half * along, depth * outward + half * along]
    forces = [-s["forces"][:, [j]] * ends[j] / radius for j in (0, 1)]
    weight = np.array([0.0, -scene.mass * scene.gravity])
    arms = [-half * along, half * along]
    torque = sum(arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0] for arm, force in zip(arms, forces, strict=True))
    moment = scene.inertia_factor * scene.mass * scene.length**2
    return [(scene.mass * acceleration, forces[0] + forces[1] + weight), (moment * alpha, torque)]


def chain_balance(scene: ChainOnWedge, s: Samples, change: Samples, h: float) -> list[tuple[Any, Any]]:
    g, rho, x, acceleration = scene.gravity, scene.linear_density, s["position"], change["velocity"]
    left, right = scene.masses[0] + rho * x, scene.masses[1] + rho * (scene.length - x)
    a, b = np.sin(scene.slopes)
    return [
        (left * acceleration, left * g * a - s["apex_tension"]),
        (-right * acceleration, right * g * b - s["apex_tension"]),
    ]


BALANCE: dict[type, Callable[[Any, Samples, Samples, float], list[tuple[Any, Any]]]] = {
    UnwindingShafts: shafts_balance,
    RodInHole: rod_balance,
    ChainOnWedge: chain_balance,
}


def test_every_scene_of_the_catalogue_is_under_contract() -> None:
    assert set(members_of(Scene)) == set(STRATEGIES) == set(ENERGY) == set(BALANCE)
    kinds = [member.kind for member in members_of(Scene)]  # type: ignore[attr-defined]
    assert kinds == ["unwinding-shafts", "rod-in-hole", "chain-on-wedge"]


@settings(deadline=None, max_examples=draws(60), derandomize=True)
@given(scene=any_scene)
def test_energy_is_conserved_but_for_the_stated_cost_of_jerks(scene: Any) -> None:
    answer = scene.answer(np.linspace(0, span_of(scene), 33))
    s = columns_of(answer)
    kinetic, potential = ENERGY[type(scene)](scene, s)
    # A velocity near the smallest double has an energy below it, which is left out.
    given_energy = {name: value or 0.0 for name, value in answer.figures["energy"].items()}
    scale = np.max(np.abs(kinetic) + np.abs(potential)) + abs(given_energy["kinetic"]) + abs(given_energy["potential"])
    lost = given_energy["total"] - (kinetic + potential)
    least, most = np.zeros(lost.size), np.zeros(lost.size)
    for phase in answer.figures.get("phases", []):
        cost = phase["dissipated"]
        most[s["time"] >= phase["start"]] += cost
        # Jerks go on inside a phase of several: there the loss has come some of its way.
        whole = phase["start"] if phase["jerks"] in (0, 1) else phase["end"]
        least[s["time"] >= (math.inf if whole is None else whole)] += cost
    assert np.all(lost >= least - 1e-11 * scale)
    assert np.all(lost <= most + 1e-11 * scale)


@settings(deadline=None, max_examples=draws(90), derandomize=True)
@given(scene=any_scene)
def test_forces_balance_the_motion_of_the_samples(scene: Any) -> None:
    """Newton-Euler with derivatives by differences of the samples: nothing of the scene's own formulas enters."""
    span = span_of(scene)
    assume(span > 1e-6)
    h = span * 2e-4
    middles = np.linspace(0.1, 0.9, 5) * span
    stencil = np.concatenate([middles + k * h for k in (-2, -1, 0, 1, 2)])
    answer = scene.answer(stencil, accuracy=1e-8)
    s = {name: column.reshape(5, 5, *column.shape[1:]) for name, column in columns_of(answer).items()}
    jerky = [phase["start"] for phase in answer.figures.get("phases", [])]
    jerky += [phase["end"] for phase in answer.figures.get("phases", []) if phase["end"] is not None]
    if any(phase["jerks"] != 0 for phase in answer.figures.get("phases", [])[:1]):
        assume(answer.figures["phases"][0]["kind"] == "taut")
    clear = np.array([all(abs(t - j) > 3 * h for j in jerky) for t in middles])
    inside = np.array(
        [
            any(
                p["start"] <= t and (p["end"] is None or t <= p["end"]) and p["jerks"] in (0, 1)
                for p in answer.figures.get("phases", [{"start": 0.0, "end": None, "jerks": 0}])
            )
            for t in middles
        ]
    )
    keep = clear & inside
    centre = {name: column[2][keep] for name, column in s.items()}
    change = {
        name: ((column[0] - column[4]) + 8 * (column[3] - column[1]))[keep] / (12 * h)
        for name, column in s.items()
        if name in ("velocities", "spins", "angular_velocity", "velocity")
    }
    for left, right in BALANCE[type(scene)](scene, centre, change, h):
        terms = np.maximum(np.abs(left), np.abs(right))
        weight = scene.gravity * (scene.mass if isinstance(scene, RodInHole) else max(scene.masses))
        speeds = max(np.max(np.abs(s[n])) for n in ("velocities", "spins", "angular_velocity", "velocity") if n in s)
        rough = 1e-9 * (np.max(terms, initial=0) + weight) + weight * speeds * 1e-12 / h
        assert np.max(np.abs(left - right), initial=0) <= rough


@settings(deadline=None, max_examples=draws(60), derandomize=True)
@given(scene=any_scene)
def test_constraints_hold_and_positions_are_the_integrals_of_velocities(scene: Any) -> None:
    s = samples_of(scene, np.linspace(0, span_of(scene), 41))
    if isinstance(scene, UnwindingShafts):
        slack = (s["unwound"] - s["positions"]).sum(axis=1) + sum(scene.positions or ())
        scale = np.max(np.abs(s["positions"])) + np.max(np.abs(s["unwound"]))
        assert np.min(slack) > -1e-12 * scale, "a string does not stretch"
        taut = s["tension"] > 0
        closing = (s["velocities"] - s["spins"] * np.array(scene.radii)).sum(axis=1)
        speeds = np.max(np.abs(s["velocities"])) + np.max(np.abs(s["spins"] * np.array(scene.radii)))
        assert np.max(np.abs(closing[taut]), initial=0) < 1e-11 * speeds
        assert np.all(s["positions"] >= -1e-12 * scale)
        assert np.all(s["unwound"] <= np.array(scene.wound) + 1e-12 * scale)
        assert np.all(s["tension"] >= 0)
    elif isinstance(scene, RodInHole):
        rim = math.acos(scene.length / (2 * scene.hole_radius))
        assert np.max(np.abs(s["angle"])) <= rim * (1 + 1e-12)
        assert np.min(s["forces"]) >= -1e-9 * np.max(s["forces"])
    else:
        assert np.all((s["position"] >= -1e-12 * scene.length) & (s["position"] <= scene.length * (1 + 1e-12)))
        spare = s["apex_tension"] - scene.linear_density * s["velocity"] ** 2
        if span_of(scene) > 0:
            assert np.min(spare) >= -1e-9 * np.max(s["apex_tension"])
        else:
            # The given state is the end: the chain is already too fast for the apex to hold it, or at its end.
            assert np.max(spare) <= 0 or s["position"][0] in (0.0, scene.length)


@settings(deadline=None, max_examples=draws(40), derandomize=True)
@given(scene=any_scene, data=st.data())
def test_each_output_alone_is_what_it_is_among_all(scene: Any, data: Any) -> None:
    each_output_alone_is_what_it_is_among_all(scene, data.draw(st.sampled_from(figures_of(scene))))


@settings(deadline=None, max_examples=draws(40), derandomize=True)
@given(scene=any_scene)
def test_samples_depend_on_their_own_time_only_and_come_in_the_order_requested(scene: Any) -> None:
    assume(span_of(scene) > 0)
    samples_depend_on_their_own_time_only(scene)


@pytest.mark.parametrize("member", members_of(Scene), ids=lambda member: member.kind)
def test_every_scene_is_a_system(member: type) -> None:
    it_is_a_system(EXAMPLES[member])


@pytest.mark.parametrize("member", members_of(Scene), ids=lambda member: member.kind)
def test_questions_that_make_no_sense_are_refused(member: type) -> None:
    what_makes_no_sense_is_refused(EXAMPLES[member])


EXAMPLES: dict[type, Any] = {
    UnwindingShafts: UnwindingShafts((1.0, 2.0), (0.1, 0.1), (0.5, 0.7), 9.81, positions=(5.0, 5.0)),
    RodInHole: RodInHole(1.0, 1.0, 1.0, 9.81),
    ChainOnWedge: ChainOnWedge((1.0, 2.0), (0.5, 0.6), 9.81, 3.0, 0.5, 1.0),
}
