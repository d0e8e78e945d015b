"""Corners where something is known exactly: zeros, equal moments, axes, judged by ball arithmetic.

The bodies are solids, points, tensors and composites turned by rational rotations, their moments equal, nearly equal or
far apart, down to subnormal magnitudes; the judge takes the same description in rational numbers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.bodies.composite import Composite, Part
from core.bodies.exact import rotated, rotation
from core.bodies.exact_bodies import exact_body
from core.bodies.exact_inertia import ExactInertia
from core.bodies.measured import InertiaTensor, PointMasses, PrincipalMoments
from core.bodies.solids import Cone, Cuboid, Cylinder, Ellipsoid
from core.certified.free_rotation import CertifiedRotation
from core.certified.precession import certified_precession
from core.errors import AccuracyUnreachable
from core.rotation.attitude.free_attitude import FreeAttitude
from core.rotation.ensemble import ensemble
from core.rotation.free_rotation import FreeRotation
from core.rotation.precession.precession import precession
from core.rotation.stability.stability import stability
from core.rotation.torque_free import TorqueFree
from core.systems.methods import ExplicitEuler, RungeKutta4
from core.systems.solve import solve
from core.work_precision import work_precision
from tests.core.certified.judge import OWN_ERROR, distance_of_rows
from tests.drawn import draws

DIGITS = 40
ULP = 2.0**-52
DECK = Cuboid(edges=(0.088, 0.063, 0.016), mass=0.094)

plain = settings(deadline=None, derandomize=True, max_examples=draws(120))
length = st.floats(0.01, 10.0).map(lambda x: float(f"{x:.3g}"))
whole = st.integers(1, 30)
nearness = st.sampled_from((0.0, ULP, 2 * ULP, 8 * ULP, 100 * ULP, 1e-9, 0.3))
hair = st.one_of(st.just(0.0), st.floats(-40.0, -2.0).map(lambda x: 10.0**x))
quaternion = st.tuples(*4 * [st.integers(-6, 6)]).filter(lambda q: any(q[1:]))


@st.composite
def solids(draw: st.DrawFn) -> Any:
    """Return a solid whose axes are the body's, two of its dimensions often equal or nearly so."""
    a, c = draw(length), draw(length)
    b = draw(st.one_of(length, nearness.map(lambda d: a * (1.0 + d))))
    return draw(
        st.sampled_from(
            (
                Cuboid(edges=(a, b, c), mass=0.7),
                Ellipsoid(semi_axes=(a, b, c), mass=0.7),
                Cylinder(radius=a, height=c, mass=0.7),
                Cone(radius=a, height=c, mass=0.7),
            )
        )
    )


@st.composite
def moments_of_matter(draw: st.DrawFn) -> list[float]:
    """Return whole principal moments, two or three of them often equal or nearly so."""
    a, c = float(draw(whole)), float(draw(whole))
    b = draw(st.one_of(whole.map(float), nearness.map(lambda d: a * (1.0 + d))))
    three = [a, b, draw(st.sampled_from((c, a, a * (1.0 + 2 * ULP))))]
    assume(2.0 * max(three) <= sum(three))
    return three


def described(body: Any) -> dict[str, Any]:
    """Return a body as the judge reads it."""
    fields = {name: value for name, value in vars(body).items() if value is not None and not name.startswith("_")}
    if isinstance(body, Composite):
        return {
            "kind": "composite",
            "parts": [{"body": described(p.body), "attitude": p.attitude, "position": p.position} for p in body.parts],
        }
    return {"kind": body.kind} | fields


def judged(motion: FreeRotation, judge: CertifiedRotation, times: Sequence[float]) -> tuple[float, float]:
    """Return true and stated error of the angular velocity, having judged the attitude as well."""
    instants = np.array(times)
    got, stated = motion.sample(instants), motion.error(instants)
    rates, attitudes = judge.trajectory(list(times), DIGITS)
    largest = Fraction(judge.largest_rate(DIGITS))
    error = float(distance_of_rows(got, rates) / largest) if largest else 0.0
    assert error <= stated + OWN_ERROR
    turning = FreeAttitude(motion, np.array([1.0, 0.0, 0.0, 0.0]))
    turned = turning.error(instants)
    if turned < math.pi:
        assert 2.0 * float(distance_of_rows(turning.sample(instants), attitudes)) <= turned + OWN_ERROR
    return error, stated


