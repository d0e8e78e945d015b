"""Stability against numerical eigenvalues of the linearised equation at 50 digits, and against the full motion."""

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.composite import Composite, Part
from core.bodies.exact_inertia import ExactInertia
from core.bodies.mass_properties import MassProperties, diagonal
from core.bodies.measured import PointMasses
from core.bodies.solids import Cuboid, Cylinder, Disc
from core.certified.stability import certified_stability
from core.errors import InvalidParameter, NotApplicable
from core.rotation.free_rotation import FreeRotation
from core.rotation.precession.precession import precession
from core.rotation.stability.stability import stability
from tests.core.bodies.exact_tensors import of_tensor
from tests.drawn import draws
from tests.oracles.cases import T_HANDLE
from tests.oracles.free_rotation import flip_interval

moment = st.floats(1e-3, 1e3)
deck = (3.310e-5, 6.267e-5, 9.175e-5)


def jacobian(moments, axis: int, rate: float) -> mpmath.matrix:
    """Linearise I1 w1' = (I2 - I3) w2 w3 and cyclic about a spin along one axis, by the product rule."""
    w = [mpmath.mpf(rate) if k == axis else mpmath.mpf(0) for k in range(3)]
    matrix = mpmath.zeros(3)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        factor = (mpmath.mpf(moments[j]) - mpmath.mpf(moments[k])) / mpmath.mpf(moments[i])
        matrix[i, j] += factor * w[k]
        matrix[i, k] += factor * w[j]
    return matrix


@settings(deadline=None, max_examples=draws(60), derandomize=True)
@given(st.tuples(moment, moment, moment).filter(lambda i: len(set(i)) == 3), st.floats(1e-3, 1e3))
def test_eigenvalues_are_those_of_the_linearised_equation(moments, rate):
    found = stability(diagonal(moments), rate)
    for equilibrium in found.equilibria[:3]:
        axis = int(np.argmax(equilibrium.axis))
        assert equilibrium.moment == moments[axis]
        with mpmath.workdps(50):
            wanted = sorted(
                mpmath.eig(jacobian(moments, axis, rate), left=False, right=False),
                key=lambda x: (float(mpmath.re(x)), float(mpmath.im(x))),
            )
            got = sorted(equilibrium.eigenvalues)
            size = max(abs(x) for x in wanted)
            assert size > 0
            # The QR algorithm's own error, at 50 digits and a double eigenvalue, is far below a double's.
            for (re, im), want in zip(got, wanted, strict=True):
                assert abs(mpmath.mpc(re, im) - want) <= 2.0**-52 * size


@pytest.mark.parametrize("gap", [2.0**-20, 2.0**-40, 2.0**-52])
def test_differences_of_nearly_equal_moments_are_exact(gap):
    found = stability(diagonal((1.0, 1.0 + gap, 2.0)))
    square = Fraction(gap) * (2 - Fraction(1.0 + gap)) / 2
    with mpmath.workdps(40):
        want = mpmath.sqrt(mpmath.mpf(square.numerator) / square.denominator)
        assert abs(found.equilibria[1].growth_rate - want) <= 2.0**-53 * want
    assert [notice.code for notice in found.warnings] == (["moments-nearly-equal"] if gap < 1e-15 else [])


@pytest.mark.parametrize("scale", [1e-150, 1.0, 1e150])
@pytest.mark.parametrize("rate", [1e-150, -1.0, 1e150])
def test_free_of_scale(scale, rate):
    found = stability(diagonal(tuple(scale * x for x in (1.0, 2.0, 3.0))), rate)
    assert not found.warnings
    assert found.equilibria[1].growth_rate == pytest.approx(abs(rate) / math.sqrt(3.0), rel=4e-16)
    assert [e.kind for e in found.equilibria] == ["center", "saddle", "center", "degenerate"]


