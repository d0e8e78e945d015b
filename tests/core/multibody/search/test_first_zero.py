"""The first zero of quantities along a motion that is known exactly: x = cos t, y = sin t."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from flint import arb
from mpmath import acos, cos, mp, mpf, pi, sin
from scipy.integrate import solve_ivp

from core.arrays import Floats
from core.balls import precision
from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import BITS
from core.multibody.language.reading import scene_from
from core.multibody.search import followed
from core.multibody.search.curves import Curve
from core.multibody.search.first_zero import FirstZero
from core.multibody.search.followed import Found
from core.multibody.search.location import located
from core.multibody.search.pieces import COEFFICIENTS, Pieces
from core.multibody.search.taylor import ORDER
from core.multibody.solve import solve_scene

LENGTH = 0.5


@pytest.fixture(autouse=True)
def exact_numbers() -> Iterator[None]:
    with precision(BITS), mp.workdps(50):
        yield


class Circle:
    """The motion, so many periods later, turned by an angle that another computation gets wrong."""

    def __init__(self, periods: int = 0, wrong: float = 0.0) -> None:
        self.periods, self.wrong = periods, wrong

    def __call__(self, times: Floats, reach: Floats) -> Pieces:
        lengths = np.copysign(np.minimum(LENGTH, 2.0 ** np.ceil(np.log2(np.abs(reach)))), reach)
        places = np.zeros((len(times), 2, ORDER + 1, 2))
        for p, (time, length) in enumerate(zip(times, lengths, strict=True)):
            angle = mpf(float(time)) + self.wrong - 2 * pi * self.periods + 2 * pi * self.periods
            turns = [cos(angle), -sin(angle), -cos(angle), sin(angle)]
            for k in range(ORDER + 1):
                share = mpf(float(length)) ** k / mp.factorial(k)
                for i, x in enumerate((turns[k % 4], turns[(k + 3) % 4])):
                    places[p, i, k] = float(x * share), float(x * share - float(x * share))
        sizes = np.max(np.abs(places[..., 0]), axis=1, keepdims=True).repeat(2, axis=1)
        nothing = np.zeros((len(times), 0, COEFFICIENTS, 2))
        return Pieces(lengths, np.full(len(times), LENGTH), places, sizes, nothing, nothing[..., 0])


def level(a: float | str, b: float = 1.0, c: float = 0.0) -> Callable[[Pieces], Curve]:
    """Return a + b x + c y."""
    poly = {(): arb(a), (0,): arb(b), (1,): arb(c)}
    return lambda pieces: pieces.of(poly)


def first(*quantities: Callable[[Pieces], Curve], end: float = 10.0, jumps: bool = True) -> Found | None:
    return FirstZero([Circle()], list(quantities), [jumps] * len(quantities), [0] * len(quantities)).until(end)


def exact(found: Found | None) -> mpf:
    assert found is not None
    return mpf(found.time) + mpf(found.rest)


def as_exact(ball: Any) -> mpf:
    mantissa, exponent = ball.mid().man_exp()
    return mpf(int(mantissa)) * mpf(2) ** int(exponent)


@pytest.mark.parametrize("share", [1e-2, 1e-5, 1e-9, 1e-12])
def test_below_zero_for_a_small_share_of_a_period_is_found(share: float) -> None:
    depth = 1 - cos(pi * mpf(share))
    found = first(level(mp.nstr(1 - depth, 50)))
    assert found is not None
    assert found.width == 0.0
    assert abs(exact(found) - (pi - pi * mpf(share))) <= 1e-30 / depth**0.5 + mpf(2) ** -90


def test_a_near_miss_is_no_zero_and_a_touch_undecided_from_both_sides() -> None:
    assert first(level("1.00000000000000000001")) is None
    for touch in ("1", "1.00000000000000000000000000000000001", "0.99999999999999999999999999999"):
        found = first(level(touch))
        assert found is not None
        # Of what is deeper by less than is known, both zeros are within.
        assert abs(mpf(found.time) - pi) + mp.sqrt(2 * max(0, 1 - mpf(touch))) <= found.width <= 1e-12
        # Where what follows is the same to within its error, nothing comes of it.
        assert first(level(touch), jumps=False) is None


@pytest.mark.parametrize(("quantity", "right"), [(level(0.0, 0.0, 1.0), math.pi), (level(-1e-3, 1e-3, 1.0), None)])
def test_a_zero_at_the_start_is_none(quantity: Callable[[Pieces], Curve], right: float | None) -> None:
    found = first(quantity)
    # y = e (1 - x) returns at the angle of twice the complement of e.
    assert abs(exact(found) - (pi if right is not None else pi - 2 * mp.atan(mpf("1e-3")))) <= 2e-16


def test_a_zero_that_follows_the_start_at_once_is_found() -> None:
    """y - 1e10 y^2 leaves zero and returns at 1e-10, known to 1e10 2^-96 of that."""
    found = first(lambda pieces: pieces.of({(1,): arb(1), (1, 1): arb("-1e10")}))
    assert float(exact(found)) == pytest.approx(1e-10, rel=1e-15)


def test_what_is_zero_throughout_has_no_zeros() -> None:
    one = {(0, 0): arb(1), (1, 1): arb(1), (): arb(-1)}
    assert first(lambda pieces: pieces.of(one)) is None
    # And does not hide what has one.
    found = first(lambda pieces: pieces.of(one), level("0.5"))
    assert found is not None
    assert found.index == 1


def test_an_event_in_the_last_ulp_before_the_end() -> None:
    quarter = math.pi / 2
    assert quarter < pi / 2
    right = pi / 2
    for end in (quarter, math.nextafter(quarter, 2.0)):
        assert abs(exact(first(level(0.0), end=end)) - right) <= 1e-30
    # One beyond the end may be told when it is in the last piece, and is told as beyond.
    beyond = first(level(0.0), end=math.nextafter(quarter, 1.0))
    assert beyond is None or exact(beyond) > quarter


def test_the_first_of_several_counts_and_time_may_run_backwards() -> None:
    found = first(level("0.5"), level("0.5000000001"), level("0.4999999999"))
    assert found is not None
    assert found.index == 2
    back = FirstZero([Circle()], [level("0.5", 1.0, 0.1)], [True], [0], -1.0).until(10.0)
    # 0.5 + x + 0.1 y = 0 backwards.
    size = mp.sqrt(mpf("1.01"))
    assert abs(exact(back) - (mp.atan2(mpf(1), 10) - acos(mpf("-0.5") / size))) <= 1e-15


def test_a_search_goes_on_where_it_ended() -> None:
    search = FirstZero([Circle()], [level("0.5")], [True], [0])
    assert search.until(1.0) is None
    assert search.until(2.0) is None
    assert abs(exact(search.until(4.0)) - 2 * mpf(pi) / 3) <= 1e-15


@pytest.mark.parametrize("gap", ["1e-300", "1e-100", "1e-40", "1e-30"])
def test_what_is_known_to_begin_above_zero_falls_below_however_little_above_it_is(gap: str) -> None:
    # x - 1 + gap is lost in the rounding of x = 1.
    quantity = level(mp.nstr(mpf(gap) - 1, 50))
    assert FirstZero([Circle()], [quantity], [True], [None]).until(1.0) is None
    found = FirstZero([Circle()], [quantity], [True], [0]).until(1.0)
    assert found is not None
    when = mp.acos(1 - mpf(gap))
    assert abs(exact(found) - when) <= found.unsure < 1e-12


def test_a_difference_of_two_computations_makes_a_touch_undecided() -> None:
    both = [Circle(), Circle(wrong=1e-9)]
    assert FirstZero(both[:1], [level("1.00000000000001", 1.0, 0.0)], [True], [0]).until(10.0) is None
    # x + 1 and its error 16e-9 |y| are zero at one time; with y beside it they are not.
    found = FirstZero(both, [level("1.00000000001", 1.0, 1e-4)], [True], [0]).until(10.0)
    assert found is not None


def test_ten_zeros_in_two_pieces_are_told_apart() -> None:
    """cos 32 t by doubled angles: the first zero, and the first that follows it where the sign is turned round."""

    def doubled(pieces: Pieces) -> Curve:
        total = pieces.place(0)
        for _ in range(5):
            total = pieces.of({(): arb(-1)}).plus(arb(2), total.times(total))
        return total

    assert abs(exact(first(doubled)) - pi / 64) <= 1e-15


def test_a_zero_is_located_to_pairs_with_its_state() -> None:
    quantity = level("0.3")
    found = first(quantity)
    assert found is not None
    state = located(Circle(), quantity, found.time, found.rest, 1.0)
    right = acos(mpf("-0.3"))
    assert abs(as_exact(state.time) - right) <= 1e-31
    for value, expected in zip([*state.q, *state.v], [cos(right), sin(right), -sin(right), cos(right)], strict=True):
        assert abs(as_exact(value) - expected) <= 1e-30


@pytest.mark.parametrize("a", [-0.3, -0.9, -0.999999])
def test_terms_that_are_wrong_by_a_share_move_a_zero_by_that_times_its_width(a: float) -> None:
    """The terms of a + x, whose errors add up, are |a| both at the zero, whose rate is that of the circle."""
    share = 2.0**-40
    found, moved = (first(quantity) for quantity in (level(a), level(a * (1 - share), 1 + share)))
    assert found is not None
    width = located(Circle(), level(a), found.time, found.rest, 1.0).width
    true = abs(exact(moved) - exact(found)) / share
    # a (1 - share) is a double.
    assert true <= width * (1 + 2.0**-12)
    assert width <= 3 * true


def test_a_search_of_too_many_pieces_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(followed, "MOST_PIECES", 20)
    assert first(level("2"), end=9.9) is None
    with pytest.raises(BudgetExceeded):
        first(level("2"), end=1e4)


@pytest.mark.parametrize("coefficient", [0.001, 0.1, 1.0])
def test_a_zero_is_found_where_the_motion_has_no_series(coefficient: float) -> None:
    """A bob swings into the end of its damper, which loses its direction there; beside Runge and Kutta's method."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"bob": {"mass": 1, "at": [0.6, -0.8]}},
        "connections": [
            {"kind": "rod", "a": "bob", "b": [0, 0]},
            {"kind": "damper", "a": "bob", "b": [0, -1], "coefficient": coefficient},
        ],
    }
    answer = solve_scene(scene_from(scene), [0.0, 1.0])

    def rates(_: float, state: Floats) -> list[float]:
        return [state[1], -9.81 * math.sin(state[0]) - coefficient * math.cos(state[0] / 2) ** 2 * state[1]]

    def angle(_: float, state: Floats) -> float:
        return float(state[0])

    start = [math.atan2(0.6, 0.8), 0.0]
    events = solve_ivp(rates, (0.0, 1.0), start, method="DOP853", rtol=1e-12, atol=1e-14, events=angle).t_events
    assert answer.ended is not None
    assert answer.ended.kind == "singular"
    assert abs(answer.ended.time - events[0][0]) < answer.ended.error
