"""What every method of the catalogue must obey."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, fields
from typing import Any, get_args

import numpy as np
import pytest
from scipy.special import ellipj

from core.errors import BudgetExceeded, InvalidParameter, MechanicsError
from core.quantities import members_of
from core.systems.budget import Budget
from core.systems.methods import Method
from core.systems.methods.fixed_step import FixedStep
from core.systems.methods.method import AbstractMethod, Family, Invariance
from core.systems.solve import solve
from core.systems.system import ClosedForm
from tests.core.systems.systems import counting, elliptic_functions, oscillator, rigid_body

CATALOGUE: dict[str, Any] = {member.kind: member for member in members_of(Method)}

SETTINGS: dict[str, tuple[float, ...]] = {
    # Settings from coarse to fine over which each error lies well between the whole motion and round-off.
    "explicit-euler": (2e-3, 1e-3, 5e-4, 2.5e-4),
    "runge-kutta-4": (1e-1, 5e-2, 2.5e-2, 1.25e-2),
    "implicit-midpoint": (4e-2, 2e-2, 1e-2, 5e-3),
    "symmetric-splitting": (4e-2, 2e-2, 1e-2, 5e-3),
    "discrete-moser-veselov": (4e-2, 2e-2, 1e-2, 5e-3),
    "dormand-prince-853": (1e-4, 1e-6, 1e-8, 1e-10, 1e-12),
    "lsoda": (1e-4, 1e-6, 1e-8, 1e-10),
    "radau": (1e-4, 1e-5, 1e-6, 1e-7),
}
"""Of every member but the closed form, which has none: a new member states its own here."""

MARCHING = [kind for kind in CATALOGUE if kind != "closed-form"]


def finest(kind: str) -> AbstractMethod:
    """Return a member with its last setting of `SETTINGS`."""
    member = CATALOGUE[kind]
    return member() if kind == "closed-form" else member(SETTINGS[kind][-1])


every = pytest.mark.parametrize("kind", CATALOGUE)
every_integrator = pytest.mark.parametrize("kind", MARCHING)


def test_every_member_has_settings_to_be_tested_with() -> None:
    assert set(SETTINGS) == set(MARCHING)
    assert len(CATALOGUE) == len(members_of(Method))


@every
def test_a_member_describes_itself(kind: str) -> None:
    member = CATALOGUE[kind]
    assert issubclass(member, AbstractMethod)
    assert member.family in get_args(Family)
    assert set(member.preserves) <= set(get_args(Invariance))
    assert member.order is None or member.order >= 1
    assert member.when_to_use.endswith(".")
    assert member.between_steps.endswith(".")
    assert member.__doc__
    method = finest(kind)
    assert method.kind == kind
    assert len(fields(method)) <= 2
    with pytest.raises(FrozenInstanceError):
        method.kind = "another"  # type: ignore[misc]


@every_integrator
@pytest.mark.parametrize("setting", [0.0, -1.0, float("nan"), float("inf"), True, "1"])
def test_settings_outside_their_range_are_refused_by_name(kind: str, setting: object) -> None:
    with pytest.raises(InvalidParameter) as refused:
        CATALOGUE[kind](setting)
    assert refused.value.path == (CATALOGUE[kind].setting,)


@pytest.mark.parametrize("kind", [kind for kind in MARCHING if CATALOGUE[kind].order is not None])
def test_the_measured_slope_is_the_declared_order(kind: str) -> None:
    # At the end alone: samples inside steps come from interpolants, which have orders of their own.
    system, end = elliptic_functions(), np.array([7.3])
    exact = system.exact.sample(end)
    cost, error = [], []
    for setting in SETTINGS[kind]:
        run = CATALOGUE[kind](setting).integrate(system, end)
        cost.append(run.work.steps)
        error.append(float(np.abs(run.states - exact).max()))
    assert min(error) > 5e-14, "below this, round-off would be fitted"
    slope = -np.polyfit(np.log(cost), np.log(error), 1)[0]
    order = CATALOGUE[kind].order
    # A controller that chooses the steps lets the slope differ a little from one problem to the next.
    assert order - 0.15 < slope < order + 0.15 if issubclass(CATALOGUE[kind], FixedStep) else slope > order - 0.7


@pytest.mark.parametrize("kind", [kind for kind in MARCHING if issubclass(CATALOGUE[kind], FixedStep)])
def test_the_order_holds_between_grid_points_too(kind: str) -> None:
    # Times that no step of the settings divides, so that all samples but the start are continued from the grid.
    system, times = elliptic_functions(), np.sqrt(np.linspace(0.1, 50.0, 40))
    exact, error = system.exact.sample(times), []
    for setting in SETTINGS[kind]:
        run = CATALOGUE[kind](setting).integrate(system, times)
        error.append(float(np.abs(run.states - exact).max()))
    assert min(error) > 5e-14, "below this, round-off would be fitted"
    slope = np.polyfit(np.log(SETTINGS[kind]), np.log(error), 1)[0]
    assert abs(slope - CATALOGUE[kind].order) < 0.15


@every_integrator
def test_finer_settings_give_smaller_errors(kind: str) -> None:
    system, times = elliptic_functions(), np.linspace(0, 7, 36)
    exact = system.exact.sample(times)
    errors = [
        float(np.abs(CATALOGUE[kind](setting).integrate(system, times).states - exact).max())
        for setting in SETTINGS[kind]
    ]
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < 2e-3


@every
def test_every_time_is_served_in_the_order_requested(kind: str) -> None:
    system, method = elliptic_functions(), finest(kind)
    times = np.array([1.5, -0.7, 0.0, 2.5, 1.5, -3.0, 0.1, -0.7])
    states = method.integrate(system, times).states
    assert np.abs(states - system.exact.sample(times)).max() < 2e-3
    assert (states[0] == states[4]).all()
    assert (states[1] == states[7]).all()
    shuffled = np.array([2, 0, 3, 1, 7, 6, 5, 4])
    assert (method.integrate(system, times[shuffled]).states == states[shuffled]).all()


@every
def test_backwards_is_the_mirror_of_forwards(kind: str) -> None:
    # sn is odd, cn and dn are even.
    system, times = elliptic_functions(), np.linspace(0.25, 5, 20)
    forwards = finest(kind).integrate(system, times).states
    backwards = finest(kind).integrate(system, -times).states
    assert np.abs(backwards * [-1, 1, 1] - forwards).max() < 1e-12


@every
def test_the_start_itself_is_returned_as_it_is(kind: str) -> None:
    system = oscillator(rate=0.7, position=1 / 3, velocity=-1 / 7)
    run = finest(kind).integrate(system, np.zeros(3))
    assert (run.states == system.initial_state).all()
    assert run.work.evaluations == run.work.steps == 0


@every_integrator
def test_the_work_is_what_the_equation_itself_counts(kind: str) -> None:
    for times in (np.linspace(0, 3, 7), np.array([2.0, -1.0, 0.5])):
        system = counting()
        run = finest(kind).integrate(system, times)
        # One look at the start, to see whether its rate of change is in range, is no work of the method.
        assert run.work.evaluations == int(system.parameters[0]) - 1
        assert run.work.samples == times.size
        assert 0 < run.work.steps <= run.work.evaluations


@every_integrator
def test_the_same_question_gets_the_same_bits_and_the_same_work(kind: str) -> None:
    system, times = elliptic_functions(), np.linspace(-2, 3, 11)
    one, other = finest(kind).integrate(system, times), finest(kind).integrate(system, times)
    assert one.states.tobytes() == other.states.tobytes()
    assert one.work == other.work


@every_integrator
def test_more_work_than_the_budget_is_refused_with_what_would_mend_it(kind: str) -> None:
    system = counting()
    with pytest.raises(BudgetExceeded) as refused:
        finest(kind).integrate(system, np.array([1e4]), Budget(evaluations=5000))
    assert refused.value.limit == 5000 < refused.value.needed
    assert refused.value.remedy
    assert system.parameters[0] <= 5001


@every_integrator
@pytest.mark.parametrize("exponent", [-1000, -330, -100, 100, 330, 1000])
def test_units_do_not_matter(kind: str, exponent: int) -> None:
    # Rates of 1e-301 to 1e301: with time in the inverse unit, powers of two leave every digit as it is.
    unit = 2.0**exponent
    times = np.linspace(0, 5, 11)
    inertia, rates = (1.0, 2.0, 3.0), np.array([1.0, 0.1, 1.0])
    member, setting = CATALOGUE[kind], SETTINGS[kind][0]
    one = member(setting).integrate(rigid_body(inertia, tuple(rates)), times)
    setting = setting / unit if member.setting == "step" else setting
    other = member(setting).integrate(rigid_body(inertia, tuple(rates * unit)), times / unit)
    if member.setting == "step":
        assert (other.states / unit == one.states).all()
    else:
        assert np.abs(other.states / unit - one.states).max() < 100 * setting
    assert other.work.steps == pytest.approx(one.work.steps, rel=0.1)


@pytest.mark.parametrize("kind", [kind for kind in MARCHING if CATALOGUE[kind].preserves])
def test_what_is_claimed_to_be_conserved_is_conserved_at_coarse_steps(kind: str) -> None:
    # Errors of several per cent, invariants at round-off.
    member = CATALOGUE[kind]
    # Every third time is a grid point, the others lie between two.
    system, times = rigid_body((1.0, 2.0, 3.0), (1.0, 0.3, 1.0)), np.linspace(0, 300, 301)
    states = member(0.3).integrate(system, times).states
    invariants = system.invariants(states)
    both = ("energy", "momentum")
    kept = {
        "every first integral": both,
        "quadratic invariants": both,
        "invariants of every part": ("momentum",),
    }
    for claim in member.preserves:
        for name in kept.get(claim, ()):
            assert np.abs(invariants[name] / invariants[name][0] - 1).max() < 1e-14
    if member.family == "structure-preserving" and "every first integral" not in member.preserves:
        # The others stay in a band that does not widen with time.
        drift = np.abs(invariants["energy"] / invariants["energy"][0] - 1)
        assert drift[:150].max() < 0.05
        assert drift[150:].max() < 1.5 * drift[:150].max()
    if "time symmetry" in member.preserves:
        there = rigid_body((1.0, 2.0, 3.0), tuple(member(0.3).integrate(system, np.array([30.0])).states[0]))
        back = member(0.3).integrate(there, np.array([-30.0])).states[0]
        assert np.abs(back - system.initial_state).max() < 1e-12


def test_a_method_that_keeps_nothing_shows_that_the_test_would_notice() -> None:
    system, times = rigid_body((1.0, 2.0, 3.0), (1.0, 0.3, 1.0)), np.linspace(0, 300, 101)
    momentum = system.invariants(CATALOGUE["runge-kutta-4"](0.3).integrate(system, times).states)["momentum"]
    assert np.abs(momentum / momentum[0] - 1).max() > 1e-6


@every_integrator
def test_the_statement_of_error_is_never_below_the_truth_nor_far_above(kind: str) -> None:
    times = np.linspace(-3, 7, 41)
    exact = np.column_stack(ellipj(times, 0.51)[:3])
    scale = np.linalg.norm(exact, axis=1).max()
    for setting in SETTINGS[kind]:
        trajectory = solve(elliptic_functions(exact=False), times, method=CATALOGUE[kind](setting))
        true = np.linalg.norm(trajectory.state - exact, axis=1).max() / scale
        assert true <= trajectory.accuracy.error < 20 * true + 1e-14


@every
def test_a_catalogue_body_is_served(kind: str) -> None:
    # Imported here: these laws do not rest on the free body.
    from core.bodies.mass_properties import diagonal
    from core.rotation.torque_free import TorqueFree

    system = TorqueFree(diagonal((1.0, 2.0, 3.0)), np.array([0.1, 1.0, 0.1]))
    exact: ClosedForm | None = system.closed_form()
    assert exact is not None
    trajectory = solve(system, np.linspace(0, 5, 21), method=finest(kind), accuracy=0.1)
    assert trajectory.accuracy.error < 2e-3
    assert set(trajectory.accuracy.drifts) == {"energy", "angular_momentum"}


@every_integrator
def test_whatever_fails_is_one_of_our_errors(kind: str) -> None:
    member = CATALOGUE[kind]
    for rates in ((1e155, 1e155, 1e155), (1e200, 1.0, 1.0), (1e-320, 1e-320, 1e-320), (0.0, 0.0, 0.0)):
        for setting in SETTINGS[kind][:1]:
            try:
                run = member(setting).integrate(
                    rigid_body((1.0, 2.0, 3.0), rates), np.array([1.0, -2.0]), Budget(20_000)
                )
            except MechanicsError:
                continue
            assert np.isfinite(run.states).all()