def certified(body: Any, spin: Sequence[float]) -> CertifiedRotation:
    return CertifiedRotation.of(exact_body(described(body)).of_motion, list(map(float, spin)))


def columns(turn: list[list[Fraction]]) -> list[np.ndarray]:
    """Return the axes of a rational rotation as whole vectors."""
    common = math.lcm(*(x.denominator for row in turn for x in row))
    return [np.array([float(turn[i][k] * common) for i in range(3)]) for k in range(3)]


@plain
@given(solids(), st.integers(0, 2), st.floats(-3.0, 2.0), st.floats(-1.0, 9.0))
def test_a_solid_spun_exactly_about_an_axis_is_constant_for_ever(solid, axis, size, late):
    spin = np.zeros(3)
    spin[axis] = 10.0**size
    body, times = solid.mass_properties(), np.array([0.0, 10.0**late])
    found = solve(TorqueFree(body, spin), times)
    assert found.accuracy.error == 0.0
    assert np.array_equal(found.state, [spin, spin])
    # Beside it in an ensemble, and as the reference of a method, it decides nothing.
    many = ensemble(body, np.array([spin, [1.0, 2.0, 3.0]]), np.array([0.0, 30.0]))
    assert many.error < 1e-12
    step = 0.01 * 10.0**-size
    short = np.array([100.0 * step])
    for method in (ExplicitEuler(step), RungeKutta4(step)):
        assert solve(TorqueFree(body, spin), short, method=method).accuracy.error == 0.0
    assert work_precision(TorqueFree(body, spin), times, [RungeKutta4(10.0**late)]).reference_error == 0.0


@plain
@given(solids(), st.sampled_from(((0.0, 3.0, 4.0), (5.0, 0.0, 2.0), (1.0, 7.0, 0.0))), st.floats(-1.0, 9.0))
def test_a_spin_in_the_plane_of_exactly_equal_moments_is_constant_for_ever(solid, spin, late):
    judge = certified(solid, spin)
    motion = FreeRotation(solid.mass_properties().principal, np.array(spin))
    assert (motion.model.regime.endswith("steady rotation")) == (judge.regime == "steady")
    if judge.regime == "steady":
        assert motion.error(np.array([10.0**late])) == 0.0


@plain
@given(solids(), st.integers(0, 2), hair, hair, st.floats(-1.0, 3.0))
def test_no_component_of_a_solid_is_too_small_to_count(solid, axis, first, second, late):
    spin = np.zeros(3)
    spin[axis], spin[axis - 1], spin[axis - 2] = 10.0, 10.0 * first, -10.0 * second
    body, judge = solid.mass_properties(), certified(solid, spin)
    motion = FreeRotation(body.principal, spin)
    assert (motion.period is None) == (judge.regime != "periodic")
    figures = precession(body, spin)
    if motion.period is not None:
        period = Fraction(judge.period(DIGITS))
        # Moments are rounded to 106 bits, and their differences by as much of the moments.
        low, middle, high = sorted(exact_body(described(solid)).of_motion.tensor[k][k] for k in range(3))
        lost = max(high / gap for gap in (middle - low, high - middle) if gap)
        allowed = 4 * Fraction(2) ** -53 + Fraction(2) ** -104 * lost
        assert abs(Fraction(motion.period) - period) <= allowed * period
        assert figures.period == pytest.approx(motion.period, rel=4e-16)
    unit = min(motion.period or 1.0, 1e6)
    judged(motion, judge, [unit * 10.0**late, 0.3 * unit])


@plain
@given(st.floats(-300.0, -1.0))
def test_a_disturbance_of_a_solid_is_distinguished_from_none(exponent):
    small = 10.0**exponent
    try:
        flip = stability(DECK.mass_properties(), 10.0, (small, 0.0)).flip
    except AccuracyUnreachable:
        assert small < 1e-280
        return
    moments = sorted(exact_body(described(DECK)).of_motion.tensor[k][k] for k in range(3))
    along = CertifiedRotation.of(
        ExactInertia(tuple(tuple(moments[i] if i == j else Fraction(0) for j in range(3)) for i in range(3))),
        (small, 10.0, 0.0),
    )
    assert flip.interval == pytest.approx(float(along.flip_interval(20)), rel=4e-16)


