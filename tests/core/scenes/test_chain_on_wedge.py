"""A heavy chain on a wedge: hyperbola, apex tension, lift-off, ends running out, Atwood's limit."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from core.certified.scenes import certified_scene, exact_scene
from core.errors import InvalidParameter
from core.scenes import chain_motion
from core.scenes.chain_on_wedge import ChainOnWedge
from tests.core.scenes.oracles import chain_state, relative
from tests.drawn import draws

PLAIN = ChainOnWedge(masses=(1.0, 2.0), slopes=(0.5, 0.6), gravity=9.81, length=3.0, linear_density=0.7, position=1.0)


def arguments(scene: ChainOnWedge) -> tuple[object, ...]:
    return (
        scene.masses,
        scene.slopes,
        scene.gravity,
        scene.length,
        scene.linear_density,
        scene.position,
        scene.velocity,
    )


@settings(deadline=None, max_examples=draws(80), derandomize=True)
@given(
    masses=st.tuples(st.floats(0, 5), st.floats(0, 5)),
    slopes=st.tuples(st.floats(0, math.pi / 2), st.floats(0, math.pi / 2)),
    density=st.one_of(st.just(0.0), st.floats(-100, 2).map(lambda p: 10.0**p)),
    part=st.floats(0.02, 0.98),
    velocity=st.one_of(st.just(0.0), st.floats(-3, 3)),
    scale=st.floats(-90, 90),
)
def test_samples_agree_with_the_hyperbola_in_many_digits(masses, slopes, density, part, velocity, scale) -> None:  # type: ignore[no-untyped-def]
    assume(sum(masses) > 1e-3)
    unit = 10.0**scale
    scene = ChainOnWedge(
        masses=masses,
        slopes=slopes,
        gravity=9.81 * unit,
        length=3.0 * unit,
        linear_density=density / unit,
        position=3.0 * unit * part,
        velocity=velocity * unit,
    )
    end = scene.answer(outputs=frozenset({"events"})).figures["events"]
    last = end[0]["time"] if end else 5.0
    assume(last > 0)
    times = np.array([0.0, 0.11, 0.5, 0.93, 1.0]) * min(last, 20.0) * (1 - 1e-15)
    answer = scene.answer(times)
    assert answer.trajectory is not None
    states = [chain_state(*arguments(scene), float(t)) for t in times]  # type: ignore[arg-type]
    for j, name in enumerate(("position", "velocity", "apex_tension")):
        true = [state[j] for state in states]
        largest = max(abs(value) for value in true)
        if name not in answer.trajectory.columns:
            assert largest < 1e-280
            continue
        if largest < 1e-60 * scene.gravity * last:
            # Exact balance, which the other computation misses by its last digit.
            assert np.max(np.abs(answer.trajectory[name])) <= 1e-60 * scene.gravity * last
            continue
        worst = max(abs(mp.mpf(float(f)) - t) for f, t in zip(answer.trajectory[name], true, strict=True))
        assert worst <= 1e-13 * largest, name
        assert worst <= answer.accuracy.error * largest, "the stated error is never below the true one"


@settings(deadline=None, max_examples=draws(80), derandomize=True)
@given(
    masses=st.tuples(st.floats(0, 5), st.floats(0, 5)),
    slopes=st.tuples(st.floats(0.01, math.pi / 2), st.floats(0.01, math.pi / 2)),
    density=st.one_of(st.just(0.0), st.floats(0.01, 10)),
    part=st.floats(0.02, 0.98),
    velocity=st.floats(-6, 6),
)
def test_the_end_is_found_by_integration_too(masses, slopes, density, part, velocity) -> None:  # type: ignore[no-untyped-def]
    assume(sum(masses) > 0.1)
    scene = ChainOnWedge(masses, slopes, 9.81, 3.0, density, 3.0 * part, velocity)
    a, b = 9.81 * np.sin(slopes)
    total = sum(masses) + 3.0 * density

    def pull(x: float) -> float:
        return ((masses[0] + density * x) * a - (masses[1] + density * (3.0 - x)) * b) / total

    def apex(_: float, s: np.ndarray) -> float:
        return float(s[0])

    def other(_: float, s: np.ndarray) -> float:
        return float(3.0 - s[0])

    def grip(_: float, s: np.ndarray) -> float:
        # From the balance of side 1 alone: T = (M1 + rho x)(A - x'').
        return float((masses[0] + density * s[0]) * (a - pull(s[0])) - density * s[1] ** 2) + (0.0 if density else 1.0)

    functions = (apex, other, grip)
    for function in functions:
        function.terminal, function.direction = True, -1  # type: ignore[attr-defined]
    answer = scene.answer(outputs=frozenset({"events", "lift_off"}))
    if grip(0.0, np.array([3.0 * part, velocity])) < -1e-9:
        assert answer.figures["lift_off"] == {"occurs": True, "time": 0.0, "error": 0.0}
        return
    assume(abs(grip(0.0, np.array([3.0 * part, velocity]))) > 1e-6)
    solved = solve_ivp(
        lambda _, s: [s[1], pull(s[0])],
        (0.0, 30.0),
        [3.0 * part, velocity],
        events=functions,
        rtol=1e-11,
        atol=1e-12,
        method="DOP853",
        # A longer step may pass an end and come back without an event.
        max_step=0.05,
    )
    reached = [
        (times[0], name)
        for times, name in zip(solved.t_events, ("mass-1-at-apex", "mass-2-at-apex", "lift-off"), strict=True)
        if times.size
    ]
    if not answer.figures["events"]:
        assert not reached
        return
    event = answer.figures["events"][0]
    if event["time"] is None:
        assert [warning.code for warning in answer.warnings] == ["outside-double-range"]
    elif event["time"] < 25:
        time, kind = min(reached)
        assert event["time"] == pytest.approx(time, abs=1e-6)
        both = [t for t, _ in reached]
        assert event["kind"] == kind or len(both) > 1
    assert answer.figures["lift_off"]["occurs"] == (event["kind"] == "lift-off")


def test_without_density_it_is_atwood_s_machine_on_a_wedge() -> None:
    g, (m1, m2), (a, b) = 9.81, PLAIN.masses, np.sin(PLAIN.slopes)
    for density, within in ((0.0, 1e-15), (1e-20, 1e-14), (1e-100, 1e-15), (1e-300, 1e-15)):
        answer = replace(PLAIN, linear_density=density).answer(np.array([0.3]))
        assert answer.figures["apex_tension"] == pytest.approx(g * (a + b) * m1 * m2 / (m1 + m2), rel=within)
        acceleration = g * (m1 * a - m2 * b) / (m1 + m2)
        assert answer.figures["acceleration"] == pytest.approx(acceleration, rel=1e-14)
        assert answer.trajectory is not None
        assert answer.trajectory["position"] == pytest.approx([1 + acceleration * 0.045], rel=1e-15)
        assert answer.figures["lift_off"]["occurs"] is False


def test_equilibrium_stays_and_its_neighbours_leave_to_their_sides() -> None:
    even = ChainOnWedge((1.0, 1.0), (0.5, 0.5), 9.81, 2.0, 0.5, 1.0)
    answer = even.answer(np.array([0.0, 1e9]))
    assert answer.model.degrees_of_freedom == 0
    assert answer.ended == "horizon"
    assert answer.trajectory is not None
    assert np.array_equal(answer.trajectory["position"], [1.0, 1.0])
    for x, kind in ((1 - 1e-12, "mass-1-at-apex"), (1 + 1e-12, "mass-2-at-apex")):
        event = replace(even, position=x).answer().figures["events"][0]
        assert event["kind"] in (kind, "lift-off")
        with mp.workdps(60):
            k = mp.sqrt(mp.mpf(0.5) * mp.mpf(9.81) * 2 * mp.sin(mp.mpf(0.5)) / 3)
            # Where T = rho v^2, or the end, whichever comes first, and the time there by the inverse of cosh.
            d0 = abs(mp.mpf(x) - 1)
            gone = min(mp.sqrt(2 * (mp.mpf(2.25) + d0 * d0 / 4)), mp.mpf(1))
            true = mp.acosh(gone / d0) / k
        assert relative(event["time"], true) < 1e-13


def test_motion_on_the_stable_branch_decays_and_does_not_blow_up() -> None:
    even = ChainOnWedge((1.0, 1.0), (math.pi / 6, math.pi / 6), 4.0, 2.0, 0.5, 1.25)
    k = even.answer(outputs=frozenset({"growth_rate"})).figures["growth_rate"]
    scene = replace(even, velocity=-0.25 * k)
    times = np.linspace(0, 30, 61)
    answer = scene.answer(times)
    assert answer.trajectory is not None
    for i, t in enumerate(answer.trajectory["time"]):
        x, v, _ = chain_state(*arguments(scene), float(t))  # type: ignore[arg-type]
        assert abs(float(x - mp.mpf(answer.trajectory["position"][i]))) < 1e-14
        assert abs(float(v - mp.mpf(answer.trajectory["velocity"][i]))) < 1e-14


def test_the_past_is_the_mirror_of_the_future() -> None:
    forth, back = replace(PLAIN, velocity=1.0), replace(PLAIN, velocity=-1.0)
    times = np.linspace(0, 0.3, 4)
    one, two = forth.answer(times).trajectory, back.answer(-times).trajectory
    assert one is not None
    assert two is not None
    assert one["position"] == pytest.approx(two["position"], rel=1e-15)
    with pytest.raises(InvalidParameter, match="times"):
        back.answer(np.array([-50.0]))


CORNERS = {
    "masses": st.sampled_from([(0.0, 1.0), (1.0, 0.0), (1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (0.0, 0.0)]),
    "slopes": st.tuples(*[st.sampled_from([0.0, 0.5, 1.0, math.pi / 2])] * 2),
    "density": st.sampled_from([0.0, 1.0, 0.1, 1e-60]),
    "velocity": st.sampled_from([0.0, 0.0, 1.0, -1.0]),
    "first": st.booleans(),
}


def corner(masses, slopes, density, velocity, first) -> ChainOnWedge:  # type: ignore[no-untyped-def]
    """Return a chain with one of its ends at the apex."""
    assume(any(masses) or density)
    return ChainOnWedge(masses, slopes, 9.81, 1.5, density, 0.0 if first else 1.5, velocity)


def what_happens_at_once(scene: ChainOnWedge) -> str | None:
    """Return the event at t = 0 of a chain with an end at the apex, from the balance of forces there."""
    way = -1 if scene.position == 0 else 1
    with mp.workdps(300):
        whole = mp.mpf(scene.linear_density) * mp.mpf(scene.length)
        total = sum(scene.masses) + whole
        near, far = (mp.sin(mp.mpf(s)) for s in (scene.slopes if way < 0 else scene.slopes[::-1]))
        own, other = scene.masses if way < 0 else scene.masses[::-1]
        # Of the end at the apex, positive where it comes from there.
        pull = own * near - (other + whole) * far
        tension = mp.mpf(9.81) * (near + far) * own * (other + whole) / total
        if scene.linear_density and scene.linear_density * scene.velocity**2 > tension:
            return "lift-off"
        leaves = scene.velocity * way > 0 or (scene.velocity == 0 and pull < 0)
    return f"mass-{1 if way < 0 else 2}-at-apex" if leaves else None


@settings(deadline=None, max_examples=draws(300), derandomize=True)
@given(**CORNERS)
def test_an_end_at_the_apex_leaves_at_once_or_not_at_all(masses, slopes, density, velocity, first) -> None:  # type: ignore[no-untyped-def]
    scene = corner(masses, slopes, density, velocity, first)
    answer = scene.answer(np.array([0.0, 0.25]))
    expected = what_happens_at_once(scene)
    at_once = [event["kind"] for event in answer.figures["events"] if event["time"] == 0.0]
    assert at_once == ([] if expected is None else [expected])
    assert answer.ended == (expected or answer.ended)
    assert answer.trajectory is not None
    assert answer.trajectory["time"][0] == 0.0, "the given state always exists"
    if not scene.velocity and not answer.figures["acceleration"]:
        assert answer.model.regime == "rest"
        assert answer.ended == "horizon"
        assert answer.trajectory["position"].tolist() == [scene.position] * 2


@settings(deadline=None, max_examples=draws(200), derandomize=True)
@given(**CORNERS)
def test_an_end_at_the_apex_agrees_with_the_certified_answer(masses, slopes, density, velocity, first) -> None:  # type: ignore[no-untyped-def]
    scene = corner(masses, slopes, density, velocity, first)
    times = [0.0, 0.125, 0.25]
    answer = scene.answer(np.array(times))
    parameters = dict(
        zip(
            ("masses", "slopes", "gravity", "length", "linear_density", "position", "velocity"),
            arguments(scene),
            strict=True,
        )
    )
    proven = certified_scene(exact_scene(ChainOnWedge, parameters), 20, times)
    assert proven.model == answer.model
    assert proven.ended == answer.ended
    assert [event["kind"] for event in proven.figures["events"]] == [e["kind"] for e in answer.figures["events"]]
    for sure, event in zip(proven.figures["events"], answer.figures["events"], strict=True):
        assert event["time"] == pytest.approx(float(sure["time"]), rel=1e-15)
    assert answer.trajectory is not None
    assert proven.trajectory is not None
    for name in ("time", *answer.trajectory.columns):
        column = answer.trajectory[name]
        true = [float(value) for value in proven.trajectory[name]]
        largest = max(np.max(np.abs(true), initial=0.0), np.max(np.abs(column), initial=0.0))
        assert np.max(np.abs(column - true)) <= (answer.accuracy.error + 2.0**-53) * largest, name


def test_a_velocity_far_below_the_first_precision_still_ends_the_motion() -> None:
    """Balanced but for 1e-309 m/s: with x' = v e^(kt) the chain takes 709/k to get anywhere."""
    scene = ChainOnWedge((1.0, 1.0), (1.0, 1.0), 9.81, 1.0, 1.0, 0.5, 2.2e-309)
    answer = scene.answer(np.array([0.1, 1.0]))
    assert answer.trajectory is not None
    assert answer.trajectory["position"].tolist() == [0.5, 0.5]
    (event,) = scene.answer(outputs=frozenset({"events"})).figures["events"]
    rate = math.sqrt(2 * 9.81 * math.sin(1.0) / 3)
    assert event["time"] == pytest.approx((math.log(2 * 0.5 * rate) - math.log(2.2e-309)) / rate, rel=1e-9)


