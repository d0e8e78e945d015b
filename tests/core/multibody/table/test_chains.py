from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from core.errors import InvalidParameter, MechanicsError, NotApplicable
from core.multibody.proven.proven_answer import proven_answer
from core.multibody.solve import solve_scene
from core.multibody.trajectory.occurrences import When
from core.systems.methods import RungeKutta4
from tests.core.multibody.named_judge import chain, random_chain, require_same_chain
from tests.core.multibody.worked_examples import column, force, linear, read

ALL = ("accelerations", "forces", "energy", "trajectory", "forces-in-time", "energy-in-time", "momenta-in-time")
PEG: list[Any] = ["0.3", "0.7"]


def over(*extra: dict[str, Any], **fields: Any) -> dict[str, Any]:
    """Return a chain over a peg beside the origin, one side along a slope of 30 degrees and the other hanging."""
    return {
        "gravity": [0, -9.81],
        "bodies": {
            "a": {"mass": 1, "at": ["0.3 - 1.2*cos(pi/6)", "0.7 - 0.6"], "velocity": ["-0.4*cos(pi/6)", "-0.2"]},
            "b": {"mass": 0.4, "at": [0.3, -0.1], "velocity": [0, 0.4]},
        },
        "connections": [
            {"kind": "chain", "name": "c", "through": ["a", PEG, "b"], "density": 0.9, **fields},
            *extra,
        ],
    }


def hanging(*, masses: tuple[Any, Any] = (1, 1), lengths: tuple[Any, Any] = (1, 1), **fields: Any) -> dict[str, Any]:
    bodies = {name: {"mass": mass, "at": [0, f"-({x})"]} for name, mass, x in zip("ab", masses, lengths, strict=True)}
    link = {"kind": "chain", "name": "c", "through": ["a", [0, 0], "b"], "density": 0.5, **fields}
    return {"gravity": [0, -9.81], "bodies": bodies, "connections": [link]}


def test_the_peg_and_the_faces_carry_what_the_momentum_does_not_gain():
    """The whole of Newton's law in two directions, which the tension at the peg does not enter.

    Along the hanging side nothing but the peg and the face hold the chain. The face pushes across the slope, so that
    along it weights and peg alone change the momentum; by hand |u_1 + u_2|^2/2 of the peg's force is along each side.
    """
    times = np.array([0.0, 0.1, 0.25])
    h = 1e-3
    steps = (-2, -1, 1, 2)
    samples = np.concatenate([times + s * h for s in steps])
    momentum = column(solve_scene(read(over()), samples, ALL), "momentum").values.reshape(4, 3, 2)
    gain = sum(w * p for w, p in zip((1, -8, 8, -1), momentum, strict=True)) / (12 * h)
    answer = solve_scene(read(over()), times, ALL)
    slope = np.array([-np.cos(np.pi / 6), -0.5])
    both = slope + np.array([0.0, -1.0])
    weight = np.array([0.0, -9.81 * (1.4 + 0.9 * 2)])
    peg = -column(answer, "c.normal").values[:, None] * both / np.linalg.norm(both)
    along = (gain - weight - peg) @ slope
    assert np.abs(along).max() <= 1e-9
    # What is left is the push of the face on the mass and on the chain: their weights across the slope.
    lengths = np.linalg.norm(column(answer, "a.position").values - [0.3, 0.7], axis=1)
    face = (gain - weight - peg) @ [-slope[1], slope[0]]
    assert np.abs(np.abs(face) - 9.81 * np.cos(np.pi / 6) * (1 + 0.9 * lengths)).max() <= 1e-9


