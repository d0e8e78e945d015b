"""Steps are counted as the methods take them, and never without a value."""

from __future__ import annotations

from math import floor
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from core.systems.methods import ExplicitEuler, RungeKutta4
from service.routes.step_counts import UNCOUNTABLE, least_evaluations, steps
from service.schemas import Span
from tests.core.systems.systems import rigid_body
from tests.drawn import draws

TIME = st.floats(allow_nan=False, allow_infinity=False)
TIMES = st.lists(TIME, min_size=1, max_size=6) | st.builds(
    lambda start, stop, count: Span(start=start, stop=stop, count=count), TIME, TIME, st.integers(1, 10**6)
)
SECONDS = st.floats(-50.0, 50.0) | st.integers(-50, 50).map(float)
ORDINARY = st.floats(-1e6, 1e6).filter(lambda t: t == 0.0 or abs(t) > 1e-300)


class TestTimes:
    @pytest.mark.parametrize("stop", [10.0, -10.0])
    def test_steps_of_spans_and_lists_agree(self, stop: float) -> None:
        span = Span(start=0.0, stop=stop, count=21)
        # Of the times 0.5 s apart, every third is a grid point.
        assert steps(span, 0.03) == steps(span.values().tolist(), 0.03) == 333 + 14
        assert steps([1.0, -1.0, 1.0], 0.5) == 4
        assert steps([1.0, -1.2, 1.0, 1.1], 0.5) == 4 + 2

    @given(ORDINARY, ORDINARY, st.integers(1, 60), st.floats(1e-12, 1e6))
    @example(1e-200, 2e-200, 2, 1e-203)
    @example(-2e-200, -1e-200, 2, 1e-203)
    @example(-1.0, 2.0, 3, 0.3)
    @example(3.0, 0.0, 1, 1.0)
    @example(0.0, 3.0, 1, 1.0)
    @settings(deadline=None, derandomize=True, max_examples=draws(300))
    def test_steps_of_a_span_are_those_of_its_times(self, start: float, stop: float, count: int, step: float) -> None:
        span = Span(start=start, stop=stop, count=count)
        # A time of a span that rounding moves off the grid, or onto it, is one step.
        apart = abs(steps(span, step) - steps(span.values().tolist(), step))
        assert apart <= count + 1 + 1e-9 * steps(span, step)

    @given(st.lists(ORDINARY, min_size=1, max_size=8), st.sampled_from([2.0**-k for k in range(-3, 12)]))
    @settings(deadline=None, derandomize=True)
    def test_steps_of_a_list_are_counted_one_by_one(self, times: list[float], step: float) -> None:
        """As a march from the start to either side takes them, with one more to each time between two grid points."""
        times = [round(t * 64) / 64 for t in times]
        taken = sum(floor(max(side * t for t in (0.0, *times)) / step) for side in (1.0, -1.0))
        assert steps(times, step) == taken + sum(t % step > 0.0 for t in set(times))

    @given(
        st.lists(SECONDS, min_size=1, max_size=9)
        | st.builds(lambda a, b, n: Span(start=a, stop=b, count=n), SECONDS, SECONDS, st.integers(1, 300)),
        st.floats(1e-2, 1e3),
    )
    @settings(deadline=None, derandomize=True)
    def test_steps_are_those_that_the_methods_take(self, times: Any, step: float) -> None:
        asked = np.array(times) if isinstance(times, list) else times.values()
        work = ExplicitEuler(step).integrate(rigid_body((1.0, 2.0, 3.0), (0.0, 0.0, 1.0)), asked).work
        # Of a span, the share of times between two grid points is that of a long one.
        assert abs(steps(times, step) - work.evaluations) <= (0 if isinstance(times, list) else len(asked))

    @given(TIMES, st.floats(5e-324, 1e300), st.floats(5e-324, 1e300))
    @settings(deadline=None, derandomize=True)
    def test_steps_are_never_uncountable_and_never_more_for_longer_ones(
        self, times: Any, one_step: float, other: float
    ) -> None:
        short, long = sorted((one_step, other))
        count = len(times) if isinstance(times, list) else times.count
        assert 0.0 <= steps(times, long) <= steps(times, short) + count
        assert steps(times, short) <= UNCOUNTABLE


@pytest.mark.parametrize("method", [ExplicitEuler(0.03), RungeKutta4(0.03)])
def test_evaluations_of_explicit_methods_are_exact(method: Any) -> None:
    times = [0.5, 2.0, -1.0]
    work = method.integrate(rigid_body((1.0, 2.0, 3.0), (0.1, 1.0, 0.1)), np.array(times)).work
    assert least_evaluations(method, times) == work.evaluations
