"""Prices: never without a value, never less for more, and from a table that knows all that is asked."""

from __future__ import annotations

import dataclasses
import json
from math import floor, inf, isfinite, nextafter, ulp
from sys import float_info
from typing import Any, get_args, get_type_hints

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from core.bodies.measured import PrincipalMoments
from core.errors import MechanicsError
from core.rotation.surfaces.initial_states import initial_states
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from core.systems.methods import ExplicitEuler, Method
from core.work_precision import DEFAULT_RUNS, SCIPY_TOLERANCES
from service.execution.cost_model import (
    UNCOUNTABLE,
    CalibratedCost,
    calibration,
    effort,
    evaluations,
    extent,
    farthest,
    numbers,
    one,
    quickest,
    setting,
    speed_of,
    steps,
)
from service.execution.request_handler import RequestHandler
from service.problems import Refusal
from service.requests.request_reader import Limits
from service.routes import questions
from service.routing import PostRoute
from service.schemas import Span
from tests.core.systems.systems import rigid_body

ROUTES = {route.path: route for route in questions()}
ANSWERING = RequestHandler(ROUTES.values(), Budget(), Limits())
METHODS = {method.kind: method for method in get_args(get_args(Method)[0])}
INTEGRATORS = {kind: method for kind, method in METHODS.items() if kind != "closed-form"}
OPERATIONS = sorted(calibration().seconds)

TIME = st.floats(allow_nan=False, allow_infinity=False)
TIMES = st.lists(TIME, min_size=1, max_size=6) | st.builds(
    lambda start, stop, count: Span(start=start, stop=stop, count=count), TIME, TIME, st.integers(1, 10**6)
)
SPEED = st.just(0.0) | st.floats(5e-324, allow_infinity=False)
KIND = st.sampled_from(sorted(INTEGRATORS))


def with_setting(kind: str, value: float) -> Any:
    method = INTEGRATORS[kind]
    return method(**{dataclasses.fields(method)[0].name: value})


@st.composite
def pairs(draw: st.DrawFn) -> tuple[Any, Any]:
    """One method with two settings, of which the first is the finer."""
    kind = draw(KIND)
    name = dataclasses.fields(INTEGRATORS[kind])[0].name
    bounds = get_type_hints(INTEGRATORS[kind], include_extras=True)[name].__metadata__[0]
    low, high = max(5e-324, bounds.at_least), min(1e300, nextafter(bounds.below, 0.0))
    value = st.floats(low, high)
    fine, coarse = sorted((draw(value), draw(value)))
    return with_setting(kind, fine), with_setting(kind, coarse)


class TestTable:
    def test_it_knows_every_operation_and_every_method(self) -> None:
        priced = [getattr(route.price, "own", route.price) for route in ROUTES.values()]
        operations = [price.operation for price in priced if isinstance(price, CalibratedCost)]
        assert len(operations) >= 10
        for operation in operations:
            assert calibration().seconds[operation]
        assert set(calibration().methods) == set(INTEGRATORS)

    def test_nothing_costs_less_than_nothing(self) -> None:
        table = calibration()
        for costs in (*table.seconds.values(), {"writing": table.writing}):
            assert all(isfinite(cost) and cost >= 0.0 for cost in costs.values())

    def test_finer_settings_cost_more_and_err_less(self) -> None:
        for kind, costs in calibration().methods.items():
            assert costs["evaluations"] > 0.0
            assert costs["error_exponent"] > 0.0
            # By steps it is counted, by tolerance it follows a power.
            assert ("exponent" in costs) == (dataclasses.fields(INTEGRATORS[kind])[0].name == "tolerance")
            assert costs.get("exponent", -1.0) < 0.0


class TestPriced:
    @given(st.sampled_from(OPERATIONS), st.data())
    @settings(deadline=None, derandomize=True, max_examples=60)
    def test_more_never_costs_less(self, operation: str, data: st.DataObject) -> None:
        costs = calibration().seconds[operation]
        count = st.floats(0.0, UNCOUNTABLE)
        few = {name: data.draw(count) for name in costs}
        many = few | {name: data.draw(st.floats(few[name], UNCOUNTABLE)) for name in costs}
        price = CalibratedCost(operation, lambda counts, budget: counts)
        assert 0.0 <= price(few, Budget()) <= price(many, Budget()) < inf

    def test_it_is_the_sum_of_costs_times_counts(self) -> None:
        costs = calibration().seconds["wobble"]
        price = CalibratedCost("wobble", lambda counts, budget: counts)
        assert CalibratedCost("wobble", one)(None, Budget()) == costs["question"] > 0.0
        assert price({"question": 3.0}, Budget()) == 3.0 * costs["question"]
        # What has no cost of its own is part of the others.
        assert price({"question": 1.0, "unheard of": 1e9}, Budget()) == costs["question"]

    def test_what_exceeds_the_budget_has_no_price(self) -> None:
        route = ROUTES["/v1/rotation/trajectory"]
        question = dict(route.examples["t-handle"].question) | {"times": {"start": 0, "stop": 1, "count": 10}}
        asked = ANSWERING.read(route, json.dumps(question).encode())
        assert route.price(asked, Budget(samples=10)) > 0.0
        with pytest.raises(MechanicsError):
            route.price(asked, Budget(samples=9))


