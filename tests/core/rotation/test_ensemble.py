"""Many starts in one call are the same as one call for each."""

import numpy as np
import pytest

from core.bodies.mass_properties import diagonal
from core.errors import AccuracyUnreachable, BudgetExceeded, InvalidParameter
from core.rotation.ensemble import ensemble
from core.rotation.surfaces.initial_states import initial_states
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from core.systems.methods import ExplicitEuler
from core.systems.solve import solve


def test_the_source_s_thirty_starts():
    body, times = diagonal((2.0, 1.0, 0.5)), np.linspace(0, 20, 10_000)
    starts = initial_states(body, 1.0, 30, 0)
    many = ensemble(body, starts, times)
    assert many.angular_velocity.shape == (30, 10_000, 3)
    assert many.error < 1e-15
    for k in (0, 13, 29):
        assert np.array_equal(many.angular_velocity[k], solve(TorqueFree(body, starts[k]), times).state)


def test_limits_name_what_is_too_much():
    body = diagonal((1.0, 2.0, 3.0))
    with pytest.raises(BudgetExceeded):
        ensemble(body, np.ones((3, 3)), np.linspace(0, 1, 4), budget=Budget(samples=11))
    assert len(ensemble(body, np.ones((3, 3)), np.linspace(0, 1, 4), budget=Budget(samples=12)).members) == 3
    with pytest.raises(InvalidParameter):
        ensemble(body, np.ones((0, 3)), np.linspace(0, 1, 4))


def test_all_members_share_one_budget_of_evaluations():
    body, times = diagonal((1.0, 2.0, 3.0)), np.linspace(0, 10, 11)
    starts = np.array([[1.0, 0.5, 0.2], [0.2, 1.0, 0.3], [0.1, 0.2, 1.0]])
    method = ExplicitEuler(0.01)
    one = ensemble(body, starts[:1], times, method=method).members[0].work
    each = one.evaluations + one.evaluations_for_error
    assert each == 1000
    assert len(ensemble(body, starts, times, method=method, budget=Budget(evaluations=3 * each)).members) == 3
    with pytest.raises(BudgetExceeded):
        ensemble(body, starts, times, method=method, budget=Budget(evaluations=3 * each - 1))


def test_a_member_s_fault_names_the_member():
    starts = np.array([[1.0, 1.0, 1.0], [1e-300, 1.0, 1e-300]])
    with pytest.raises(AccuracyUnreachable) as caught:
        ensemble(diagonal((1.0, 2.0, 3.0)), starts, np.zeros(1))
    assert caught.value.path == ("angular_velocities", 1)


def test_warnings_of_many_members_are_merged():
    starts = np.concatenate([np.eye(3), [[1.0, 0.5, 0.2], [0.2, 1.0, 0.3], [0.1, 0.2, 1.0]]])
    body, times = diagonal((1.0, 2.0, 3.0)), np.linspace(0, 10, 11)
    many = ensemble(body, starts, times, method=ExplicitEuler(0.01))
    (notice,) = many.warnings
    assert (notice.code, notice.path) == ("accuracy-not-reached", ("method",))
    errors = [member.accuracy.error for member in many.members]
    worst = int(np.argmax(errors))
    assert many.error == errors[worst] > min(errors)
    assert f"{errors[worst]:.3g}" in notice.detail
    assert f"3 of 6 members (3, 4, 5); of these member {worst} has the largest error" in notice.detail
    alike = ensemble(body, starts[3:], times, method=ExplicitEuler(0.01)).warnings
    assert [f"[all 3 members; of these member {worst - 3} has the largest error]" in n.detail for n in alike] == [True]
    assert ensemble(body, starts, times).warnings == ()
