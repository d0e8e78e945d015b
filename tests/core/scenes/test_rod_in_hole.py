"""A rod in a hole: the pendulum in closed form, the wall's forces, contact, rim, limits."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.errors import AccuracyUnreachable, InvalidParameter
from core.scenes import rod_motion
from core.scenes.rod_in_hole import RodInHole
from tests.core.scenes.oracles import pendulum_angle, relative, rod_with_multipliers
from tests.drawn import draws

UNIT = RodInHole(hole_radius=1.0, length=1.0, mass=1.0, gravity=9.81)
TWELFTH = mp.mpf(1 / 12)


def figures(scene: RodInHole) -> dict[str, object]:
    return dict(scene.answer().figures)


def truth(scene: RodInHole) -> dict[str, mp.mpf]:
    """Return what follows from the parameters at the working precision, the rod released at the rim."""
    a, length, M, g, kappa = (
        mp.mpf(v) for v in (scene.hole_radius, scene.length, scene.mass, scene.gravity, scene.inertia_factor)
    )
    k = mp.sqrt(a * a - length * length / 4)
    inertia = k * k + kappa * length * length
    omega = mp.sqrt(2 * g * k * (1 - length / (2 * a)) / inertia)
    drop = M * a * g * (length / (2 * a)) / k
    lean = M * a * g * kappa * length / inertia * (k / a)
    return {
        "omega": omega,
        "equivalent": inertia / k,
        "period": 4 * mp.ellipk((1 - length / (2 * a)) / 2) * mp.sqrt(inertia / (g * k)),
        "angle": -mp.acos(length / (2 * a)),
        "A": drop / 2 - lean,
        "B": drop / 2 + lean,
    }


@pytest.mark.parametrize(("length", "period"), [(0.5, 7.0061), (1.0, 6.6145), (1.5, 6.3132), (1.9, 7.1416)])
def test_periods_of_the_page(length: float, period: float) -> None:
    assert figures(replace(UNIT, gravity=1.0, length=length))["period"] == pytest.approx(period, abs=5e-5)


def test_the_rate_at_the_horizontal_and_the_source_s_wrong_ones() -> None:
    rate = figures(UNIT)["angular_velocity_at_horizontal"]
    assert rate == pytest.approx(3.1929377, abs=5e-8)
    k, g = math.sqrt(0.75), 9.81
    source = math.sqrt((g / k**2 - 2 * g * (1 - k)) / (1 / 3 + k**2))
    inertia = math.sqrt(2 * g * k * 0.5 / (1 + 1 / 12))
    assert source == pytest.approx(3.1060366, abs=5e-8)
    assert inertia == pytest.approx(2.8003916, abs=5e-8)
    for wrong in (source, inertia):
        assert abs(rate - wrong) > 0.08  # type: ignore[operator]
    # A rod with I = M l^2/3 about its centre is another rod, with another inertia factor.
    assert figures(replace(UNIT, inertia_factor=1 / 3))["angular_velocity_at_horizontal"] == pytest.approx(
        math.sqrt(2 * g * k * 0.5 / (k * k + 1 / 3)), rel=1e-14
    )


lengths = st.one_of(
    st.floats(1e-6, 1.999999), st.floats(-300, -6).map(lambda p: 10.0**p), st.floats(-15, -6).map(lambda p: 2 - 10.0**p)
)
factors = st.one_of(st.sampled_from([0.0, 1 / 12, 1e-300, 1e300, 0.25]), st.floats(0, 1))


@settings(deadline=None, max_examples=draws(50), derandomize=True)
@given(
    length=lengths,
    factor=factors,
    scale=st.floats(-100, 100),
    mass=st.floats(-100, 100),
    gravity=st.floats(-100, 100),
)
def test_figures_are_right_in_every_limit(
    length: float, factor: float, scale: float, mass: float, gravity: float
) -> None:
    radius = 2.0 ** round(scale * 3)
    assume(length * radius > 0.0)
    scene = RodInHole(
        hole_radius=radius, length=length * radius, mass=10.0**mass, gravity=10.0**gravity, inertia_factor=factor
    )
    answer = scene.answer()
    found = answer.figures
    with mp.workdps(700):
        true = truth(scene)
        pairs = [
            (found["equivalent_length"], true["equivalent"]),
            (found["release_angle"], true["angle"]),
            (found["forces_at_release"][0], true["A"]),
            (found["forces_at_release"][1], true["B"]),
        ]
        if found["contact"]["kept"]:
            pairs += [(found["period"], true["period"]), (found["angular_velocity_at_horizontal"], true["omega"])]
        for value, exact in pairs:
            if value is None:
                assert not 1e-307 < abs(exact) < 1e308
            else:
                assert relative(value, exact) <= 2e-16


def test_limits_of_the_length() -> None:
    assert figures(replace(UNIT, length=1e-200))["angular_velocity_at_horizontal"] == pytest.approx(
        math.sqrt(2 * 9.81), rel=1e-15
    )
    short = np.nextafter(2.0, 0)
    rate = figures(replace(UNIT, length=float(short)))["angular_velocity_at_horizontal"]
    gap = 2.0 - short
    assert rate == pytest.approx(math.sqrt(2 * 9.81 * math.sqrt(gap) * gap / 2 / (1 / 3)), rel=1e-14)


def test_forces_at_the_horizontal_and_at_release_as_on_the_page() -> None:
    a, length, k, g = 1.0, 1.0, math.sqrt(0.75), 9.81
    upper, lower = figures(UNIT)["forces_at_release"]  # type: ignore[misc]
    assert upper == pytest.approx(g * length * (8 * a**2 - length**2) / (8 * k * (6 * a**2 - length**2)), rel=1e-14)
    assert lower == pytest.approx(
        g * length * (16 * a**2 - 3 * length**2) / (8 * k * (6 * a**2 - length**2)), rel=1e-14
    )
    quarter = figures(UNIT)["period"] / 4  # type: ignore[operator]
    answer = UNIT.answer(np.array([quarter]))
    assert answer.trajectory is not None
    omega = figures(UNIT)["angular_velocity_at_horizontal"]
    assert abs(answer.trajectory["angle"][0]) < 1e-15
    assert answer.trajectory["forces"][0] == pytest.approx([(a / 2) * (g / k + omega**2)] * 2, rel=1e-14)  # type: ignore[operator]


CASES = [
    {},
    {"length": 0.3},
    {"length": 1.9},
    {"inertia_factor": 0.25},
    {"inertia_factor": 0.02, "mass": 3.0},
    {"angle": 0.4, "angular_velocity": -1.0},
    {"angle": 0.3, "angular_velocity": 8.5, "hole": "cylinder"},
    {"angle": -2.0, "angular_velocity": -9.0, "hole": "cylinder"},
]


@pytest.mark.parametrize("change", CASES)
def test_agrees_with_a_rod_free_in_its_plane_held_by_multipliers(change: dict[str, object]) -> None:
    scene = replace(UNIT, **change)  # type: ignore[arg-type]
    times = np.linspace(0.0, 3.0, 31)
    answer = scene.answer(times)
    assert answer.trajectory is not None
    assert answer.ended == "horizon"
    start = answer.figures["release_angle"]
    other = rod_with_multipliers(
        scene.hole_radius,
        scene.length,
        scene.mass,
        scene.gravity,
        scene.inertia_factor,
        start,
        scene.angular_velocity,
        times,
    )
    for name in ("angle", "angular_velocity", "forces"):
        scale = np.max(np.abs(other[name]))
        assert np.max(np.abs(answer.trajectory[name] - other[name])) < 1e-8 * scale, name


@pytest.mark.parametrize(
    ("angle", "rate"),
    [
        (None, 0.0),
        (0.3, 0.7),
        (-1e-9, 0.0),
        (1e-200, 1e-200),
        (3.1, 0.0),
        (math.pi, 0.0),
        (0.0, 6.385875),
        (0.2, -20.0),
        (-2.5, 1e4),
    ],
)
def test_samples_agree_with_a_taylor_series_in_50_digits(angle: float | None, rate: float) -> None:
    scene = replace(UNIT, angle=angle, angular_velocity=rate, hole="cylinder", inertia_factor=0.0)
    times = np.array([0.0, 0.013, 0.4, 1.1, 2.9]) * (1e-3 if rate == 1e4 else 1.0)
    with mp.workdps(50):
        depth = mp.sqrt(mp.mpf(3)) / 2
        frequency = mp.sqrt(mp.mpf(9.81) / depth)
        start = mp.mpf(angle) if angle is not None else -mp.acos(mp.mpf(1) / 2)
    # The pendulum is compared for as long as the closed form goes, contact or not.
    from core.balls import precision
    from core.scenes.enclosure import BITS

    with precision(BITS):
        _, _, found_rate, found = scene._pendulum.sample(times)
        largest = abs(float(scene._pendulum.frequency * scene._pendulum.m.sqrt())) * 2
    for i, t in enumerate(times):
        with mp.workdps(50):
            psi, w = pendulum_angle(frequency, start, mp.mpf(rate), mp.mpf(float(t)))
        assert abs(float(psi - mp.mpf(found[i]))) <= 2e-15 * max(abs(float(psi)), abs(float(start))), t
        assert abs(float(w - mp.mpf(found_rate[i]))) <= 2e-15 * largest, t


def test_the_phase_is_right_after_a_billion_swings() -> None:
    period = figures(UNIT)["period"]
    time = 1e9 * period  # type: ignore[operator]
    answer = UNIT.answer(np.array([time, -time]))
    assert answer.trajectory is not None
    with mp.workdps(60):
        true = truth(UNIT)
        rest = mp.mpf(time) - mp.nint(mp.mpf(time) / true["period"]) * true["period"]
        frequency = mp.sqrt(mp.mpf(9.81) / true["equivalent"])
        psi, rate = pendulum_angle(frequency, true["angle"], mp.mpf(0), rest)
        assert abs(float(psi - mp.mpf(answer.trajectory["angle"][0]))) < 1e-15
        assert abs(float(rate - mp.mpf(answer.trajectory["angular_velocity"][0]))) < 4e-15
    assert answer.trajectory["angle"][0] == answer.trajectory["angle"][1]
    with pytest.raises(AccuracyUnreachable):
        UNIT.answer(np.array([1e20]))


def test_the_exact_separatrix_is_recognised() -> None:
    # a = 5, l = 6, no moment about the centre, g = 4: k = 4 and w0 = 1 exactly, so that rate 2 at the bottom is it.
    scene = RodInHole(
        hole_radius=5.0,
        length=6.0,
        mass=1.0,
        gravity=4.0,
        inertia_factor=0.0,
        angle=0.0,
        angular_velocity=2.0,
        hole="cylinder",
    )
    answer = scene.answer(np.array([0.5, 1.0]))
    assert answer.model.regime == "separatrix"
    assert answer.figures["period"] is None
    assert answer.trajectory is not None
    assert answer.trajectory["angular_velocity"] == pytest.approx(2 / np.cosh([0.5, 1.0]), rel=1e-15)
    assert answer.ended == "horizon"
    assert scene.answer(np.array([9.0])).ended == "end-b-leaves-wall"
    for rate, regime in ((np.nextafter(2.0, 0), "libration"), (np.nextafter(2.0, 3), "rotation")):
        near = replace(scene, angular_velocity=float(rate)).answer(np.array([0.5, 1.0]))
        assert near.model.regime == regime
        assert near.trajectory is not None
        assert near.trajectory["angle"] == pytest.approx(answer.trajectory["angle"], rel=3e-15)


def test_rest_at_the_bottom() -> None:
    answer = replace(UNIT, angle=0.0).answer(np.array([0.0, 1e300]))
    assert answer.model.degrees_of_freedom == 0
    assert answer.figures["period"] is None
    assert answer.figures["angular_velocity_at_horizontal"] == 0.0
    assert answer.trajectory is not None
    assert answer.trajectory["forces"] == pytest.approx(np.full((2, 2), 9.81 / 2 / math.sqrt(0.75)), rel=1e-15)


@pytest.mark.parametrize("length", [1e-6, 0.1, 0.9, 1.7, 1.999999])
def test_contact_is_maintained_when_released_at_the_rim(length: float) -> None:
    contact = figures(replace(UNIT, length=length))["contact"]
    assert contact["kept"]  # type: ignore[index]
    assert contact["limit_angle"] == pytest.approx(  # type: ignore[index]
        math.atan((6 - length**2) / (math.sqrt(1 - length**2 / 4) * length)), rel=1e-12
    )


def test_contact_limits_from_both_sides() -> None:
    closed = replace(UNIT, hole="cylinder")
    contact = figures(closed)["contact"]
    limit, rate = contact["limit_angle"], contact["full_turn_rate"]  # type: ignore[index]
    k, q, p = math.sqrt(0.75), 12 * 0.75 / 5, math.sqrt(0.75) / 5
    assert rate == pytest.approx(math.sqrt(9.81 / k * (q + math.hypot(1 + q, p))), rel=1e-14)
    for factor, kept in ((1 - 1e-9, True), (1 + 1e-9, False)):
        released = replace(closed, angle=limit * factor).answer()
        assert released.figures["contact"]["kept"] is kept
        turned = replace(closed, angle=0.0, angular_velocity=rate / factor).answer()
        assert turned.figures["contact"]["kept"] is kept
    assert replace(closed, angle=limit * (1 + 1e-9)).answer().figures["events"][0] == {
        "kind": "end-b-leaves-wall",
        "time": 0.0,
        "error": 0.0,
    }


@pytest.mark.parametrize("factor", [0.3, 0.5, 1.0, 100.0])
def test_heavy_ends_beyond_a_rod_s_reach_can_lose_contact_at_the_rim(factor: float) -> None:
    scene = replace(UNIT, inertia_factor=factor)
    answer = scene.answer()
    # tan psi_c = 2k/l <= rho^2/(2 kappa k l) written out.
    k2 = 0.75
    assert answer.figures["contact"]["kept"] is (k2 * (4 * factor - 1) <= factor)
    assert min(answer.figures["forces_at_release"]) >= 0 or not answer.figures["contact"]["kept"]


@pytest.mark.parametrize(
    ("hole", "rate"),
    [("half-cylinder", r) for r in (3.3, 5.5, -6.8)] + [("cylinder", r) for r in (4.5, 5.5, 6.4, 7.0, -6.8)],
)
def test_the_motion_ends_where_the_force_or_the_height_says(hole: str, rate: float) -> None:
    scene = replace(UNIT, angle=0.2, angular_velocity=rate, hole=hole)  # type: ignore[arg-type]
    answer = scene.answer()
    times = np.linspace(0.0, 3.0, 3_001)
    other = rod_with_multipliers(1.0, 1.0, 1.0, 9.81, 1 / 12, 0.2, rate, times)
    lost = np.min(other["forces"], axis=1) < 0
    if hole == "half-cylinder":
        lost |= np.abs(other["angle"]) > math.acos(0.5)
    event = answer.figures["events"][0]
    assert event["time"] == pytest.approx(times[np.argmax(lost)], abs=1.01e-3)
    end = "b" if other["angle"][np.argmax(lost)] > 0 else "a"
    assert event["kind"] == f"end-{end}-" + ("passes-rim" if hole == "half-cylinder" else "leaves-wall")
    assert answer.figures["period"] is None
    samples = scene.answer(times)
    assert samples.trajectory is not None
    assert samples.trajectory["time"].size == np.argmax(lost)
    assert samples.ended == event["kind"]
    assert np.min(samples.trajectory["forces"]) >= 0


def test_a_start_above_held_by_speed_comes_down_and_falls_off() -> None:
    # Fast enough to be pressed to the top, too slow for the sides: between the two limits there is a gap to find.
    contact = figures(replace(UNIT, hole="cylinder"))["contact"]
    scene = replace(UNIT, hole="cylinder", angle=3.13, angular_velocity=0.0)
    with np.errstate(all="raise"):
        found = None
        for bottom in np.linspace(0.98, 0.99999, 60) * contact["full_turn_rate"]:  # type: ignore[index]
            k = math.sqrt(0.75)
            square = bottom**2 - 2 * 9.81 * k / (1 - 1 / 6) * (1 - math.cos(3.13))
            trial = replace(scene, angular_velocity=math.sqrt(square))
            event = trial.answer().figures["events"][0]
            if event["time"] > 0:
                found = (trial, event)
    assert found is not None
    trial, event = found
    times = np.linspace(0.0, 1.5, 3_001)
    other = rod_with_multipliers(1.0, 1.0, 1.0, 9.81, 1 / 12, 3.13, trial.angular_velocity, times)
    lost = np.min(other["forces"], axis=1) < 0
    assert event["time"] == pytest.approx(times[np.argmax(lost)], abs=1e-3)
    assert event["kind"] == "end-a-leaves-wall"


def test_the_past_is_the_mirror_of_the_future_and_ends_too() -> None:
    scene = replace(UNIT, angle=0.2, angular_velocity=4.0)
    mirrored = replace(scene, angular_velocity=-4.0)
    end = mirrored.answer().figures["events"][0]["time"]
    times = np.linspace(0.0, end * 0.999, 7)
    back, forth = scene.answer(-times).trajectory, mirrored.answer(times).trajectory
    assert back is not None
    assert forth is not None
    assert np.array_equal(back["angle"], forth["angle"])
    assert np.allclose(back["angular_velocity"], -forth["angular_velocity"], rtol=0, atol=1e-14)
    with pytest.raises(InvalidParameter, match="times"):
        scene.answer(np.array([-end * 1.001]))


def test_full_turns_go_on_counting() -> None:
    scene = replace(UNIT, angle=0.1, angular_velocity=-9.0, hole="cylinder")
    period = scene.answer().figures["period"]
    answer = scene.answer(np.arange(20) * period)
    assert answer.trajectory is not None
    assert answer.trajectory["angle"] == pytest.approx(0.1 - 2 * math.pi * np.arange(20), abs=1e-13)
    assert answer.trajectory["angular_velocity"] == pytest.approx(np.full(20, -9.0), rel=1e-13)


def test_a_question_about_one_instant_solves_no_motion(monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(*_: object, **__: object) -> None:
        raise AssertionError("this was not asked for")

    monkeypatch.setattr(rod_motion.RodMotion, "__init__", forbidden)
    answer = UNIT.answer(outputs=frozenset({"equivalent_length", "forces_at_release"}))
    assert answer.model.degrees_of_freedom == 0
    assert set(answer.figures) == {"equivalent_length", "forces_at_release"}


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"length": 2.0}, ("length",)),
        ({"length": 0.0}, ("length",)),
        ({"hole_radius": math.inf}, ("hole_radius",)),
        ({"mass": -1.0}, ("mass",)),
        ({"gravity": 0.0}, ("gravity",)),
        ({"angle": 1.05}, ("angle",)),
        ({"angle": 3.2, "hole": "cylinder"}, ("angle",)),
        ({"inertia_factor": -1e-9}, ("inertia_factor",)),
        ({"hole": "square"}, ("hole",)),
    ],
)
def test_what_is_no_scene_is_refused(change: dict[str, object], path: tuple[str, ...]) -> None:
    with pytest.raises(InvalidParameter) as refusal:
        replace(UNIT, **change)  # type: ignore[arg-type]
    assert refusal.value.path == path


def test_the_rim_s_angle_as_a_double_means_the_rim() -> None:
    angle = math.acos(0.5)
    for near in (np.nextafter(angle, 0), angle, np.nextafter(angle, 2)):
        answer = replace(UNIT, angle=-float(near)).answer()
        assert answer.figures["events"] == []
        assert answer.figures["period"] == UNIT.answer().figures["period"]
