"""Two shafts on one string: every formula, limit, phase and event of the smooth case."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.errors import InvalidParameter, NotApplicable
from core.scenes import friction, string_samples
from core.scenes.unwinding_shafts import UnwindingShafts
from tests.core.scenes.oracles import bounce_by_bounce, lagrange_shafts, relative
from tests.drawn import draws

PLAIN = UnwindingShafts(
    masses=(2.0, 3.0),
    radii=(0.1, 0.2),
    slopes=(0.6, 0.9),
    gravity=9.81,
    positions=(50.0, 50.0),
    wound=(30.0, 30.0),
)
VERTICAL = math.pi / 2


def figure(scene: UnwindingShafts, name: str) -> object:
    return scene.answer(outputs=frozenset({name})).figures[name]


def pulls(scene: UnwindingShafts) -> tuple[float, float]:
    return scene.gravity * math.sin(scene.slopes[0]), scene.gravity * math.sin(scene.slopes[1])


magnitude = st.floats(-100, 100).map(lambda power: 10.0**power)
slope = st.one_of(st.sampled_from([1e-9, VERTICAL]), st.floats(1e-3, VERTICAL))
factor = st.one_of(st.sampled_from([0.5, 1.0, 0.4, 1e300, 1e-300]), st.floats(1e-6, 1e6))


@settings(deadline=None, max_examples=draws(60), derandomize=True)
@given(
    masses=st.tuples(magnitude, magnitude),
    radii=st.tuples(magnitude, magnitude),
    factors=st.tuples(factor, factor),
    slopes=st.tuples(slope, slope),
    gravity=magnitude,
)
def test_agrees_with_the_lagrange_equations_at_any_magnitude(masses, radii, factors, slopes, gravity) -> None:  # type: ignore[no-untyped-def]
    scene = UnwindingShafts(masses=masses, radii=radii, slopes=slopes, gravity=gravity, inertia_factors=factors)
    answer = scene.answer(outputs=frozenset({"tension", "accelerations", "angular_accelerations"}))
    truth = lagrange_shafts(masses, radii, factors, slopes, gravity)
    compared = 0
    for name, true in truth.items():
        found = answer.figures[name]
        for value, exact in zip(found if isinstance(found, list) else [found], true, strict=True):
            if value is None:
                assert not 1e-307 < abs(exact) < 1e308, "only what a double cannot hold is left out"
            else:
                assert relative(value, exact) <= min(1e-15, answer.accuracy.error)
                compared += 1
    assert compared


def test_solid_shafts_have_the_formula_of_the_page() -> None:
    (m1, m2), (a, b) = PLAIN.masses, pulls(PLAIN)
    assert figure(PLAIN, "tension") == pytest.approx((a + b) * m1 * m2 / (3 * (m1 + m2)), rel=1e-14)
    expected = [
        ((3 * m1 + 2 * m2) * a - m2 * b) / (3 * (m1 + m2)),
        ((3 * m2 + 2 * m1) * b - m1 * a) / (3 * (m1 + m2)),
    ]
    assert figure(PLAIN, "accelerations") == pytest.approx(expected, rel=1e-14)
    mu = [2 / 3, 1.0]
    assert figure(PLAIN, "reduced_masses") == pytest.approx(mu, rel=1e-15)
    slides = (mu[0] * a - mu[1] * b) / (mu[0] + mu[1])
    assert figure(PLAIN, "string_acceleration") == pytest.approx(slides, rel=1e-13)
    assert figure(PLAIN, "normal_forces") == pytest.approx(
        [m * 9.81 * math.cos(s) for m, s in zip(PLAIN.masses, PLAIN.slopes, strict=True)], rel=1e-15
    )


def test_the_known_wrong_answers_are_not_given() -> None:
    (m1, m2), (a, b) = PLAIN.masses, pulls(PLAIN)
    tension = figure(PLAIN, "tension")
    assert isinstance(tension, float)
    assert tension > 0, "the source's multiplier is minus the tension"
    atwood, hoops = (a + b) * m1 * m2 / (m1 + m2), (a + b) * m1 * m2 / (2 * (m1 + m2))
    for wrong in (atwood, hoops):
        assert abs(tension - wrong) > 0.3 * tension
    assert figure(replace(PLAIN, inertia_factors=(1.0, 1.0)), "tension") == pytest.approx(hoops, rel=1e-14)


def test_limits_of_the_inertia_factors() -> None:
    (m1, m2), (a, b) = PLAIN.masses, pulls(PLAIN)
    atwood = (a + b) * m1 * m2 / (m1 + m2)
    assert figure(replace(PLAIN, inertia_factors=(1e300, 1e300)), "tension") == pytest.approx(atwood, rel=1e-15)
    assert figure(replace(PLAIN, inertia_factors=(1e-300, 1e-300)), "tension") == pytest.approx(
        (a + b) * 1e-300 * m1 * m2 / (m1 + m2), rel=1e-14
    )
    one = replace(PLAIN, inertia_factors=(0.0, 0.5))
    assert figure(one, "tension") == 0.0
    assert figure(one, "angular_accelerations") == pytest.approx([(a + b) / 0.1, 0.0], rel=1e-15)


def test_without_any_inertia_the_spins_are_said_to_be_open() -> None:
    scene = replace(PLAIN, inertia_factors=(0.0, 0.0))
    answer = scene.answer()
    assert answer.figures["tension"] == 0.0
    assert answer.figures["accelerations"] == pytest.approx(list(pulls(PLAIN)))
    assert answer.figures["angular_accelerations"] is None
    assert [notice.code for notice in answer.warnings] == ["indeterminate"]
    with pytest.raises(NotApplicable):
        scene.answer(np.array([0.0, 1.0]))


def test_equal_shafts_that_fall_freely() -> None:
    scene = UnwindingShafts(masses=(2.0, 2.0), radii=(0.1, 0.3), slopes=(VERTICAL, VERTICAL), gravity=9.0)
    assert figure(scene, "tension") == pytest.approx(2.0 * 9.0 / 3, rel=1e-15)
    assert figure(scene, "accelerations") == pytest.approx([6.0, 6.0], rel=1e-15)
    assert figure(scene, "string_acceleration") == 0.0


def test_level_faces_leave_everything_at_rest() -> None:
    scene = replace(PLAIN, slopes=(0.0, 0.0))
    answer = scene.answer(np.linspace(0, 1e6, 5))
    assert answer.figures["tension"] == 0.0
    assert answer.figures["accelerations"] == [0.0, 0.0]
    assert answer.trajectory is not None
    assert np.array_equal(answer.trajectory["positions"], np.full((5, 2), 50.0))
    assert answer.figures["phases"][0]["end"] is None


@settings(deadline=None, max_examples=draws(40), derandomize=True)
@given(
    masses=st.tuples(st.floats(0.1, 10), st.floats(0.1, 10)),
    slopes=st.tuples(st.floats(0, VERTICAL), st.floats(0, VERTICAL)),
)
def test_never_do_both_climb_and_one_does_where_the_page_says(masses, slopes) -> None:  # type: ignore[no-untyped-def]
    scene = replace(PLAIN, masses=masses, slopes=slopes)
    first, second = scene.answer(outputs=frozenset({"accelerations"})).figures["accelerations"]
    assert first >= 0 or second >= 0
    margin = (3 * masses[0] + 2 * masses[1]) * math.sin(slopes[0]) - masses[1] * math.sin(slopes[1])
    if abs(margin) > 1e-12:
        assert (first < 0) == (margin < 0)


def test_neither_radii_nor_velocities_enter_tension_and_accelerations() -> None:
    moving = replace(PLAIN, radii=(7.0, 0.003), velocities=(1.0, -1.0))
    for name in ("tension", "accelerations"):
        assert figure(moving, name) == figure(PLAIN, name)


def test_the_string_runs_out_when_the_page_says() -> None:
    scene = replace(PLAIN, wound=(0.5, 30.0))
    tension = figure(scene, "tension")
    assert isinstance(tension, float)
    expected = math.sqrt(2 * 0.5 * 0.5 * 2.0 / tension)
    answer = scene.answer(np.linspace(0, 2, 201))
    assert answer.ended == "string-1-unwound"
    (event,) = answer.figures["events"]
    assert event["kind"] == "string-1-unwound"
    assert event["time"] == pytest.approx(expected, rel=1e-14)
    assert answer.trajectory is not None
    assert answer.trajectory["time"].size == int(expected / 0.01) + 1 == answer.work.samples


@pytest.mark.parametrize("wound", [1e-100, 1e-12, 0.5, 1e12, 1e100])
@pytest.mark.parametrize("spin", [0.0, 1e-9, -1e-9, 3.0, -3.0, 1e20, -1e20])
def test_event_times_are_right_at_every_balance_of_coefficients(wound: float, spin: float) -> None:
    scene = replace(PLAIN, wound=(wound, 1e300), positions=(1e250, 1e250), spins=(spin, -0.5 * spin))
    # 0.1 spin - 0.2 spin/2 vanishes but for rounding: the string is taut.
    answer = scene.answer(outputs=frozenset({"events"}))
    with mp.workdps(400):
        theta = lagrange_shafts(scene.masses, scene.radii, (0.5, 0.5), scene.slopes, scene.gravity)[
            "angular_accelerations"
        ][0]
        b, c = mp.mpf(spin), mp.mpf(wound) / mp.mpf(0.1)
        # Of the two roots of theta t^2/2 + b t - c the positive one.
        true = (-b + mp.sqrt(b * b + 2 * theta * c)) / theta
    assert relative(answer.figures["events"][0]["time"], true) < 1e-13


def test_the_first_of_several_ends_is_found() -> None:
    base = replace(PLAIN, masses=(0.01, 3.0), slopes=(0.01, 1.0), positions=(0.5, 1.0), wound=(30.0, 30.0))
    assert base.answer().ended == "shaft-1-at-apex"
    assert replace(base, slope_lengths=(0.6, 1.1)).answer().ended == "shaft-2-at-slope-end"
    assert replace(base, wound=(1e-3, 30.0)).answer().ended == "string-1-unwound"
    assert replace(base, wound=(0.0, 30.0)).answer().figures["events"] == [
        {"kind": "string-1-unwound", "time": 0.0, "error": 0.0}
    ]


def test_a_slack_string_leaves_both_sliding_until_it_tightens() -> None:
    scene = replace(PLAIN, spins=(20.0, 10.0))
    w, (a, b) = 4.0, pulls(PLAIN)
    answer = scene.answer(np.array([0.0, 0.1, 0.2]))
    assert answer.figures["tension"] == 0.0
    assert answer.figures["accelerations"] == pytest.approx([a, b], rel=1e-15)
    assert answer.figures["string_acceleration"] is None
    first, second = scene.answer().figures["phases"]
    assert (first["kind"], second["kind"]) == ("slack", "taut")
    assert first["end"] == second["start"] == pytest.approx(2 * w / (a + b), rel=1e-14)
    mu = (2 / 3) * 1.0 / (2 / 3 + 1.0)
    assert second["impulse"] == pytest.approx(w * mu, rel=1e-14)
    assert second["dissipated"] == pytest.approx(w * w * mu / 2, rel=1e-14)
    assert answer.trajectory is not None
    assert np.array_equal(answer.trajectory["spins"], np.tile([20.0, 10.0], (3, 1)))


@pytest.mark.parametrize("restitution", [0.1, 0.5, 0.9, 0.999, 1.0])
def test_jerks_agree_with_stepping_from_jerk_to_jerk(restitution: float) -> None:
    scene = replace(PLAIN, velocities=(1.0, 2.0), spins=(-3.0, 5.0), restitution=restitution)
    settled = 4.6 * restitution / sum(pulls(scene)) / max(1.0 - restitution, 1e-9)
    times = np.array([0.0, 0.01, 0.1, 0.5, 0.9, 0.999]) * min(settled, 3.0)
    answer = scene.answer(times)
    assert answer.trajectory is not None
    with mp.workdps(50):
        ab = tuple(mp.mpf(scene.gravity) * mp.sin(mp.mpf(s)) for s in scene.slopes)
        for i, t in enumerate(times):
            x, v, w = bounce_by_bounce(
                scene.masses, scene.radii, (0.5, 0.5), ab, (50.0, 50.0), scene.velocities, scene.spins, restitution, t
            )
            for name, true in (("positions", x), ("velocities", v), ("spins", w)):
                for j in (0, 1):
                    error = relative(answer.trajectory[name][i, j], true[j])
                    assert error < 1e-13, (name, t)
                    largest = np.max(np.abs(answer.trajectory[name]))
                    assert error * abs(float(true[j])) <= answer.accuracy.error * largest


def test_infinitely_many_jerks_end_at_the_sum_of_their_series() -> None:
    e = 0.5
    scene = replace(PLAIN, velocities=(1.0, 2.0), restitution=e)
    first, second = scene.answer().figures["phases"]
    a, b = pulls(PLAIN)
    w, mu = 3.0, 0.4
    assert (first["kind"], first["jerks"], second["kind"]) == ("slack", None, "taut")
    assert first["end"] == pytest.approx(2 * e * w / (a + b) / (1 - e), rel=1e-14)
    assert first["impulse"] == pytest.approx((1 + e) * w * mu / (1 - e), rel=1e-14)
    assert first["dissipated"] == pytest.approx(mu * w * w / 2, rel=1e-14), (
        "all of the closing energy is lost in the end"
    )
    # Continuity with the taut phase, approached from the left through thousands of jerks.
    end = first["end"]
    answer = scene.answer(np.array([end * (1 - 1e-12), end, end * (1 + 1e-12)]))
    assert answer.trajectory is not None
    for name in ("positions", "velocities", "spins"):
        column = answer.trajectory[name]
        assert np.max(np.abs(column[0] - column[2])) < 1e-9 * np.max(np.abs(column))


@pytest.mark.parametrize("restitution", [0.3, 0.9, 0.999999, 1.0])
@pytest.mark.parametrize("limit", ["apex", "slope", "wound"])
def test_an_end_among_the_jerks_is_found_in_the_right_arc(restitution: float, limit: str) -> None:
    scene = replace(PLAIN, velocities=(-8.0, 9.5), spins=(0.0, 0.0), restitution=restitution)
    if limit == "apex":
        scene = replace(scene, positions=(1.2, 50.0))
    elif limit == "slope":
        scene = replace(scene, slope_lengths=(100.0, 52.0))
    else:
        scene = replace(scene, wound=(0.6, 30.0))
    answer = scene.answer()
    (a, b), x, v, s, r = pulls(scene), list(scene.positions or ()), [-8.0, 9.5], [0.0, 0.0], [0.0, 0.0]
    # An independent search: from jerk to jerk in doubles, finely sampled inside each arc.
    share, now, crossed = ((1.0 / (2 / 3 + 1.0)), ((2 / 3) / (2 / 3 + 1.0))), 0.0, None
    for _ in range(10_000):
        opening = r[0] + r[1] - v[0] - v[1]
        if opening < 0:
            total = -(1 + restitution) * opening
            v = [v[i] - total * share[i] / 3 for i in (0, 1)]
            r = [r[i] + total * share[i] * 2 / 3 for i in (0, 1)]
            opening = -restitution * opening
        arc = 2 * opening / (a + b)
        taut = opening < 1e-9
        accelerations = (a, b)
        turning = (0.0, 0.0)
        if taut:
            arc = 50.0
            accelerations = tuple(p - (a + b) * share[i] / 3 for i, p in enumerate((a, b)))
            turning = tuple((a + b) * share[i] * 2 / 3 for i in (0, 1))
        t = np.linspace(0, arc, 200_001 if taut else 101)
        xs = [x[i] + v[i] * t + accelerations[i] * t * t / 2 for i in (0, 1)]
        ss = [s[i] + r[i] * t + turning[i] * t * t / 2 for i in (0, 1)]
        out = (np.minimum(*xs) < 0) | (ss[0] > scene.wound[0]) | (ss[1] > scene.wound[1])  # type: ignore[index]
        if scene.slope_lengths:
            out |= (xs[0] > scene.slope_lengths[0]) | (xs[1] > scene.slope_lengths[1])
        if out.any():
            crossed = now + t[np.argmax(out)]
            slack = t[1]
            break
        x, s = [xs[i][-1] for i in (0, 1)], [ss[i][-1] for i in (0, 1)]
        v = [v[i] + accelerations[i] * arc for i in (0, 1)]
        now += arc
    assert crossed is not None
    assert answer.figures["events"][-1]["time"] == pytest.approx(crossed, abs=1.01 * slack + 1e-7)
    assert (
        answer.ended == {"apex": "shaft-1-at-apex", "slope": "shaft-2-at-slope-end", "wound": "string-1-unwound"}[limit]
    )


def test_rounded_products_count_as_taut() -> None:
    scene = replace(PLAIN, velocities=(0.3, 0.0), spins=(0.3 / 0.1 * (1 + 1e-15), 0.0), restitution=0.7)
    answer = scene.answer(np.array([0.0, 1.0]))
    assert [phase["kind"] for phase in answer.figures["phases"]] == ["taut"]
    assert answer.accuracy.error < 1e-13


def test_only_what_is_requested_is_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(*_: object, **__: object) -> None:
        raise AssertionError("this was not asked for")

    monkeypatch.setattr(string_samples.ShaftMotion, "sample", forbidden)
    monkeypatch.setattr(string_samples.ShaftMotion, "__init__", forbidden)
    monkeypatch.setattr(UnwindingShafts, "motion", forbidden)
    for function in ("_taut", "_slack", "_alone", "_sticking", "with_friction"):
        monkeypatch.setattr(friction, function, forbidden)
    monkeypatch.setattr("core.scenes.unwinding_shafts.with_friction", forbidden)
    answer = PLAIN.answer(outputs=frozenset({"tension"}))
    assert set(answer.figures) == {"tension"}
    assert answer.trajectory is None
    assert answer.model.degrees_of_freedom == 0


def test_friction_is_not_run_where_there_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(*_: object, **__: object) -> None:
        raise AssertionError("a smooth slope ran friction code")

    for function in ("_taut", "_slack", "_alone", "_sticking"):
        monkeypatch.setattr(friction, function, forbidden)
    monkeypatch.setattr("core.scenes.unwinding_shafts.with_friction", forbidden)
    answer = replace(PLAIN, velocities=(1.0, 0.0), restitution=0.4).answer(np.linspace(0, 1, 11))
    assert answer.figures["friction_forces"] is None


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"masses": (0.0, 1.0)}, ("masses", 0)),
        ({"masses": (1.0, math.nan)}, ("masses", 1)),
        ({"radii": (1.0, -1.0)}, ("radii", 1)),
        ({"slopes": (-0.1, 0.1)}, ("slopes", 0)),
        ({"slopes": (0.1, 1.6)}, ("slopes", 1)),
        ({"gravity": 0.0}, ("gravity",)),
        ({"inertia_factors": (-0.1, 0.5)}, ("inertia_factors", 0)),
        ({"positions": (1.0,)}, ("positions",)),
        ({"restitution": 1.1}, ("restitution",)),
        ({"slope_lengths": (49.0, 60.0)}, ("positions", 0)),
        (
            {"inertia_factors": (0.0, 0.5), "friction": friction.Friction((0.1, 0.1), (0.1, 0.1))},
            ("inertia_factors", 0),
        ),
    ],
)
def test_what_is_no_scene_is_refused(change: dict[str, object], path: tuple[str | int, ...]) -> None:
    with pytest.raises(InvalidParameter) as refusal:
        replace(PLAIN, **change)  # type: ignore[arg-type]
    assert refusal.value.path == path


def test_a_motion_needs_positions_and_times_after_the_start() -> None:
    with pytest.raises(InvalidParameter, match="positions"):
        replace(PLAIN, positions=None).answer(np.array([0.0]))
    with pytest.raises(InvalidParameter, match="times"):
        PLAIN.answer(np.array([-1e-9]))
    figures = replace(PLAIN, positions=None).answer().figures
    assert "tension" in figures
    assert "events" not in figures


@pytest.mark.parametrize("exponent", [5, 12, 19, 20, 30, 100, 160, 200, 300])
def test_a_number_of_jerks_beyond_all_integers_is_given_as_a_double(exponent: int) -> None:
    """Without loss the arcs are all alike, each as long as the jerk is fast: half the speed, twice the jerks."""
    scene = UnwindingShafts(
        masses=(2.0, 1.0), radii=(0.1, 0.2), slopes=(0.5, 0.9), gravity=9.81, positions=(1.0, 1.5), wound=(0.5, 0.8),
        velocities=(-(10.0**-exponent), 0.0), restitution=1.0,
    )  # fmt: skip
    found = scene.answer(np.array([0.0, 0.3]))
    last = found.figures["phases"][-1]
    assert last["kind"] == "slack"
    # Counted one by one where they still can be: 3.3e5 for a speed of 1e-5 m/s.
    assert last["jerks"] * 10.0**-exponent == pytest.approx(3.33898807506669, rel=2e-5 if exponent == 5 else 1e-11)
    assert isinstance(last["jerks"], int) is (exponent < 16)
    assert np.isfinite(found.trajectory["positions"]).all()  # type: ignore[index]


def test_slower_than_any_double_it_is_refused_and_does_not_fail() -> None:
    with pytest.raises(InvalidParameter):
        UnwindingShafts(
            masses=(2.0, 1.0), radii=(0.1, 0.2), slopes=(0.5, 0.9), gravity=9.81, positions=(1.0, 1.5),
            wound=(0.5, 0.8), velocities=(-5e-324, 0.0), restitution=1.0,
        ).answer(np.array([0.0, 0.3]))  # fmt: skip
