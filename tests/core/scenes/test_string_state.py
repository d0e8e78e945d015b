"""Constants and states of two shafts against momentum, energy and the equations of motion, in rational arithmetic."""

from __future__ import annotations

from fractions import Fraction

from flint import arb
from hypothesis import given, settings
from hypothesis import strategies as st

from core.balls import precision
from core.scenes.enclosure import BITS, ZERO, exact
from core.scenes.string_state import Constants, Drive, State, frictionless

positive = st.fractions(Fraction(1, 5), 5, max_denominator=20)
number = st.fractions(-3, 3, max_denominator=20)
pair = st.tuples(number, number)
given_constants = st.tuples(*3 * [st.tuples(positive, positive)])


def balls(numbers):
    return tuple(map(exact, numbers))


def constants_of(masses, factors, pulls) -> Constants:
    return Constants(balls(masses), (exact(1.0), exact(1.0)), balls(factors), balls(pulls), (ZERO, ZERO))


def state_of(x, v, s, r, slack=Fraction(0)) -> State:
    slips = [a - b for a, b in zip(v, r, strict=True)]
    return State(ZERO, balls(x), balls(v), balls(s), balls(r), exact(slack), exact(-sum(slips)), balls(slips))


def near(ball, want: Fraction) -> None:
    assert ball.overlaps(exact(want))
    assert ball.rad() < arb(2) ** -200


@settings(deadline=None, derandomize=True, max_examples=30)
@given(given_constants)
def test_what_a_jerk_moves(given_three) -> None:
    """A unit of impulse closes the string by sum (1/M + 1/Mc); shares are each shaft's part of that."""
    masses, factors, pulls = given_three
    with precision(BITS):
        constants = constants_of(masses, factors, pulls)
        linear, turning = [1 / m for m in masses], [1 / (m * c) for m, c in zip(masses, factors, strict=True)]
        whole = sum(linear) + sum(turning)
        near(constants.harmonic, 1 / whole)
        (x1, x2), (s1, s2) = constants.yields
        for found, want in ((x1, linear[0]), (x2, linear[1]), (s1, turning[0]), (s2, turning[1])):
            near(found, want / whole)
        near(sum(constants.shares, ZERO), Fraction(1))


@settings(deadline=None, derandomize=True, max_examples=30)
@given(given_constants, pair, pair, positive, st.fractions(0, 1, max_denominator=12))
def test_a_jerk_takes_the_energy_that_its_restitution_leaves_over(given_three, v, r, closing, e) -> None:
    masses, factors, pulls = given_three
    # Closing at the given velocity: u_1 + u_2.
    r = (r[0], sum(v) - r[0] - closing)
    with precision(BITS):
        constants = constants_of(masses, factors, pulls)
        after = state_of((0, 0), v, (0, 0), r).after_impulse(constants, exact(closing), exact(e))

        def kinetic(velocities, rates):
            return (
                sum(
                    (
                        exact(m) * (a * a + exact(c) * b * b)
                        for m, c, a, b in zip(masses, factors, velocities, rates, strict=True)
                    ),
                    ZERO,
                )
                / 2
            )

        lost = kinetic(balls(v), balls(r)) - kinetic(after.velocities, after.rates)
        near(lost - (1 - exact(e) ** 2) * exact(closing) ** 2 * constants.harmonic / 2, Fraction(0))
        near(after.opening, e * closing)
        near(sum(after.slips, ZERO), -e * closing)
        for k in range(2):
            # The string passes its impulse on: M x' + M c s' of a shaft is not changed by it.
            m, c = exact(masses[k]), exact(factors[k])
            near(m * after.velocities[k] + m * c * after.rates[k], masses[k] * v[k] + masses[k] * factors[k] * r[k])
            near(after.slips[k] - (after.velocities[k] - after.rates[k]), Fraction(0))
        assert after.slack.is_zero()


@settings(deadline=None, derandomize=True, max_examples=30)
@given(given_constants, pair)
def test_smooth_slopes_and_a_taut_string_obey_newton(given_three, v) -> None:
    """M x'' = M g sin - T, M c s'' = T and x_1'' + x_2'' = s_1'' + s_2''."""
    masses, factors, pulls = given_three
    with precision(BITS):
        constants = constants_of(masses, factors, pulls)
        drive = frictionless(constants, state_of((0, 0), v, (0, 0), v))
        assert drive.kind == "taut"
        for k in range(2):
            m, c, g = exact(masses[k]), exact(factors[k]), exact(pulls[k])
            near(m * drive.positions[k] - m * g + drive.tension, Fraction(0))
            near(m * c * drive.unwound[k] - drive.tension, Fraction(0))
        near(sum(drive.slips, ZERO), Fraction(0))
        assert drive.closing.is_zero()
        free = frictionless(constants, state_of((0, 0), v, (0, 0), v, Fraction(1)))
        assert free.kind == "slack"
        for k in range(2):
            near(free.positions[k], pulls[k])
            assert free.unwound[k].is_zero()
        near(free.closing, sum(pulls))


@settings(deadline=None, derandomize=True, max_examples=30)
@given(pair, pair, pair, pair, pair, pair, positive)
def test_a_state_later_under_constant_accelerations(x, v, s, r, a, b, t) -> None:
    with precision(BITS):
        before = state_of(x, v, s, r, Fraction(1, 2))
        after = before.after(Drive("slack", ZERO, balls(a), balls(b)), exact(t))
        for k in range(2):
            near(after.positions[k], x[k] + v[k] * t + a[k] * t * t / 2)
            near(after.velocities[k], v[k] + a[k] * t)
            near(after.unwound[k], s[k] + r[k] * t + b[k] * t * t / 2)
            near(after.rates[k], r[k] + b[k] * t)
            near(after.slips[k], v[k] - r[k] + (a[k] - b[k]) * t)
        near(after.time, t)
        # Slackness is what the shafts have not drawn out: s_1 + s_2 - x_1 - x_2, by which it changes.
        gone = sum(v) * t + sum(a) * t * t / 2 - sum(r) * t - sum(b) * t * t / 2
        near(after.slack, Fraction(1, 2) - gone)
        near(after.opening, -sum(v) + sum(r) - (sum(a) - sum(b)) * t)


def test_without_inertia_the_spins_are_not_determined() -> None:
    with precision(BITS):
        assert not constants_of((1, 2), (0, 0), (1, 1)).determinate
        assert constants_of((1, 2), (0, 0), (1, 1)).harmonic.is_zero()
        assert constants_of((1, 2), (0, 1), (1, 1)).determinate
