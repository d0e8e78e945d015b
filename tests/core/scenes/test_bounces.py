"""Infinitely many jerks in closed form against one jerk after the other in rational arithmetic.

A jerk is worked out here from its impulse J along the string: it takes J/M_i from the velocity of a shaft down its
slope and adds J R^2/I_i = J/(M_i c_i) to the rate of its string; J follows from Newton's hypothesis that the string
opens at e times the velocity with which it closed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

import pytest
from flint import arb
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.balls import precision
from core.scenes.bounces import Sequence
from core.scenes.enclosure import BITS, ZERO, exact
from core.scenes.quadratics import exit_time
from core.scenes.string_state import Constants, Drive, State

positive = st.fractions(Fraction(1, 5), 5, max_denominator=20)
number = st.fractions(-3, 3, max_denominator=20)
restitution = st.fractions(Fraction(1, 10), 1, max_denominator=12)


@dataclass(frozen=True)
class Arc:
    """Shafts at the beginning of an arc, in fractions."""

    masses: tuple[Fraction, Fraction]
    factors: tuple[Fraction, Fraction]
    slope_accelerations: tuple[Fraction, Fraction]
    unwinding: tuple[Fraction, Fraction]
    e: Fraction
    time: Fraction
    x: tuple[Fraction, ...]
    v: tuple[Fraction, ...]
    s: tuple[Fraction, ...]
    r: tuple[Fraction, ...]

    @property
    def opening(self) -> Fraction:
        return -sum(v - r for v, r in zip(self.v, self.r, strict=True))

    @property
    def length(self) -> Fraction:
        """Until slackness sigma' t - Gamma t^2/2 is nothing again."""
        gamma = sum(a - b for a, b in zip(self.slope_accelerations, self.unwinding, strict=True))
        return 2 * self.opening / gamma

    def next(self) -> Arc:
        t = self.length
        x = [p + t * (q + a * t / 2) for p, q, a in zip(self.x, self.v, self.slope_accelerations, strict=True)]
        v = [q + a * t for q, a in zip(self.v, self.slope_accelerations, strict=True)]
        s = [p + t * (q + a * t / 2) for p, q, a in zip(self.s, self.r, self.unwinding, strict=True)]
        r = [q + a * t for q, a in zip(self.r, self.unwinding, strict=True)]
        closing = sum(v) - sum(r)
        assert closing > 0
        gained = [(1 / m, 1 / (m * c)) for m, c in zip(self.masses, self.factors, strict=True)]
        impulse = (1 + self.e) * closing / sum(a + b for a, b in gained)
        v = [q - impulse * a for q, (a, _) in zip(v, gained, strict=True)]
        r = [q + impulse * b for q, (_, b) in zip(r, gained, strict=True)]
        after = replace(self, time=self.time + t, x=tuple(x), v=tuple(v), s=tuple(s), r=tuple(r))
        assert after.opening == self.e * closing
        return after

    def sequence(self) -> Sequence:
        def balls(numbers):
            return tuple(map(exact, numbers))

        constants = Constants(
            balls(self.masses),
            (exact(1.0), exact(1.0)),
            balls(self.factors),
            balls(self.slope_accelerations),
            (ZERO, ZERO),
        )
        slips = [v - r for v, r in zip(self.v, self.r, strict=True)]
        state = State(
            exact(self.time), balls(self.x), balls(self.v), balls(self.s), balls(self.r), ZERO, exact(self.opening),
            balls(slips),
        )  # fmt: skip
        return Sequence(
            constants,
            state,
            Drive("slack", ZERO, balls(self.slope_accelerations), balls(self.unwinding)),
            exact(self.e),
        )


@st.composite
def arcs(draw) -> Arc:
    pair = st.tuples(number, number)
    pulls = draw(st.tuples(positive, positive))
    v, first = draw(pair), draw(number)
    opening = draw(positive)
    # The second rate of unwinding is what makes the string open.
    return Arc(
        draw(st.tuples(positive, positive)), draw(st.tuples(positive, positive)), pulls,
        (Fraction(0), pulls[1] / 3), draw(restitution), draw(number), draw(pair), v, draw(pair),
        (first, opening + sum(v) - first),
    )  # fmt: skip


def same(found, wanted) -> None:
    for ball, want in zip(found, wanted, strict=True):
        assert ball.overlaps(exact(want))
        assert ball.rad() < arb(2) ** -200