def test_the_deck_of_cards_and_the_tilted_coin():
    """Digits by ball arithmetic."""
    deck, spin = DECK.mass_properties(), np.array([1e-30, 10.0, 0.0])
    want = float(certified(DECK, spin).period(25))
    assert want == pytest.approx(54.66752199378274, rel=1e-16)
    assert abs(precession(deck, spin).period - want) <= math.ulp(want)
    coin = InertiaTensor(((1.36, 0.0, 0.48), (0.0, 1.0, 0.0), (0.48, 0.0, 1.64)))
    motion = FreeRotation(coin.mass_properties().principal, np.array([0.8, 0.5, -0.6]))
    _, stated = judged(motion, certified(coin, (0.8, 0.5, -0.6)), [30.0])
    assert stated < 1.1e-15
    assert motion.sample(np.array([30.0]))[0] == pytest.approx(
        [0.799999999999997, 0.500000000000009, -0.599999999999997], abs=2e-15
    )


@plain
@given(moments_of_matter(), quaternion, st.tuples(st.integers(-5, 5), st.integers(-5, 5), st.integers(0, 1)), hair,
       st.floats(-1.0, 4.0))  # fmt: skip
def test_tensors_turned_by_rational_rotations(three, q, along, small, late):
    turn = rotation([Fraction(x) for x in q])
    exact = [[Fraction(three[i]) * (i == j) for j in range(3)] for i in range(3)]
    tensor = InertiaTensor(tuple(tuple(float(x) for x in row) for row in rotated(exact, turn)))
    axes = columns(turn)
    spin = sum(x * axis for x, axis in zip(along, axes, strict=True)) + small * axes[0] + 0.0
    assume(np.any(spin))
    spin = spin / 2.0 ** math.frexp(np.abs(spin).max())[1]
    motion = FreeRotation(tensor.mass_properties().principal, spin)
    judge = certified(tensor, spin)
    _, stated = judged(motion, judge, [10.0**late, -0.7 * 10.0**late])
    low, middle, high = sorted(three)
    if min(middle - low, high - middle) <= 16 * ULP * high:
        # As a body that is symmetric within what doubles can tell: no exponential, whatever the spin.
        assert stated < 1e-14


@plain
@given(
    st.integers(2, 9), st.integers(1, 17), quaternion, st.integers(-5, 5), st.integers(1, 5), hair, st.floats(1.0, 5.0)
)
def test_a_tilted_coin_spun_about_a_diameter_is_bounded_as_a_coin(pair, single, q, one, other, small, late):
    """Its two equal moments differ by the rounding of the components, and the spin is next to their plane."""
    assume(single <= 2 * pair and single != pair)
    turn = rotation([Fraction(x) for x in q])
    exact = [[Fraction(single if i == 2 else pair) * (i == j) for j in range(3)] for i in range(3)]
    tensor = InertiaTensor(tuple(tuple(float(x) for x in row) for row in rotated(exact, turn)))
    axes = columns(turn)
    spin = one * axes[0] + other * axes[1] + small * axes[2] + 0.0
    spin = spin / 2.0 ** math.frexp(np.abs(spin).max())[1]
    motion = FreeRotation(tensor.mass_properties().principal, spin)
    _, stated = judged(motion, certified(tensor, spin), [10.0**late])
    assert stated < 1e-14


@plain
@given(st.one_of(solids(), moments_of_matter()), quaternion, st.integers(0, 2), st.floats(-1.0, 9.0))
def test_a_body_turned_by_a_rational_rotation_and_spun_along_its_own_axis_is_constant(body, q, axis, late):
    turn = rotation([Fraction(x) for x in q])
    spin = columns(turn)[axis]
    if isinstance(body, list):
        # A tensor of whole numbers, exactly.
        size = sum(x * x for x in q) ** 2
        exact = [[Fraction(round(body[i]) * size) * (i == j) for j in range(3)] for i in range(3)]
        turned = InertiaTensor(tuple(tuple(float(x) for x in row) for row in rotated(exact, turn)))
    else:
        turned = Composite((Part(body, attitude=tuple(map(float, q))),))
    assert certified(turned, spin).regime == "steady"
    motion = FreeRotation(turned.mass_properties().principal, spin)
    assert motion.model.regime.endswith("steady rotation")
    assert motion.error(np.array([10.0**late])) == 0.0
    assert precession(turned.mass_properties(), spin).regime == "steady"