def test_a_string_released_with_its_end_at_the_apex_is_over_at_once() -> None:
    scene = ChainOnWedge((1.0, 2.0), (0.5, 0.5), 9.81, 1.0, 0.0, 0.0)
    answer = scene.answer(np.array([0.0, 1.0]))
    assert answer.figures["events"] == [{"kind": "mass-1-at-apex", "time": 0.0, "error": 0.0}]
    assert answer.ended == "mass-1-at-apex"
    assert answer.trajectory is not None
    assert answer.trajectory["position"].tolist() == [0.0]
    assert answer.trajectory["apex_tension"] == pytest.approx([9.81 * 2 * math.sin(0.5) * 2 / 3], rel=1e-15)
    with pytest.raises(InvalidParameter, match="be at least 0 s"):
        scene.answer(np.array([-1.0]))


def test_a_bare_end_at_the_apex_rests_without_tension() -> None:
    scene = ChainOnWedge((2.0, 0.0), (0.0, 1.0), 9.81, 1.0, 1.0, 1.0)
    answer = scene.answer(np.array([0.0, 1.0]))
    assert answer.model.regime == "rest"
    assert answer.trajectory is not None
    assert answer.trajectory["position"].tolist() == [1.0, 1.0]
    assert answer.trajectory["apex_tension"].tolist() == [0.0, 0.0]
    assert answer.accuracy.error < 1e-15


def test_tension_alone_solves_no_motion(monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(*_: object, **__: object) -> None:
        raise AssertionError("this was not asked for")

    monkeypatch.setattr(chain_motion.ChainMotion, "__init__", forbidden)
    assert set(PLAIN.answer(outputs=frozenset({"apex_tension"})).figures) == {"apex_tension"}


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"masses": (0.0, 0.0), "linear_density": 0.0}, ("masses",)),
        ({"masses": (-1.0, 0.0)}, ("masses", 0)),
        ({"position": 3.1}, ("position",)),
        ({"position": -0.1}, ("position",)),
        ({"length": 0.0}, ("length",)),
        ({"slopes": (0.1, 2.0)}, ("slopes", 1)),
        ({"linear_density": math.inf}, ("linear_density",)),
    ],
)
def test_what_is_no_scene_is_refused(change: dict[str, object], path: tuple[str | int, ...]) -> None:
    with pytest.raises(InvalidParameter) as refusal:
        replace(PLAIN, **change)  # type: ignore[arg-type]
    assert refusal.value.path == path