class TestQuestions:
    @pytest.mark.parametrize("route", ROUTES.values(), ids=ROUTES)
    def test_every_example_has_a_price(self, route: PostRoute) -> None:
        for shown in route.examples.values():
            asked = ANSWERING.read(route, json.dumps(shown.question).encode())
            seconds = route.price(asked, Budget())
            # A plan is limited by its slice of time, whatever it plans.
            assert 0.0 <= seconds < inf
            assert (seconds > 0.0) != (route.in_short != ())

    @pytest.mark.parametrize(
        "route",
        [one for one in ROUTES.values() if isinstance(one.price, CalibratedCost)],
        ids=lambda one: one.operation_id,
    )
    def test_everything_counted_of_an_example_is_in_the_table(self, route: PostRoute) -> None:
        cost = route.price
        assert isinstance(cost, CalibratedCost)
        for shown in route.examples.values():
            asked = ANSWERING.read(route, json.dumps(shown.question).encode())
            assert {*cost.counts(asked, Budget())} <= {*cost.costs}

    @given(
        st.sampled_from(["/v1/rotation/trajectory", "/v1/rotation/ensemble"]),
        st.tuples(*[st.floats(5e-324, 1.7e308)] * 3),
        st.tuples(*[TIME] * 3),
        st.lists(TIME, min_size=1, max_size=4)
        | st.builds(
            lambda *span: dict(zip(("start", "stop", "count"), span, strict=True)), TIME, TIME, st.integers(1, 9)
        ),
        KIND,
        st.floats(1e-12, 0.99),
    )
    @settings(deadline=None, derandomize=True, max_examples=150)
    def test_whatever_the_request_has_a_price_or_is_refused(
        self, path: str, moments: Any, rate: Any, times: Any, kind: str, value: float
    ) -> None:
        name = dataclasses.fields(INTEGRATORS[kind])[0].name
        question = {
            "body": {"kind": "principal-moments", "moments": moments},
            "times": times,
            "method": {"kind": kind, name: value},
        } | ({"angular_velocity": rate} if path.endswith("trajectory") else {"angular_velocities": [rate]})
        route = ROUTES[path]
        try:
            asked = ANSWERING.read(route, json.dumps(question).encode())
            seconds = ANSWERING.price(route, asked)
        except (MechanicsError, Refusal):
            assume(False)
        assert 0.0 < seconds < inf


class TestMethods:
    @given(pairs(), TIMES, SPEED)
    @settings(deadline=None, derandomize=True, max_examples=300)
    def test_a_finer_setting_never_takes_fewer_evaluations_nor_errs_more(
        self, methods: tuple[Any, Any], times: Any, speed: float
    ) -> None:
        fine, coarse = methods
        # A time may be a grid point of the finer steps and not of the coarser ones, and then takes one step more.
        count = len(times) if isinstance(times, list) else times.count
        more = count * calibration().methods[fine.kind]["evaluations"] if setting(fine)[0] == "step" else 0.0
        assert 0.0 <= evaluations(coarse, times, speed) <= evaluations(fine, times, speed) + more < inf

    @given(pairs(), TIMES, SPEED, SPEED)
    @settings(deadline=None, derandomize=True)
    def test_a_faster_rotation_never_costs_less(
        self, methods: tuple[Any, Any], times: Any, one_speed: float, other: float
    ) -> None:
        slow, fast = sorted((one_speed, other))
        for method in methods:
            assert evaluations(method, times, slow) <= evaluations(method, times, fast)

    @pytest.mark.parametrize("method", [None, METHODS["closed-form"]()])
    def test_the_closed_form_evaluates_nothing(self, method: Any) -> None:
        assert evaluations(method, [1e9], 1e9) == 0.0
        assert effort(method, [1e9], 1e9, 10.0) == {}

    @given(KIND, st.floats(1e-6, 0.5), st.integers(1, 1000))
    @settings(deadline=None, derandomize=True)
    def test_effort_is_per_member(self, kind: str, value: float, members: int) -> None:
        method, times = with_setting(kind, value), [1.0, 2.0]
        alone, all_of_them = effort(method, times, 3.0, 2.0), effort(method, times, 3.0, 2.0, members)
        assert alone[f"runs of {kind}"] == 1
        assert alone[f"samples of {kind}"] == 2.0
        assert alone[f"evaluations of {kind}"] == evaluations(method, times, 3.0)
        assert all_of_them == {name: count * members for name, count in alone.items()}

    def test_settings_are_named(self) -> None:
        assert setting(with_setting("explicit-euler", 0.25)) == ("step", 0.25)
        assert setting(with_setting("radau", 1e-3)) == ("tolerance", 1e-3)

    @given(st.tuples(*[TIME] * 3))
    @settings(derandomize=True)
    def test_a_speed_is_a_double(self, rate: tuple[float, float, float]) -> None:
        speed = speed_of(rate)
        assert max(map(abs, rate)) <= speed < inf
        if speed < 1e150:
            assert speed <= sum(map(abs, rate)) + ulp(speed)