def test_energy_and_momenta_are_those_of_the_links():
    """Against sums over the links of the chain, by Gauss's rule of two points, which is exact for them."""
    answer = solve_scene(read(over()), [0.0, 0.2], ALL)
    a, v = column(answer, "a.position").values[1], column(answer, "a.velocity").values[1]
    b = column(answer, "b.position").values[1]
    peg, speed = np.array([0.3, 0.7]), np.linalg.norm(v)
    momentum, turning, potential = np.zeros(2), 0.0, 0.0
    for end, sign in ((a, 1), (b, -1)):
        d = end - peg
        rate = sign * speed * d / np.linalg.norm(d)
        for part in (0.5 - np.sqrt(1 / 12), 0.5 + np.sqrt(1 / 12)):
            mass, place = 0.9 * np.linalg.norm(d) / 2, peg + part * d
            momentum += mass * rate
            turning += mass * (place[0] * rate[1] - place[1] * rate[0])
            potential += mass * 9.81 * place[1]
    assert column(answer, "c.momentum").values[1] == pytest.approx(momentum, rel=1e-14)
    assert column(answer, "c.angular_momentum").values[1] == pytest.approx(turning, rel=1e-14)
    potential += 9.81 * (a[1] + 0.4 * b[1])
    assert column(answer, "energy.potential").values[1] == pytest.approx(potential, rel=1e-14)
    kinetic = (1.4 + 0.9 * 2) * speed**2 / 2
    assert column(answer, "energy.kinetic").values[1] == pytest.approx(kinetic, rel=1e-14)
    assert kinetic + potential == pytest.approx(answer.energy.total, rel=1e-14)


def test_gravity_does_the_work_that_the_kinetic_energy_gains():
    answer = solve_scene(read(over()), [0.0, 0.1, 0.25], ("trajectory", "energy-in-time", "work-in-time"))
    kinetic = column(answer, "energy.kinetic").values
    assert column(answer, "gravity.work").values == pytest.approx(kinetic - kinetic[0], abs=1e-14)


@pytest.mark.parametrize("seed", range(12))
def test_described_chains_slide_and_lift_off_as_the_named_ones(seed):
    require_same_chain(random_chain(seed))


def test_the_judge_sees_another_density():
    named = random_chain(5)
    other = chain(named)
    other["connections"][0]["density"] = f"{named.linear_density}*1.000000001"
    with pytest.raises(AssertionError):
        require_same_chain(named, other)


def test_past_and_future_end_where_the_chain_lifts_off():
    """A chain thrown up and falling back: by symmetry of time both ends are alike."""
    scene = hanging(masses=(0, 0), lengths=("0.9", "1.1"))
    answer = solve_scene(read(scene), np.linspace(-3, 3, 31))
    before, after = answer.events
    assert before.kind == after.kind == "lift-off"
    assert before.time == pytest.approx(-after.time, rel=1e-15)
    assert np.abs(answer.trajectory.time).max() < after.time
    assert answer.ended == after


def test_growth_without_bound_hides_no_event():
    """Ten times as long the motion would be e^50 times as large, and far beyond the range of doubles at last."""
    scene = read(hanging(masses=(0, 0), lengths=("0.9", "1.1")))
    first, *later = [solve_scene(scene, [end]).ended for end in (2.0, 20.0, 200.0, 1e9, 1e300)]
    assert first.kind == "lift-off"
    for one in later:
        assert one.kind == "lift-off"
        assert abs(one.time - first.time) <= one.error + first.error


@pytest.mark.parametrize("past", ["0.56", "1e-4", "1e-8"])
def test_an_end_that_comes_to_the_peg_and_would_soon_be_back_ends_the_motion(past):
    """A light chain grows in minutes, and its heavy end turns within a second: a longer question finds it as well.

    By energy, with u = z' and M k^2 = 2 rho g: z = z_eq + (z_0 - z_eq) cosh kt + (u/k) sinh kt, solved for e^(kt).
    """
    with mp.workdps(40):
        rho, first, rest = mpf("1e-5"), mpf(1), mpf(10)
        total = 6 + rho * 11
        k2 = 2 * rho * mpf("9.81") / total
        pull = (mpf("9.81") * (5 + rho * first) - mpf("9.81") * (1 + rho * rest)) / total
        speed = mp.sqrt((2 * pull * first - k2 * first**2) * (1 + mpf(past)))
        k, level = mp.sqrt(k2), first - pull / k2
        ahead, back = (pull / k2 - speed / k) / 2, (pull / k2 + speed / k) / 2
        # ahead e^(kt) + back e^(-kt) + level = 0, the first of two roots.
        root = (-level - mp.sqrt(level**2 - 4 * ahead * back)) / (2 * ahead)
        expected = mp.log(root) / k
        velocity = mp.nstr(speed, 35)
    scene = hanging(masses=(5, 1), lengths=(1, 10), density="1e-5")
    scene["bodies"]["a"]["velocity"], scene["bodies"]["b"]["velocity"] = [0, velocity], [0, f"-{velocity}"]
    for end in (1.0, 30.0, 1000.0):
        ended = solve_scene(read(scene), [end]).ended
        assert (ended.kind, ended.name) == ("end-of-chain", "c.1"), end
        assert abs(mpf(ended.time) - expected) <= ended.error + mpf("1e-15"), (end, ended, expected)