def test_values_outside_the_range_of_doubles_are_none_with_a_warning():
    found = stability(diagonal((1e-300, 1e300, 2e300)), 1e300)
    lost = [k for k, e in enumerate(found.equilibria) if e.eigenvalues is None]
    assert lost
    told = [notice for notice in found.warnings if notice.code == "out-of-range"]
    # Paths lead into the question; which equilibrium it is stands in the words.
    assert {notice.path for notice in told} == {("rate",)}
    assert [notice.detail.split()[3] for notice in told] == [str(k) for k in lost]


@pytest.mark.parametrize("moments", [deck, T_HANDLE, (1.0, 2.0, 3.0), (3.0, 1.0, 2.0)])
def test_only_the_middle_axis_is_unstable(moments):
    low, middle, high, rest = stability(diagonal(moments)).equilibria
    assert (low.stable, middle.stable, high.stable, rest.stable) == (True, False, True, True)
    assert (low.linearly_stable, middle.linearly_stable, high.linearly_stable) == (True, False, True)
    assert (low.attitude, middle.attitude, high.attitude, rest.attitude) == (
        "orbital",
        "unstable",
        "orbital",
        "unstable",
    )
    assert low.growth_rate == high.growth_rate == 0.0 < middle.growth_rate
    assert [e.survives_dissipation for e in (low, middle, high, rest)] == [False, False, True, False]
    assert "energy-Casimir" in low.reason
    assert "smallest" in low.reason
    assert "largest" in high.reason


@pytest.mark.parametrize("moments", [(1.0, 2.0, 3.0), deck])
def test_the_full_motion_confirms_the_classification(moments):
    for k, equilibrium in enumerate(stability(diagonal(moments)).equilibria[:3]):
        start = np.full(3, 1e-6)
        start[k] = 1.0
        motion = FreeRotation(diagonal(moments).principal, start)
        farthest = np.abs(motion.sample(np.linspace(0.0, 200.0, 4001)) - start).max()
        assert farthest < 1e-4 if equilibrium.stable else farthest > 1.0


def test_growth_rate_is_the_one_of_the_full_motion():
    moments, start = (1.0, 2.0, 3.0), np.array([1e-9, 1.0, 1e-9])
    rate = stability(diagonal(moments)).equilibria[1].growth_rate
    motion = FreeRotation(diagonal(moments).principal, start)
    early, late = np.abs(motion.sample(np.array([8.0, 12.0]))[:, 0])
    assert math.log(late / early) / 4.0 == pytest.approx(rate, rel=1e-3)


def test_spin_in_the_plane_of_two_equal_moments_drifts_linearly_and_stays_bounded():
    body = diagonal((1.0, 1.0, 2.0))
    found = stability(body, 3.0)
    spun = found.equilibria[0]
    assert (spun.kind, spun.stable, spun.linearly_stable, spun.growth_rate) == ("degenerate", False, False, 0.0)
    assert set(spun.eigenvalues) == {(0.0, 0.0)}
    assert "Jordan block" in spun.reason
    with mpmath.workdps(50):
        j = jacobian((1.0, 1.0, 2.0), 0, 3.0)
        assert mpmath.norm(j) > 1
        assert mpmath.norm(j * j) == 0
        assert spun.drift_rate == max(abs(x) for x in j)
    small = 1e-6
    motion = FreeRotation(body.principal, np.array([3.0, 0.0, small]))
    assert motion.sample(np.array([10.0]))[0, 1] == pytest.approx(10.0 * spun.drift_rate * small, rel=1e-6)
    half_way = motion.sample(np.array([math.pi / small]))[0]
    assert half_way == pytest.approx([-3.0, 0.0, small], abs=1e-9)
    assert not spun.survives_dissipation
    assert found.equilibria[2].survives_dissipation
    assert all(e.survives_dissipation for e in stability(diagonal((1.0, 2.0, 2.0))).equilibria[1:3])