MOMENT = st.floats(1e-9, 1e9)
SWINGING = {
    "body": {"kind": "principal-moments", "moments": [795.0, 0.007, 1.0]},
    "angular_velocity": [1.0, 10.0, 1.0],
    "times": {"start": 0.0, "stop": 1.0, "count": 3},
    "accuracy": 0.5,
}
"""No matter has these moments; the motion swings 9000 times as fast as it turns."""

RUN = {"kind": "dormand-prince-853", "tolerance": 1e-6}
PARTS = [{"body": {"kind": "ball", "radius": 1.0, "mass": 1.0 + i}, "position": [i, i * i, 0.0]} for i in range(60)]


def price(path: str, **question: Any) -> float:
    route = ROUTES[path]
    return ANSWERING.price(route, ANSWERING.read(route, json.dumps(question).encode()))


class TestMotionsThatOutrunTheirStart:
    @given(MOMENT, MOMENT, st.floats(0.0, 1.0), SPEED)
    @settings(derandomize=True)
    def test_matter_does_not(self, a: float, b: float, share: float, speed: float) -> None:
        low, middle = sorted((a, b))
        moments = [low, middle, max(middle, share * (low + middle))]
        assert quickest(speed, moments) == speed

    @given(st.lists(MOMENT, min_size=3, max_size=3), SPEED)
    @settings(derandomize=True)
    def test_a_swing_is_that_of_the_linear_equations(self, moments: list[float], speed: float) -> None:
        """At rest but for the axis of the largest moment, the rates are eigenvalues of the Jacobian, by numpy."""
        a, b, c = sorted(moments)
        jacobian = np.array([[0.0, (b - c) / a], [(c - a) / b, 0.0]])
        swing = float(np.abs(np.linalg.eigvals(jacobian)).max())
        assume(speed < 1e200)
        assert quickest(speed, [a, b, c]) == pytest.approx(speed * max(1.0, swing), rel=1e-6)

    def test_what_has_no_thickness_has_a_price(self) -> None:
        assert quickest(2.0, [0.0, 1.0, 1.0]) == quickest(2.0, [-1e-20, 1.0, 1.0]) == 2.0
        assert quickest(2.0, [-1e-10, 1.0, 1.0]) == 2.0
        assert quickest(2.0, [0.0, 1.0, 2.0]) == quickest(2.0, [0.0, 0.0, 2.0]) == float_info.max
        assert quickest(0.0, [0.0, 1.0, 2.0]) == 0.0

    def test_evaluations_are_foreseen_in_order_of_magnitude(self) -> None:
        plan = {"path": "/v1/rotation/trajectory", "request": SWINGING | {"method": RUN}}
        question = ANSWERING.read(ROUTES["/v1/plan"], json.dumps(plan).encode())
        foreseen = ANSWERING.answer(ROUTES["/v1/plan"], question)["cost"]["evaluations"]
        body = PrincipalMoments((795.0, 0.007, 1.0)).mass_properties()
        system = TorqueFree(body, np.array(SWINGING["angular_velocity"]))
        run = METHODS[RUN["kind"]](RUN["tolerance"]).integrate(system, np.array([0.0, 0.5, 1.0]), Budget())
        assert run.work.evaluations / 2 < foreseen < 10 * run.work.evaluations

    def test_every_operation_foresees_them(self) -> None:
        run = RUN | {"kind": "lsoda"}
        rates = {"angular_velocities": [SWINGING["angular_velocity"]]}
        several = {name: SWINGING[name] for name in ("body", "times", "accuracy")} | rates
        turning = {name: SWINGING[name] for name in ("body", "angular_velocity")}
        assert price("/v1/rotation/trajectory", **SWINGING, method=run) > 1.0
        assert price("/v1/rotation/ensemble", **several, method=run) > 1.0
        assert price("/v1/work-precision", **SWINGING, methods=[run]) > 1.0
        measure = {"method": run, "duration": 1.0, "samples": 3, "tolerance": 0.1}
        assert price("/v1/rotation/precession", **turning, measure=measure) > 1.0

    @pytest.mark.parametrize(("length", "least", "most"), [(1e3, 1.0, 2.0), (1e5, 10.0, 1e4), (1e6, 1e3, inf)])
    def test_rounding_that_is_taken_for_motion_is_foreseen(self, length: float, least: float, most: float) -> None:
        """It took 401, 20 910 and more than 300 000 evaluations."""
        needle = {
            "body": {
                "kind": "point-masses",
                "masses": [1.0, 2.0, 1.0, 0.5],
                "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.3, length]],
            },
            "angular_velocity": [1.0, 2.0, 0.5],
            "times": {"start": 0.0, "stop": 10.0, "count": 3},
        }
        run = {"kind": "lsoda", "tolerance": 1e-9}
        along = {"body": {"kind": "principal-moments", "moments": [1.0, length * length, length * length]}}
        price_of = {
            name: price("/v1/rotation/trajectory", **needle | body, method=run)
            for name, body in (("oblique", {}), ("principal", along))
        }
        assert least <= price_of["oblique"] / price_of["principal"] < most

    def test_ladders_of_such_motions_are_as_dear_as_their_share_of_the_budget(self) -> None:
        places = [[1e104, 0.0, 0.0], [0.0, 1e92, 0.0], [0.0, 0.0, 1e92]]
        body = {"kind": "point-masses", "masses": [1.0, 1.0, 1.0], "positions": places}
        question = {"body": body, "angular_velocity": [1e-3, 1.0, 1.0], "times": [0.0, 10.0]}
        route = ROUTES["/v1/work-precision"]
        counts = route.price.counts(ANSWERING.read(route, json.dumps(question).encode()), Budget())  # type: ignore[attr-defined]
        share = Budget().evaluations // DEFAULT_RUNS
        for kind in ("lsoda", "radau"):
            assert counts[f"evaluations of {kind}"] == share * len(SCIPY_TOLERANCES)

    def test_judging_a_method_where_the_closed_form_is_out_of_reach_is_counted(self) -> None:
        """The judge of each member spends the whole budget."""
        budget = Budget(evaluations=3000)
        question = {
            "body": {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]},
            "angular_velocities": [[1e57, 1e57, 1e57], [1e57, 2e57, 1e57]],
            "times": [1.0],
            "method": {"kind": "symmetric-splitting", "step": 269.0},
        }
        route = ROUTES["/v1/rotation/ensemble"]
        read = ANSWERING.read(route, json.dumps(question).encode())
        assert "2970 are allowed" in str(route.handle(read, budget)["warnings"])
        assert route.price.counts(read, budget)["judging evaluations"] == 6000.0  # type: ignore[attr-defined]
        slow = read.model_copy(update={"angular_velocities": [[1.0, 1.0, 1.0]]})
        assert "judging evaluations" not in route.price.counts(slow, budget)  # type: ignore[attr-defined]

    def test_starts_of_an_energy_are_as_dear_as_the_same_starts_given(self) -> None:
        moments, sample = (3.0, 2.0, 1.5), {"energy": 1e10, "count": 20, "seed": 1}
        states = initial_states(PrincipalMoments(moments).mass_properties(), 1e10, 20, 1)
        question = {
            "body": {"kind": "principal-moments", "moments": moments},
            "times": {"start": 0.0, "stop": 5.0, "count": 3},
            "method": RUN,
        }
        given = price("/v1/rotation/ensemble", **question, angular_velocities=states.tolist())
        assert given / 2 < price("/v1/rotation/ensemble", **question, sample=sample) < 2 * given