@pytest.mark.parametrize("end", ["a", "b"])
def test_heavy_ends_come_to_the_peg_while_the_chain_is_pressed_on(end):
    heavy = (50, 20) if end == "b" else (20, 50)
    answer = solve_scene(read(hanging(masses=heavy)), [2.0])
    assert (answer.ended.kind, answer.ended.name) == ("end-of-chain", {"a": "c.1", "b": "c.2"}[end])
    with mp.workdps(30):
        rate, pull = mp.sqrt(mpf("9.81") / 71), 30 * mpf("9.81") / 71
        expected = mp.acosh(1 + rate**2 / pull) / rate
    assert abs(mpf(answer.ended.time) - expected) <= answer.ended.error


def test_what_lifts_an_end_makes_the_chain_slack():
    push = {"kind": "force", "place": "a", "force": [0, 20]}
    scene = hanging(masses=(1, 5))
    scene["connections"].append(push)
    answer = solve_scene(read(scene), [1.0])
    assert (answer.ended.kind, answer.ended.name, answer.ended.time) == ("slack", "c.1", 0.0)
    assert any("c.1 would have to push" in said for said in answer.model.noticed)


def test_a_chain_too_fast_for_its_peg_leaves_it_at_once():
    scene = hanging(masses=(0, 0))
    scene["bodies"]["a"]["velocity"] = [0, -5]
    answer = solve_scene(read(scene), [0.0, 1.0])
    assert (answer.ended.kind, answer.ended.name, answer.ended.time) == ("lift-off", "c", 0.0)
    assert list(answer.trajectory.time) == [0.0]
    assert any("lifts off at once" in said for said in answer.model.noticed)
    assert force(answer, "c.normal") == pytest.approx(2 * (0.5 * 9.81 - 0.5 * 25), rel=1e-15)


@pytest.mark.parametrize("slower", [False, True])
@pytest.mark.parametrize("light", ["1/3", "1", "20"])
def test_without_times_too_the_start_is_where_it_lifts_off(light: str, *, slower: bool) -> None:
    """T = rho v^2 is the speed at which the peg is pressed no more; T does not depend on v."""
    bodies = {"a": {"mass": light, "at": [0, -1]}, "b": {"mass": 1.5, "at": [0, -2]}}
    chain = {"kind": "chain", "name": "c", "through": ["a", [0, 0], "b"], "density": 0.8}
    still = solve_scene(read({"gravity": [0, -9.81], "bodies": bodies, "connections": [chain]}), (), ("forces",))
    assert still.forces is not None
    tension = still.forces["c.tension"].value
    assert tension is not None
    speed = math.sqrt(tension / 0.8) * (1 - 1e-6 if slower else 1 + 1e-6)
    moving = {"gravity": [0, -9.81], "bodies": bodies | {"b": bodies["b"] | {"velocity": [0, -speed]}}}
    answer = solve_scene(read(moving | {"connections": [chain]}), (), ("forces",))
    events = [(event.kind, event.name, event.time) for event in answer.events]
    assert events == ([] if slower else [("lift-off", "c", 0.0)])
    assert (answer.ended is None) == slower