@settings(deadline=None, derandomize=True, max_examples=25)
@given(arcs())
def test_every_arc_begins_where_the_jerk_before_left_off(arc: Arc) -> None:
    with precision(BITS):
        sequence = arc.sequence()
        for n in range(9):
            state = sequence.at(sequence.sum(n))
            same((state.time, *state.positions, *state.velocities, *state.unwound, *state.rates),
                 (arc.time, *arc.x, *arc.v, *arc.s, *arc.r))  # fmt: skip
            same((state.opening, *state.slips), (arc.opening, *(v - r for v, r in zip(arc.v, arc.r, strict=True))))
            same((sequence.first * sequence.ratio(sequence.sum(n)),), (arc.length,))
            arc = arc.next()


@settings(deadline=None, derandomize=True, max_examples=15)
@given(arcs().filter(lambda arc: arc.e <= Fraction(1, 2)))
def test_jerks_accumulate_where_two_hundred_of_them_have_led(arc: Arc) -> None:
    with precision(BITS):
        end = arc.sequence().accumulated()
        assert end.slack.is_zero()
        assert end.opening.is_zero()
        for _ in range(120):
            arc = arc.next()
        # What is left is e^120 < 1e-36 of the whole.
        for ball, near in zip(
            (end.time, *end.positions, *end.velocities, *end.rates), (arc.time, *arc.x, *arc.v, *arc.r), strict=True
        ):
            assert abs(ball - exact(near)) < arb(10) ** -30


def test_jerks_that_lose_nothing_never_accumulate() -> None:
    one = Fraction(1)
    none = 0 * one
    arc = Arc(
        (one, one), (one, one), (one, one), (none, none), one, none, (one, one), (none, none), (one, one),
        (one / 2, one / 2),
    )  # fmt: skip
    with precision(BITS):
        sequence = arc.sequence()
        assert sequence.limit is None
        assert float(sequence.sum(7)) == 7.0
        with pytest.raises(ValueError, match="do not accumulate"):
            sequence.accumulated()


def first_below(arc: Arc, shaft: int):
    """Return the arc in which x of a shaft first turns negative, as the sequence finds it from roots; None if never."""
    with precision(BITS):
        sequence = arc.sequence()
        acceleration = sequence.drive.positions[shaft]

        def leaves(state: State, length):
            time = exit_time(state.positions[shaft], state.velocities[shaft], acceleration)
            return time if time is not None and not time > length else None

        start, gain = sequence.start, sequence.gains()[0][shaft]
        margins = [(start.positions[shaft], start.velocities[shaft], acceleration, gain)]
        found = sequence.first_arc(margins, [], leaves)
        return None if found is None else found[0]


@settings(deadline=None, derandomize=True, max_examples=25)
@given(arcs(), st.sampled_from([0, 1]))
def test_the_first_arc_that_leaves_a_margin_is_the_first_of_all(arc: Arc, shaft: int) -> None:
    """Candidates come from roots; here one arc is looked at after the other."""
    arc = replace(arc, x=tuple(abs(x) + Fraction(1, 7) for x in arc.x))
    found = first_below(arc, shaft)
    for n in range(25):
        if lowest_of(arc, shaft) < 0:
            assert found == n
            return
        arc = arc.next()
    assert found is None or found >= 25


@settings(deadline=None, derandomize=True, max_examples=25)
@given(arcs(), st.sampled_from([0, 1]), st.integers(1, 9))
def test_arcs_are_candidates_where_the_lowest_point_between_jerks_changes_sign(arc: Arc, shaft: int, n: int) -> None:
    """Moving x moves every arc alike: the vertices x - v^2/2a of two arcs in turn are put around zero."""
    one = arc
    for _ in range(n):
        one = one.next()
    vertices = [
        each.x[shaft] - each.v[shaft] ** 2 / (2 * each.slope_accelerations[shaft]) for each in (one, one.next())
    ]
    assume(vertices[0] != vertices[1])
    arc = replace(arc, x=tuple(x - sum(vertices) / 2 for x in arc.x))
    with precision(BITS):
        sequence = arc.sequence()
        start, gain = sequence.start, sequence.gains()[0][shaft]
        margin = (start.positions[shaft], start.velocities[shaft], sequence.drive.positions[shaft], gain)
        assert {n, n + 1} <= set(sequence.candidates([margin], []))


def lowest_of(arc: Arc, shaft: int) -> Fraction:
    """Return the least x of a shaft on an arc."""
    return lowest(arc.x[shaft], arc.v[shaft], arc.slope_accelerations[shaft], arc.length)


def lowest(x: Fraction, v: Fraction, a: Fraction, length: Fraction) -> Fraction:
    """Return the least of x + v t + a t^2/2 on an arc, a > 0."""
    at = min(max(-v / a, Fraction(0)), length)
    return x + at * (v + a * at / 2)