@plain
@given(st.tuples(length, length, length), nearness, st.integers(0, 2), hair, st.floats(-1.0, 3.0))
def test_points_placed_symmetrically_have_exact_axes(sizes, near, axis, small, late):
    a, _, c = sizes
    b = a * (1.0 + near)
    points = [[s * x if k == j else 0.0 for k in range(3)] for j, x in enumerate((a, b, c)) for s in (1.0, -1.0)]
    body, spin = PointMasses(1.3, points), np.zeros(3)
    spin[axis], spin[axis - 1] = 2.0, 2.0 * small
    motion = FreeRotation(body.mass_properties().principal, spin)
    given_by_points = {"kind": "point-masses", "masses": 1.3, "positions": points}
    judge = CertifiedRotation.of(exact_body(given_by_points).of_motion, spin.tolist())
    assert (motion.period is None) == (judge.regime != "periodic")
    _, stated = judged(motion, judge, [10.0**late])
    if small == 0.0:
        assert stated == 0.0


@plain
@given(moments_of_matter(), st.tuples(*3 * [st.floats(-1.0, 1.0)]), st.floats(-323.0, -290.0), st.floats(-2.0, 3.0))
def test_rates_below_the_normal_doubles_are_bounded(three, direction, size, late):
    spin = [x * 10.0**size for x in direction]
    assume(any(spin))
    motion = FreeRotation(PrincipalMoments(tuple(three)).mass_properties().principal, np.array(spin))
    judge = CertifiedRotation.of_moments(three, spin)
    time = min(10.0**late / max(map(abs, spin)), 1e308)
    # The few starts whose distance from the middle axis no double holds are refused, as a test of their own says.
    with suppress(AccuracyUnreachable):
        judged(motion, judge, [time, 0.5 * time])


def test_a_motion_of_subnormal_rate_is_not_said_to_be_right():
    spin = np.full(3, 1e-316)
    system = TorqueFree(PrincipalMoments((1.0, 2.0, 3.0)).mass_properties(), spin)
    error, stated = judged(system.closed_form(), CertifiedRotation.of_moments((1, 2, 3), spin.tolist()), [1e308])
    assert 1e-8 < error <= stated < 1e-5
    with pytest.raises(AccuracyUnreachable):
        solve(system, [1e308])


@plain
@given(moments_of_matter(), st.tuples(*3 * [st.integers(-4, 4)]).filter(any))
def test_precession_says_what_ball_arithmetic_says(three, spin):
    """One rule for equal moments: what is periodic, and with which period, hangs on the moments as given."""
    found = precession(PrincipalMoments(tuple(three)).mass_properties(), tuple(map(float, spin)))
    judge = CertifiedRotation.of_moments(three, list(map(float, spin)))
    want = certified_precession(judge, 25)
    motion = FreeRotation(PrincipalMoments(tuple(three)).mass_properties().principal, np.array(spin, dtype=float))
    assert found.regime == want.regime
    for name in ("period", "flip_interval", "precession_per_period"):
        figure, exact = getattr(found, name), getattr(want, name)
        assert (figure is None) == (exact is None), name
        if figure is not None:
            assert figure == pytest.approx(float(exact), rel=1e-15), name
    assert motion.period == (None if found.period is None else pytest.approx(found.period, rel=4e-16))
    assert motion.flip_interval == (
        None if found.flip_interval is None else pytest.approx(found.flip_interval, rel=4e-16)
    )
    if len(set(three)) == 2 and want.body_rate is not None:
        assert found.body_rate == pytest.approx(float(want.body_rate), rel=1e-15)
    if found.body_rate == 0.0:
        assert found.period is None