def test_a_chain_in_balance_rests_and_its_equilibrium_is_unstable():
    answer = solve_scene(read(hanging()), [100.0], ("forces", "trajectory", "equilibria"))
    assert answer.model.name == "rest"
    assert force(answer, "c.tension") == pytest.approx(1.5 * 9.81, rel=1e-15)
    assert force(answer, "c.normal") == pytest.approx(3 * 9.81, rel=1e-15)
    (equilibrium,) = answer.equilibria
    assert equilibrium.stable is False
    assert equilibrium.modes[0][:2] == (0.0, pytest.approx(np.sqrt(9.81 / 3), rel=1e-12))


def test_equilibria_in_which_the_chain_would_have_lifted_off_or_run_out_are_none():
    assert solve_scene(read(hanging(masses=(1, 3))), (), ("equilibria",)).equilibria == ()


def test_a_spring_at_an_end_makes_the_chain_swing():
    spring = {"kind": "spring", "a": "a", "b": [0, -3], "stiffness": 40, "rest_length": 1.5}
    scene = hanging(masses=(1, 2))
    scene["connections"].append(spring)
    answer = solve_scene(read(scene), [0.5])
    assert answer.model.name == "modes"
    (mode,) = answer.model.apart[0].modes
    assert mode[:2] == (pytest.approx(np.sqrt((40 - 9.81) / 4), rel=1e-14), 0.0)


def test_a_rod_on_a_chain_swings_while_it_slides():
    rod = {"mass": 1, "inertia": 0.1, "at": [0, "-1.3"], "angle": {"degrees": 60}, "places": {"top": ["0.3", 0]}}
    rod["at"] = ["-0.3*cos(pi/3)", "-1 - 0.3*sin(pi/3)"]
    scene = hanging()
    scene["bodies"]["rod"] = rod
    del scene["bodies"]["a"]
    scene["connections"][0]["through"][0] = "rod.top"
    answer = solve_scene(read(scene), np.linspace(0, 0.5, 6), (*ALL, "work-in-time"), 1e-9)
    assert answer.model.degrees_of_freedom == 2
    total = column(answer, "energy.kinetic").values + column(answer, "energy.potential").values
    assert total == pytest.approx(np.full(6, answer.energy.total), rel=1e-13)


def test_a_method_and_a_search_follow_the_chain():
    scene = read(over())
    middle = float(column(solve_scene(scene, [0.0, 0.3], ALL), "c.normal").values.mean())
    answer = solve_scene(scene, [0.3], ("trajectory", When("c.normal", equals=middle, nth=1)))
    (occurrence,) = answer.occurrences
    at = solve_scene(scene, [occurrence.time], ALL)
    assert column(at, "c.normal").values[0] == pytest.approx(middle, rel=1e-14)
    run = solve_scene(scene, [0.3], method=RungeKutta4(step=0.01))
    assert run.trajectory.accuracy.how == "measured against closed form"
    assert 0.0 < column(run, "a.position").error < 1e-8


def test_uncertain_inputs_are_propagated():
    answer = solve_scene(read(over()), [0.3], ALL, input_uncertainty=1e-12)
    assert 0.0 < answer.trajectory.accuracy.inherited < 1e-9


def test_many_digits_are_proven():
    answer = proven_answer(read(hanging(lengths=("0.9", "1.1"))), 40, [Fraction(1)])
    with mp.workdps(60):
        rate = mp.sqrt(mpf("9.81") / 3)
        expected = 1 - mpf("0.1") * mp.cosh(rate)
        assert abs(mpf(answer.columns["a.position"].values[0][1]) + expected) <= mpf(10) ** -39


@pytest.mark.parametrize(
    ("mass", "density", "length"), [("1e-150", "1e-150", "1"), ("1e150", "1e-150", "1"), ("1", "1e-12", "1e6")]
)
def test_extremes(mass, density, length):
    scene = hanging(masses=(f"2*{mass}", mass), lengths=(length, length), density=density)
    answer = solve_scene(read(scene))
    total = mpf(3) * mpf(mass) + 2 * mpf(density) * mpf(length)
    assert linear(answer, "a")[1] == pytest.approx(float(-mpf(mass) * mpf("9.81") / total), rel=1e-14)


