"""InputUncertainty errors against moved problems, solved to 50 digits with signs of the inputs that add up most."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from hypothesis import assume, example, settings
from hypothesis import given as drawn
from hypothesis import strategies as st

from core.arrays import Floats
from core.bodies.mass_properties import diagonal
from core.bodies.measured import InertiaTensor, PointMasses, PrincipalMoments
from core.bodies.solids import Cylinder
from core.errors import AccuracyUnreachable
from core.rotation.attitude.free_attitude import FreeAttitude
from core.rotation.free_rotation import FreeRotation
from core.rotation.torque_free import TorqueFree
from core.rotation.uncertainty.sensitivities import growth_factor
from core.systems.solve import solve
from tests.drawn import draws
from tests.oracles.cases import T_HANDLE
from tests.oracles.perturbed import ATTITUDE, Perturbed
from tests.oracles.uncertain_bodies import KINDS, REGIMES, Uncertain, of_moments, of_points, uncertain

UNCERTAINTIES = (2.0**-53, 1e-9, 1e-4)


def compared(case: Uncertain, times: list[float], seed: int = 0) -> list[tuple[float, float, float, float]]:
    """Return stated and observed, of angular velocity and attitude, for every uncertainty."""
    exact = TorqueFree(case.body(case.numbers).mass_properties(), np.array(case.start)).closed_form()
    free = FreeAttitude(exact, np.array([float(x) for x in ATTITUDE]))
    horizon, oracle = np.array([max(times)]), Perturbed(case, times)
    tries = oracle.worst_signs()
    tries.append(np.random.default_rng(seed).choice([-1, 1], len(oracle.inputs)).tolist())
    found = []
    for uncertainty in UNCERTAINTIES:
        moved = [oracle.moved(Fraction(uncertainty), signs) for signs in tries]
        rate = max(float(np.linalg.norm(change / exact.largest_norm, axis=1).max()) for change, _ in moved)
        turn = max(float(np.linalg.norm(angle, axis=1).max()) for _, angle in moved)
        found.append((exact.inherited(horizon, uncertainty), rate, free.inherited(horizon, uncertainty), turn))
    return found


@pytest.mark.parametrize("kind", KINDS)
def test_never_below_what_moved_inputs_do_and_not_far_above(kind: str) -> None:
    ratios: list[float] = []
    for n, regime in enumerate((*REGIMES, "ordinary", "magnitudes")):
        case = uncertain(700_000 + 10 * n, kind, regime)
        times = [case.horizon * share for share in (0.3, 0.6, 0.8, 0.9, 1.0)]
        for stated, rate, turned, turn in compared(case, times, seed=n):
            assert rate <= stated
            assert turn <= turned
            if stated < math.inf and regime != "near separatrix":
                ratios.append(stated / rate)
    assert np.median(ratios) <= 5.0


def given(moments: tuple[float, ...], start: tuple[float, float, float]) -> Uncertain:
    return Uncertain("principal moments", "", moments, lambda x: PrincipalMoments(tuple(x)), of_moments, start, 1.0)


SQUARE = (1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.0, -1.0, -1.0, 0.0, 1.0, -1.0, 0.0)


def square(start: tuple[float, float, float]) -> Uncertain:
    return Uncertain(
        "point masses", "", SQUARE, lambda x: PointMasses(list(x[:4]), np.array(x[4:]).reshape(-1, 3)), of_points,
        start, 1.0,
    )  # fmt: skip


SPECIAL = [
    given((1.0, 2.0, 2.5), (0.0, 0.0, 1.5)),
    given((1.0, 2.0, 2.5), (1.5, 0.0, 0.0)),
    given((1.0, 2.0, 2.5), (0.0, 1.5, 0.0)),
    given((2.0, 2.0, 3.0), (0.6, -0.8, 0.0)),
    given((2.0, 2.0, 3.0), (0.0, 0.0, 0.7)),
    given((2.0, 2.0, 3.0), (0.6, -0.8, 0.3)),
    given((2.0, 2.0, 3.0), (0.6, -0.8, 1e-5)),
    given((2.0, 2.0, 2.0), (0.6, -0.8, 0.3)),
    given((14.0, 21.0, 24.0), (6.0, 1.0, 7.0)),
    given((14.0, 21.0, 24.0), (1e-9, 1.0, 1e-9)),
    given(tuple(T_HANDLE), (1.0, 10.0, 1.0)),
    square((0.5, -0.4, 0.0)),
    square((0.0, 0.0, 0.7)),
    square((0.5, -0.4, 0.3)),
    square((0.5, 0.0, 0.0)),
]


@pytest.mark.parametrize("case", SPECIAL, ids=lambda case: f"{case.numbers[:3]}-{case.start}")
def test_steady_symmetric_and_separating_motions_are_covered(case: Uncertain) -> None:
    for last in (0.01, 1.0, 30.0):
        for stated, rate, turned, turn in compared(case, [last * share for share in (0.25, 0.5, 0.75, 1.0)]):
            assert rate <= stated
            assert turn <= turned


@pytest.mark.parametrize(
    "case", [case for case in SPECIAL if case.kind == "principal moments"][:3], ids=lambda c: c.start
)
def test_a_steady_spin_along_a_body_axis_has_the_relative_error_of_its_input(case: Uncertain) -> None:
    exact = TorqueFree(case.body(case.numbers).mass_properties(), np.array(case.start)).closed_form()
    assert exact.inherited(np.array([1e9]), 1e-6) == pytest.approx(1e-6, rel=1e-5)


@pytest.mark.parametrize("moments", [(1e-150, 2e-150, 1e300), (1e-200, 1e-200, 1e200), (1e-150, 1e300, 1e300)])
@pytest.mark.parametrize("start", [(1.0, -0.2, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)])
def test_moments_below_every_double_next_to_another_leave_bounds_that_may_be_infinite(
    moments: tuple[float, float, float], start: tuple[float, float, float]
) -> None:
    rotation = TorqueFree(diagonal(moments), np.array(start)).closed_form()
    free = FreeAttitude(rotation, np.array([1.0, 0.0, 0.0, 0.0]))
    for time, uncertainty in product((0.0, 1e-9, 1.0, 1e3), (2.0**-53, 1e-6, 0.5)):
        # The start is as uncertain as everything else, and at least half as fast as the motion comes to be.
        assert rotation.inherited(np.array([time]), uncertainty) >= 0.5 * uncertainty
        assert 0.0 <= free.inherited(np.array([time]), uncertainty) <= math.pi


def test_the_angle_of_a_steady_spin_is_lost_when_it_is_a_radian_off() -> None:
    rotation = TorqueFree(diagonal((1.0, 2.0, 2.5)), np.array([0.0, 0.0, 1.5])).closed_form()
    free = FreeAttitude(rotation, np.array([1.0, 0.0, 0.0, 0.0]))
    assert rotation.horizon_of(1e-6) is None
    lost = free.horizon_of(1e-6)
    assert lost is not None
    # The angle is off by 1e-6 of 1.5 t, and first derivatives no longer apply beyond a tenth of a radian.
    assert lost == pytest.approx(0.1 / 1.5e-6, rel=1e-3)


def test_a_body_at_rest_inherits_the_attitude_alone() -> None:
    rotation = TorqueFree(diagonal((1.0, 2.0, 2.5)), np.zeros(3)).closed_form()
    free = FreeAttitude(rotation, np.array([1.0, 1.0, 0.0, 0.0]))
    assert rotation.inherited(np.array([5.0]), 1e-3) == 0.0
    assert free.inherited(np.array([5.0]), 1e-3) == 2e-3
    assert free.horizon_of(1e-3) is None


def test_exact_inputs_pass_nothing_on() -> None:
    rotation = TorqueFree(diagonal(T_HANDLE), np.array([1.0, 10.0, 1.0])).closed_form()
    assert rotation.inherited(np.array([5.0]), 0.0) == 0.0
    assert FreeAttitude(rotation, np.array([1.0, 0.0, 0.0, 0.0])).inherited(np.array([5.0]), 0.0) == 0.0


def test_a_line_of_matter_askew_may_turn_about_itself_and_one_along_an_axis_does_not() -> None:
    def line(direction: Floats) -> FreeRotation:
        points = np.outer([-1.0, 1.0], direction)
        across = np.cross(direction, [0.3, -0.2, 0.9])
        return TorqueFree(PointMasses(1.0, points).mass_properties(), across).closed_form()

    times = np.array([1.0])
    assert line(np.array([1.0, 0.0, 0.0])).inherited(times, 1e-9) < 1e-8
    with pytest.raises(Exception, match="three moments"):
        line(np.array([1.0, 0.7, 0.2]))
    askew = InertiaTensor(((0.5, -0.5, 0.0), (-0.5, 0.5, 0.0), (0.0, 0.0, 1.0))).mass_properties()
    assert TorqueFree(askew, np.array([0.0, 0.0, 1.0])).closed_form().inherited(times, 1e-9) == math.inf


def test_it_grows_with_time_and_uncertainty() -> None:
    motions = [uncertain(5, kind, regime) for kind, regime in product(KINDS, ("ordinary", "near separatrix"))]
    for case in motions:
        exact = TorqueFree(case.body(case.numbers).mass_properties(), np.array(case.start)).closed_form()
        times = np.geomspace(1e-3, 1e6, 60) * case.horizon
        for stated in (
            [exact.inherited(np.array([t]), 1e-9) for t in times],
            [exact.inherited(times[20:21], u) for u in np.geomspace(1e-16, 0.5, 40)],
        ):
            assert stated == sorted(stated)


@pytest.mark.parametrize(
    "moments", [(1.0, 1.0, 2.0), (1e-150, 1.0, 2.0), (1.0, 2.0, 3.0), (1e-12, 1.0, 1.0 + 2.0**-52)]
)
@pytest.mark.parametrize(
    "start", [(1.0, 1.0, 5e-324), (1e150, 1e-300, 0.3), (1e-310, 1e-310, 0.0), (1e-200, 1.0, 1e-12)]
)
def test_at_the_ends_of_the_double_range_it_is_a_number(
    moments: tuple[float, float, float], start: tuple[float, float, float]
) -> None:
    rotation = TorqueFree(diagonal(moments), np.array(start)).closed_form()
    free = FreeAttitude(rotation, np.array([1.0, 0.0, 0.0, 0.0]))
    times = np.array([1e-300]) / max(1.0, rotation.largest_norm)
    for uncertainty in (2.0**-53, 0.9):
        assert rotation.inherited(times, uncertainty) > 0.0
        assert 0.0 < free.inherited(times, uncertainty) <= np.pi


# Starts nearer to the middle axis than doubles resolve are refused, as a test of their own says.
component = st.floats(-1.0, 1.0).map(lambda x: x if abs(x) > 1e-30 else 0.0)


@settings(deadline=None, derandomize=True, max_examples=draws(150))
@drawn(
    st.floats(0.3, 3.0),
    st.sampled_from((1e-15, 1e-9, 1e-4, 0.1, 1.0)),
    st.floats(0.3, 3.0),
    st.tuples(*3 * [component]),
    st.tuples(*3 * [component]),
    st.floats(-2.0, 4.0),
)
def test_no_difference_of_two_motions_grows_faster_than_groenwall_allows(first, gap, third, spin, away, late):
    A, B, C = sorted((first, first * (1.0 + gap), third))
    body = diagonal((A, B, C)).principal
    step = 1e-4
    one = FreeRotation(body, np.array(spin))
    other = FreeRotation(body, np.array(spin) + step * np.array(away))
    moved = step * float(np.linalg.norm(away))
    assume(moved > 1e-6)
    time = np.array([10.0**late])
    apart = float(np.linalg.norm(one.sample(time) - other.sample(time)))
    rate = max(one.largest_norm, other.largest_norm) / np.sqrt(3.0)
    allowed = growth_factor((C - B) / A, (C - A) / B, (B - A) / C, rate * time[0])
    assert apart <= moved * allowed + 1e-13
    if min(B - A, C - B) <= 1e-14 and rate * time[0] < 1e4:
        # Nearly symmetric: in proportion to the time.
        assert allowed <= 3.0 * (1.0 + max((C - B) / A, (C - A) / B, (B - A) / C) * rate * time[0])


SIZES = st.floats(-2.0, 1.0).map(lambda x: 10.0**x)


@settings(deadline=None, derandomize=True, max_examples=draws(60))
@drawn(
    st.tuples(SIZES, SIZES, SIZES),
    st.tuples(st.floats(-10.0, 10.0), st.floats(-10.0, 10.0)).filter(lambda w: math.hypot(*w) > 0.1),
    st.floats(-12.0, -2.0).map(lambda x: 10.0**x),
    st.floats(0.0, 1e9),
)
def test_a_cylinder_spun_across_its_axis_keeps_its_phase(numbers, spin, uncertainty, time) -> None:
    """Radius, height and mass change its two equal moments together: it turns on as it does, however it is measured."""
    body = Cylinder(mass=numbers[0], radius=numbers[1], height=numbers[2]).mass_properties()
    rotation = TorqueFree(body, np.array([*spin, 0.0])).closed_form()
    # All that changes is the start, by the uncertainty of each component, which is that of its length.
    assert uncertainty <= rotation.inherited(np.array([time]), uncertainty) <= uncertainty * (1.0 + 10.0 * uncertainty)
    assert rotation.horizon_of(uncertainty) is None


def test_a_coin_known_to_a_thousandth_is_known_to_a_thousandth() -> None:
    coin = TorqueFree(
        Cylinder(mass=5e-3, radius=0.011625, height=0.00233).mass_properties(), np.array([10.0, 3.0, 0.0])
    )
    found = solve(coin, [0.0, 40.0, 4e6], input_uncertainty=1e-3)
    assert found.accuracy.inherited == pytest.approx(1e-3, rel=0.01)
    assert found.warnings == ()


def moved_apart(moments, spin, signs, uncertainty, times) -> float:
    """Return how far a motion is from that of moved moments and start, relative to its largest norm."""
    scale = 1.0 + uncertainty * np.array(signs)
    one = TorqueFree(diagonal(tuple(moments)), np.array(spin)).closed_form()
    other = TorqueFree(diagonal(tuple(scale[:3] * moments)), scale[3:] * spin).closed_form()
    return float(np.linalg.norm(one.sample(times) - other.sample(times), axis=1).max()) / one.largest_norm


MOMENT = st.floats(-6.0, 0.0).map(lambda x: 10.0**x) | st.sampled_from([1.0, 1.0 + 1e-6, 1.0 + 1e-3, 1e-5])
RATE = st.just(0.0) | st.floats(-4.0, 0.0).map(lambda x: 10.0**x) | st.floats(-4.0, 0.0).map(lambda x: -(10.0**x))


@settings(deadline=None, derandomize=True, max_examples=draws(300))
@drawn(
    st.tuples(MOMENT, MOMENT, MOMENT),
    st.tuples(RATE, RATE, RATE).filter(any),
    st.floats(-9.0, -1.0).map(lambda x: 10.0**x),
    st.floats(-5.0, 5.0).map(lambda x: 10.0**x),
    st.lists(st.tuples(*6 * [st.sampled_from([-1, 1])]), min_size=1, max_size=4),
)
# A body with one small moment, whose other two may come to differ: its rate may grow twelvefold.
@example((1e-5, 1.0, 1.0), (1.0, 2.0, -0.7), 1e-3, 93.0, [(1, 1, -1, 1, 1, 1), (1, -1, 1, 1, 1, 1)])
# A small nutation whose frequency and phase change by as much as a sixth.
@example(
    (0.0013011378074693186, 1.0, 1.0016110749384517), (0.0, -5.1e-05, 0.0033284205123343606), 1.1678e-4, 1.3774,
    [(1, 1, -1, 1, -1, -1)],
)  # fmt: skip
# The latest time lies between two phases of a later half period.
@example(
    (1.0, 1.0602866316402124e-06, 1.0021368540002524), (0.000608175061318332, -0.009829312716, -0.36898285412),
    2.325971261867971e-09, 0.0717943, [(s, t, u, v, w, x) for s, t, u, v, w, x in product(*6 * [(-1, 1)])],
)  # fmt: skip
def test_what_is_stated_bounds_the_change_and_is_infinite_where_nothing_does(
    moments, spin, uncertainty, turned, signs
) -> None:
    moments, spin = np.array(moments), np.array(spin)
    latest = turned / float(np.linalg.norm(spin))
    times = latest * np.array([1.0, -1.0, 0.77, 0.5, -0.3])
    try:
        rotation = TorqueFree(diagonal(tuple(moments)), spin).closed_form()
        stated = rotation.inherited(times, uncertainty)
        changes = [moved_apart(moments, spin, which, uncertainty, times) for which in signs]
    except AccuracyUnreachable:
        return  # Beyond 2^48 periods, or too near the separatrix.
    # Both motions are right to a few units of 2^-53.
    assert max(changes) <= stated + 1e-14
    assert stated < 0.12 or stated == math.inf


def test_where_the_phase_is_lost_no_figure_is_stated_and_a_warning_says_so() -> None:
    needle = TorqueFree(diagonal((1e-5, 1.0, 1.0)), np.array([1.0, 2.0, -0.7]))
    found = solve(needle, np.linspace(0.0, 40.0, 81), input_uncertainty=1e-3)
    assert found.accuracy.inherited is None
    assert [(notice.code, notice.path) for notice in found.warnings] == [("phase-lost", ("times",))]
    # No figure that the largest norm bounds would be true.
    times = np.linspace(0.0, 40.0, 4001)
    assert moved_apart(np.array([1e-5, 1.0, 1.0]), [1.0, 2.0, -0.7], (1, 1, -1, 1, 1, 1), 1e-3, times) > 5.0
    known = solve(needle, [1e-4], input_uncertainty=1e-3)
    assert known.accuracy.inherited is not None
    assert known.warnings == ()