def test_sphere_is_neutral_and_rest_is_an_equilibrium():
    for equilibrium in stability(diagonal((2.0, 2.0, 2.0))).equilibria[:3]:
        assert (equilibrium.kind, equilibrium.stable, equilibrium.drift_rate) == ("degenerate", True, 0.0)
        assert "neutral" in equilibrium.reason
    for equilibrium in stability(diagonal((1.0, 2.0, 3.0)), 0.0).equilibria:
        # The four are one and the same state.
        assert not equilibrium.survives_dissipation
        assert (equilibrium.kind, equilibrium.stable, equilibrium.attitude) == ("degenerate", True, "unstable")
        assert set(equilibrium.eigenvalues) == {(0.0, 0.0)}


@pytest.mark.parametrize(
    "kind",
    [Disc(radius=0.3, mass=2.0), Cylinder(radius=0.2, height=1.1, mass=3.3), Cuboid(edges=(0.3, 0.3, 0.3), mass=1.0)],
)
@pytest.mark.parametrize("attitude", [(0.3, 0.1, -0.7, 0.2), (0.7, 0.1, 0.2, 0.9), (1e-3, 1.0, 2e-5, 0.3)])
def test_a_turned_solid_is_what_it_is_along_its_axes(kind, attitude):
    straight = stability(kind.mass_properties(), 2.0)
    turned = stability(Composite((Part(kind, attitude=attitude),)).mass_properties(), 2.0)
    assert turned.warnings == ()
    for found, want in zip(turned.equilibria, straight.equilibria, strict=True):
        assert (found.kind, found.stable, found.reason) == (want.kind, want.stable, want.reason)
        assert np.array(found.eigenvalues) == pytest.approx(np.array(want.eigenvalues), rel=1e-14)


def test_coin_in_turned_axes_is_still_a_coin():
    c, s = math.cos(0.7), math.sin(0.7)
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    tensor = turn @ np.diag([1.0, 1.0, 2.0]) @ turn.T
    tensor = 0.5 * (tensor + tensor.T)
    found = stability(MassProperties(tensor, np.zeros((3, 3))))
    assert [e.kind for e in found.equilibria] == ["degenerate", "degenerate", "center", "degenerate"]
    assert [notice.code for notice in found.warnings] in ([], ["moments-equal-within-rounding"])
    assert np.abs(found.equilibria[2].axis) == pytest.approx(np.abs(turn[:, 2]), abs=1e-15)


@pytest.mark.parametrize(("low", "high"), [(1e-6, 1e-6), (0.0, 1e-140), (-0.1, 0.3)])
def test_flip_interval_of_a_disturbed_rotation_about_the_middle_axis(low, high):
    flip = stability(diagonal((2.0, 3.0, 1.0)), 2.0, (low, high)).flip
    want = flip_interval((1.0, 2.0, 3.0), (low, 2.0, high))
    assert abs(flip.interval - want) <= 4e-16 * want


def test_flip_does_not_exist_on_the_separatrix_nor_without_a_middle_axis():
    assert stability(diagonal((14.0, 21.0, 24.0)), 5.0, (6.0, 7.0)).flip.interval is None
    assert stability(diagonal((14.0, 21.0, 24.0)), 5.0, (0.0, 0.0)).flip.interval is None
    with pytest.raises(NotApplicable, match="no middle axis"):
        stability(diagonal((1.0, 1.0, 2.0)), 1.0, (0.1, 0.1))


@pytest.mark.parametrize("rate", [math.inf, math.nan])
def test_refusals(rate):
    with pytest.raises(InvalidParameter, match="rate"):
        stability(diagonal((1.0, 2.0, 3.0)), rate)
    with pytest.raises(InvalidParameter, match="disturbance"):
        stability(diagonal((1.0, 2.0, 3.0)), 1.0, (rate, 0.0))
    with pytest.raises(InvalidParameter, match="greater than 0"):
        stability(diagonal((0.0, 1.0, 1.0)))