def joined(**fields: Any) -> dict[str, Any]:
    return over() | {"connections": [over()["connections"][0] | fields]}


FLOOR = {"kind": "contact", "place": "a", "on": {"at": [0, -5]}}
REFUSED: list[tuple[dict[str, Any], type[MechanicsError], tuple[str | int, ...]]] = [
    (joined(density=0), InvalidParameter, ("connections", 0, "density")),
    (joined(density=-1), InvalidParameter, ("connections", 0, "density")),
    *((joined(density=x), InvalidParameter, ("connections", 0, "density")) for x in ("1e307", "1e-330")),
    (joined(length=0), InvalidParameter, ("connections", 0, "length")),
    (joined(length=3), InvalidParameter, ("connections", 0)),
    (joined(through=["a", "b"]), InvalidParameter, ("connections", 0, "through")),
    (joined(through="ab"), InvalidParameter, ("connections", 0, "through")),
    (joined(through=["a", "b", [0, 0]]), InvalidParameter, ("connections", 0, "through", 1)),
    (joined(through=["a", PEG, [0, 0]]), InvalidParameter, ("connections", 0, "through", 2)),
    (joined(through=[[0, 0], PEG, "a"]), InvalidParameter, ("connections", 0, "through", 0)),
    (joined(through=["a", PEG, "a"]), InvalidParameter, ("connections", 0, "through", 2)),
    (joined(through=["a", [0.3, -0.1], "b"]), InvalidParameter, ("connections", 0, "through", 2)),
    (joined(through=["a", ["(0.6 - 1.2*cos(pi/6))/2", 0], "b"]), InvalidParameter, ("connections", 0, "through")),
    (over(FLOOR), NotApplicable, ("connections", 0)),
    (over({"kind": "spinning-frame", "rate": 1}), NotApplicable, ("connections", 1)),
]


@pytest.mark.parametrize(("scene", "fault", "path"), REFUSED)
def test_chains_that_cannot_be(scene, fault, path):
    with pytest.raises(fault) as caught:
        solve_scene(read(scene))
    assert caught.value.path == path


def test_chains_are_of_the_plane():
    bodies = {"a": {"mass": 1, "at": [0, 0, -1]}, "b": {"mass": 1, "at": [1, 0, 0]}}
    link = {"kind": "chain", "through": ["a", [0, 0, 0], "b"], "density": 1}
    with pytest.raises(InvalidParameter, match="plane"):
        solve_scene(read({"gravity": [0, 0, -9.81], "bodies": bodies, "connections": [link]}))


@pytest.mark.parametrize("aside", ["1e-6", "1e-12", "1e-15", "1e-17"])
def test_a_chain_that_hardly_bends_lifts_off_as_soon(aside):
    """One side hangs, the other stands above the peg and leans by a small angle.

    To first order in time the tension rho (A + B) z (1 - z/L), with A + B = g angle^2/2, meets rho (z'' t)^2, where
    z'' = A z/L + B (z - L)/L = g for B = -g.
    """
    bodies = {"a": {"mass": 0, "at": [0, -0.5]}, "b": {"mass": 0, "at": [aside, 1.5]}}
    link = {"kind": "chain", "name": "c", "through": ["a", [0, 0], "b"], "density": 1.2}
    answer = solve_scene(read({"gravity": [0, -9.81], "bodies": bodies, "connections": [link]}), [0, 1])
    angle = float(aside) / 1.5
    expected = angle * np.sqrt(0.5 * 0.75 / 2 / 9.81)
    (event,) = (event for event in answer.events if event.time >= 0.0)
    assert event.kind == "lift-off"
    assert event.time == pytest.approx(expected, rel=1e-5)


def test_a_track_beside_the_chain_shares_what_is_not_determined():
    track = {"kind": "track", "name": "face", "place": "a", "on": {"at": PEG, "slope": "pi/6"}}
    answer = solve_scene(read(over(track)), [0.2], ALL)
    assert not answer.forces["face.normal"].determined
    plain = solve_scene(read(over()), [0.2], ALL)
    assert force(answer, "c.tension") == pytest.approx(force(plain, "c.tension"), rel=1e-15)