def test_the_parts_of_a_body_cost_the_same_whatever_the_request() -> None:
    turning = {"body": {"kind": "composite", "parts": PARTS}, "angular_velocity": [1.0, 0.0, 0.0]}
    least = price("/v1/bodies/mass-properties", body=turning["body"]) / 2
    assert price("/v1/rotation/precession", **turning) > least > 0.003
    assert price("/v1/rotation/stability", body=turning["body"]) > least


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
    @settings(deadline=None, derandomize=True, max_examples=300)
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

    @given(st.lists(ORDINARY, min_size=1, max_size=8))
    @settings(derandomize=True)
    def test_extents_are_measured_from_the_start(self, times: list[float]) -> None:
        assert farthest(times) == np.abs(times).max()
        assert extent(times) == max([*times, 0.0]) - min([*times, 0.0])
        span = Span(start=times[0], stop=times[-1], count=3)
        ends = [times[0], times[-1]]
        for measure in (farthest, extent):
            assert measure(span) == measure(ends)
            # As numpy.linspace has it, one time is the start.
            assert measure(Span(start=times[0], stop=times[-1], count=1)) == measure(times[:1])


def test_numbers_are_counted_by_their_digits_where_these_are_chosen() -> None:
    assert numbers(30.0, None) == {"numbers": 30.0}
    assert numbers(30.0, 5) == {"digits": 150.0}