def test_a_body_pinned_away_from_its_centre_of_mass_has_the_warning_not_free():
    body = PointMasses(1.0, [[1, 0, 0], [0, 2, 0], [0, 0, 3], [1, 1, 1]], "origin").mass_properties()
    assert "not-free" in {notice.code for notice in stability(body).warnings}
    assert "not-free" in {notice.code for notice in precession(body, np.array([1.0, 2.0, 3.0])).warnings}


@pytest.mark.parametrize(("disturbance", "turns_over"), [((0.01, 0.01), True), ((20.0, 0.01), False)])
def test_a_flip_is_said_of_a_body_that_turns_over_and_of_no_other(disturbance, turns_over):
    flip = stability(diagonal((1.0, 2.0, 3.0)), 2.0, disturbance).flip
    assert flip.interval is not None
    assert flip.reason.startswith("it turns over every half period") == turns_over
    assert ("never turns over" in flip.reason) != turns_over
    exact = certified_stability(ExactInertia.of_moments((1, 2, 3)), 2, 20, disturbance).flip
    assert exact.reason.split(";")[0] == flip.reason.split(";")[0]
    oblique = of_tensor([[2, 1, 0], [1, 3, 0], [0, 0, 5]])
    assert certified_stability(oblique, 2, 20, disturbance).flip.reason.startswith("it turns") == turns_over


def bounded(body: MassProperties, exact: ExactInertia, rate: float, disturbance=None) -> int:
    """Compare the errors that are stated with proven digits, and return how many there are."""
    found = stability(body, rate, disturbance)
    true = certified_stability(exact, rate, 60, disturbance)
    count = 0
    with mpmath.workdps(60):
        for one, other in zip(found.equilibria, true.equilibria, strict=True):
            errors = one.errors
            pairs = [(one.growth_rate, other.growth_rate, errors.eigenvalue)]
            pairs.append((one.drift_rate, other.drift_rate, errors.drift_rate))
            for figures, digits in zip(one.eigenvalues[:2], other.eigenvalues[:2], strict=True):
                pairs.extend(zip(figures, digits, [errors.eigenvalue] * 2, strict=True))
            if one.moment is not None:
                pairs.append((one.moment, other.moment, errors.moment))
            if found.flip is not None and found.flip.interval is not None:
                pairs.append((found.flip.interval, true.flip.interval, found.flip.error))
            for figure, digits, error in pairs:
                wrong = abs(mpmath.mpf(figure) - mpmath.mpf(digits))
                assert wrong <= error + mpmath.mpf(10) ** -55 * abs(figure)
                # No bound is much wider than rounding where moments are given.
                assert not (figure and body.principal.rounding.exact_zeros) or error <= 2.0**-52 * abs(figure)
                count += 1
    return count


@settings(deadline=None, max_examples=25, derandomize=True)
@given(st.tuples(moment, moment, moment), st.floats(1e-3, 1e3), st.floats(1e-3, 1.0), st.floats(1e-3, 1.0))
def test_errors_of_given_moments_bound_the_distance_from_proven_digits(moments, rate, small, large):
    different = len(set(moments)) == 3
    disturbance = (small, large) if different else None
    assert bounded(diagonal(moments), ExactInertia.of_moments(moments), rate, disturbance) >= 8


@settings(deadline=None, max_examples=15, derandomize=True)
@given(st.lists(st.tuples(*[st.integers(-9, 9)] * 3), min_size=4, max_size=6, unique=True), st.floats(0.1, 10.0))
def test_errors_of_derived_moments_bound_the_distance_from_proven_digits(points, rate):
    tensor = [
        [sum((sum(x * x for x in p) if i == j else 0) - p[i] * p[j] for p in points) for j in range(3)]
        for i in range(3)
    ]
    if np.linalg.matrix_rank(np.array(points)) < 2:
        return
    body = PointMasses(1.0, [list(p) for p in points], "origin").mass_properties()
    assert bounded(body, of_tensor(tensor), rate) >= 8
