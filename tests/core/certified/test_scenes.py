"""Scenes against other formulations at 50 digits and more, and against their own doubles."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from mpmath import mp, mpf

from core.certified.scenes import certified_scene, exact_scene
from core.errors import InvalidParameter, NotApplicable
from core.scenes.chain_on_wedge import ChainOnWedge
from core.scenes.rod_in_hole import RodInHole
from core.scenes.unwinding_shafts import UnwindingShafts
from tests.core.scenes.oracles import bounce_by_bounce, chain_state, lagrange_shafts, pendulum_angle

ROD = {"hole_radius": 1.0, "length": 1.0, "mass": 2.0, "gravity": 9.8125}
CHAIN = {
    "masses": [1.0, 2.0],
    "slopes": [0.25, 0.75],
    "gravity": 9.8125,
    "length": 30.0,
    "linear_density": 0.5,
    "position": 20.0,
    "velocity": 0.25,
}
SHAFTS = {
    "masses": [1.0, 2.0],
    "radii": [0.125, 0.25],
    "slopes": [0.25, 0.75],
    "gravity": 9.8125,
    "positions": [50.0, 50.0],
}
JERKED = {**SHAFTS, "velocities": [2.0, 1.0], "spins": [3.0, 2.0], "restitution": 0.5}


@pytest.mark.parametrize(
    "extra",
    [
        {},
        {"angle": 0.25, "angular_velocity": 0.5},
        {"angle": 0.25, "angular_velocity": -12.0, "hole": "cylinder"},
        {"angle": 0.0, "angular_velocity": 0.0},
    ],
    ids=["released at the rim", "swinging", "going round", "at rest"],
)
def test_the_rod_swings_as_a_pendulum(extra):
    times = [0.375, -0.5]
    found = certified_scene(exact_scene(RodInHole, {**ROD, **extra}), 40, times)
    assert found.trajectory is not None
    with mp.workdps(50):
        k2 = mpf(3) / 4
        frequency = mp.sqrt(mpf("9.8125") * mp.sqrt(k2) / (1 - mpf(1) / 6))
        angle = mpf(extra["angle"]) if "angle" in extra else -mp.acos(mpf(1) / 2)
        for time, psi, rate in zip(times, found.trajectory["angle"], found.trajectory["angular_velocity"], strict=True):
            want, speed = pendulum_angle(frequency, angle, mpf(extra.get("angular_velocity", 0.0)), mpf(time))
            assert abs(mpf(psi) - want) < mpf("1e-37")
            assert abs(mpf(rate) - speed) < mpf("1e-37")


def test_the_rods_figures():
    found = certified_scene(exact_scene(RodInHole, {**ROD, "gravity": "9.81", "mass": 1}), 30)
    # PHYSICS: omega^2 = 2 g k (1 - l/2a)/(a^2 - l^2/6); forces at release with a = l = 1.
    with mp.workdps(40):
        g, k = mpf("9.81"), mp.sqrt(3) / 2
        omega = mp.sqrt(2 * g * k * (1 - mpf(1) / 2) / (1 - mpf(1) / 6))
        upper, lower = g * (8 - 1) / (8 * k * 5), g * (16 - 3) / (8 * k * 5)
        assert abs(mpf(found.figures["angular_velocity_at_horizontal"]) - omega) < mpf("1e-28")
        forces = sorted(mpf(x) for x in found.figures["forces_at_release"])
        assert abs(forces[0] - upper) < mpf("1e-28")
        assert abs(forces[1] - lower) < mpf("1e-28")
    assert found.figures["release_angle"] == "-1.04719755119659774615421446109"
    assert found.figures["contact"]["kept"] is True
    assert found.ended is None


def test_the_chain():
    times = [0.0, 0.5, 1.5]
    found = certified_scene(exact_scene(ChainOnWedge, CHAIN), 40, times)
    assert found.trajectory is not None
    for i, time in enumerate(times):
        want = chain_state((1.0, 2.0), (0.25, 0.75), 9.8125, 30.0, 0.5, 20.0, 0.25, time)
        with mp.workdps(60):
            for name, true in zip(("position", "velocity", "apex_tension"), want, strict=True):
                assert abs(mpf(found.trajectory[name][i]) - true) < mpf("1e-38") * max(1, abs(true))


def test_a_chain_without_mass_falls_uniformly():
    found = certified_scene(exact_scene(ChainOnWedge, {**CHAIN, "linear_density": 0.0}), 30, [0.5])
    want = chain_state((1.0, 2.0), (0.25, 0.75), 9.8125, 30.0, 0.0, 20.0, 0.25, 0.5)
    assert found.trajectory is not None
    with mp.workdps(40):
        assert abs(mpf(found.trajectory["position"][0]) - want[0]) < mpf("1e-27")
    assert found.figures["growth_rate"] == "0"


def test_taut_shafts_solve_lagranges_equations():
    found = certified_scene(exact_scene(UnwindingShafts, SHAFTS), 50, [1.0])
    want = lagrange_shafts((1.0, 2.0), (0.125, 0.25), (0.5, 0.5), (0.25, 0.75), 9.8125)
    with mp.workdps(60):
        for name in ("accelerations", "angular_accelerations"):
            for x, y in zip(found.figures[name], want[name], strict=True):
                assert abs(mpf(x) - y) < mpf("1e-47")
        assert abs(mpf(found.figures["tension"]) - want["tension"][0]) < mpf("1e-47")
        assert found.trajectory is not None
        for x, a in zip(found.trajectory["positions"][0], want["accelerations"], strict=True):
            assert abs(mpf(x) - 50 - a / 2) < mpf("1e-46")


@pytest.mark.parametrize("restitution", [0.5, 1.0])
def test_jerked_shafts_go_from_jerk_to_jerk(restitution):
    # With e = 1/2 the jerks accumulate at 0.466 s, and the oracle steps from one to the next.
    times = [0.125, 0.4375, 0.4609375] if restitution < 1 else [0.125, 0.4375, 1.75]
    found = certified_scene(exact_scene(UnwindingShafts, {**JERKED, "restitution": restitution}), 40, times)
    assert found.trajectory is not None
    with mp.workdps(80):
        pulls = [mpf("9.8125") * mp.sin(mpf(s)) for s in (0.25, 0.75)]
        for i, time in enumerate(times):
            x, v, w = bounce_by_bounce(
                (1.0, 2.0), (0.125, 0.25), (0.5, 0.5), pulls, (50.0, 50.0), (2.0, 1.0), (3.0, 2.0), restitution, time
            )
            for name, want in (("positions", x), ("velocities", v), ("spins", w)):
                for found_one, true in zip(found.trajectory[name][i], want, strict=True):
                    assert abs(mpf(found_one) - true) < mpf("1e-36")


@pytest.mark.parametrize(
    ("kind", "parameters"),
    [(RodInHole, ROD), (ChainOnWedge, CHAIN), (UnwindingShafts, SHAFTS), (UnwindingShafts, JERKED)],
)
def test_the_doubles_of_the_scene_are_these_numbers_rounded(kind, parameters):
    doubles = {k: tuple(v) if isinstance(v, list) else v for k, v in parameters.items()}
    # As the oracle of the doubles' statement of error, on figures and samples.
    times = np.linspace(0, 1.0, 9)
    answer = kind(**doubles).answer(times)
    found = certified_scene(kind(**doubles), 25, list(times))
    assert found.ended == answer.ended
    assert found.model == answer.model
    assert answer.trajectory is not None
    assert found.trajectory is not None
    for name in ("time", *answer.trajectory.columns):
        column = answer.trajectory[name]
        exact = np.array([[Fraction(x) for x in np.atleast_1d(row)] for row in found.trajectory[name]], dtype=object)
        wrong = [abs(Fraction(float(a)) - b) for a, b in zip(column.ravel(), exact.ravel(), strict=True)]
        assert max(wrong) <= answer.accuracy.error * np.max(np.abs(column))
    for a, b in zip(flat(answer.figures), flat(found.figures), strict=True):
        if isinstance(a, float):
            assert abs(Fraction(a) - Fraction(b)) <= Fraction(answer.accuracy.error) * abs(Fraction(b))
        else:
            assert a == b


def flat(value):
    if isinstance(value, dict):
        # Digits that are proven have no errors beside them.
        return [x for key in sorted(value) if key not in ("error", "errors") for x in flat(value[key])]
    if isinstance(value, (list, tuple)):
        return [x for entry in value for x in flat(entry)]
    return [value]


def test_a_decimal_string_is_exact():
    scene = exact_scene(
        UnwindingShafts, {**SHAFTS, "slopes": ["0.5", "0.5"], "gravity": "9.81", "masses": ["0.1", "0.1"]}
    )
    with mp.workdps(40):
        # PHYSICS: T = g (sin a + sin b) M1 M2/(3 (M1 + M2)).
        want = mpf("9.81") * 2 * mp.sin(mpf("0.5")) * mpf("0.01") / (3 * mpf("0.2"))
        found = certified_scene(scene, 30, outputs=frozenset({"tension", "string_acceleration"})).figures
        assert abs(mpf(found["tension"]) - want) < mpf("1e-30")
    # Two equal shafts: the string stands still, which shows as a difference that vanishes.
    assert found["string_acceleration"] == "0" or found["string_acceleration"].startswith("0e-")


def test_velocities_that_agree_only_to_rounding_need_decimal_strings():
    spun = {"radii": [0.1, 0.1], "velocities": [0.3, 0.7], "spins": [3.0, 7.0]}
    with pytest.raises(NotApplicable) as caught:
        certified_scene(exact_scene(UnwindingShafts, {**SHAFTS, **spun}), 20, [1.0])
    assert caught.value.path == ("digits",)
    exactly = {"radii": ["0.1", "0.1"], "velocities": ["0.3", "0.7"], "spins": [3, 7]}
    taut = certified_scene(exact_scene(UnwindingShafts, {**SHAFTS, **exactly}), 20, [1.0])
    assert [phase["kind"] for phase in taut.figures["phases"]] == ["taut"]


def test_samples_end_with_the_motion():
    scene = exact_scene(UnwindingShafts, {**SHAFTS, "wound": [1.0, 60.0]})
    found = certified_scene(scene, 20, [0.0, 0.5, 5.0])
    assert found.ended == "string-1-unwound"
    assert found.trajectory is not None
    assert found.trajectory["time"] == [0.0, 0.5]
    assert [event["kind"] for event in found.figures["events"]] == ["string-1-unwound"]


def test_a_thousand_digits_of_a_period():
    found = certified_scene(exact_scene(RodInHole, ROD), 1000, outputs=frozenset({"period"}))
    with mp.workdps(1010):
        frequency = mp.sqrt(mpf("9.8125") * mp.sqrt(mpf(3)) / 2 / (1 - mpf(1) / 6))
        want = 4 * mpmath.ellipk(mpf(1) / 4) / frequency
        assert abs(mpf(found.figures["period"]) - want) < mpf(10) ** -998


@pytest.mark.parametrize(
    ("ask", "path"),
    [
        (lambda: exact_scene(RodInHole, {**ROD, "colour": 1}), ("colour",)),
        (lambda: exact_scene(RodInHole, {**ROD, "mass": "heavy"}), ("mass",)),
        (lambda: exact_scene(RodInHole, {**ROD, "mass": "-1"}), ("mass",)),
        (lambda: exact_scene(RodInHole, {**ROD, "mass": "1e400"}), ("mass",)),
        (lambda: exact_scene(RodInHole, {**ROD, "mass": "1e-301"}), ("mass",)),
        (lambda: exact_scene(RodInHole, {**ROD, "length": "2"}), ("length",)),
        (lambda: exact_scene(UnwindingShafts, {**SHAFTS, "masses": ["1", "x"]}), ("masses", 1)),
        (
            lambda: exact_scene(UnwindingShafts, {**SHAFTS, "friction": {"static": [0, 0], "kinetic": ["1", 0]}}),
            ("friction", "kinetic", 0),
        ),
        (lambda: certified_scene(exact_scene(RodInHole, ROD), 5), ("digits",)),
        (lambda: certified_scene(exact_scene(RodInHole, ROD), 20, outputs=frozenset({"music"})), ("outputs",)),
        (lambda: certified_scene(exact_scene(RodInHole, ROD), 20, outputs=frozenset({"trajectory"})), ("times",)),
        (lambda: certified_scene(exact_scene(UnwindingShafts, SHAFTS), 20, [1.0, -1.0]), ("times", 1)),
    ],
)
def test_what_is_refused(ask, path):
    with pytest.raises(InvalidParameter) as caught:
        ask()
    assert caught.value.path == path
