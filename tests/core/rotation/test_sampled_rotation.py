"""Samples of a free rotation: what is wanted, what rounding adds, attitudes against the angular momentum in space."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest

from core.bodies import PrincipalMoments
from core.errors import AccuracyUnreachable, NotApplicable
from core.notices import Notice
from core.rotation.sampled_rotation import Output, in_range, sample_rotation, wanted_outputs
from core.systems.methods import ClosedFormEvaluation, ExplicitEuler

BODY = PrincipalMoments((1.0, 2.0, 3.0)).mass_properties()
START = (0.3, 1.0, -0.2)
TIMES = np.linspace(-3.0, 20.0, 47)
TURNED = (0.5, -0.1, 0.7, 0.2)


@pytest.mark.parametrize(
    ("outputs", "attitude", "wanted"),
    [
        (None, None, ("time", "angular_velocity")),
        (None, TURNED, ("time", "angular_velocity", "attitude")),
        (["attitude"], None, ("attitude",)),
        (["time"], TURNED, ("time",)),
    ],
)
def test_an_attitude_is_wanted_where_one_is_given_or_it_is_named(
    outputs: list[Output] | None, attitude: object, wanted: tuple[str, ...]
) -> None:
    assert wanted_outputs(outputs, attitude) == wanted


def test_the_angular_momentum_does_not_turn_in_space() -> None:
    found = sample_rotation(BODY, START, TIMES, attitude=TURNED)
    assert found.attitude is not None
    momentum = found.motion.state * np.array([1.0, 2.0, 3.0])
    w, v = found.attitude.quaternions[:, :1], found.attitude.quaternions[:, 1:]
    in_space = momentum + 2.0 * np.cross(v, np.cross(v, momentum) + w * momentum)
    size = np.linalg.norm(in_space[0])
    error = found.attitude.error + found.motion.accuracy.error
    assert np.abs(in_space - in_space[0]).max() <= 2.0 * error * size + 1e-14


def test_without_an_attitude_it_is_none_and_a_named_one_starts_without_a_turn() -> None:
    assert sample_rotation(BODY, START, TIMES).attitude is None
    found = sample_rotation(BODY, START, np.zeros(1), outputs=["attitude"])
    assert found.attitude is not None
    np.testing.assert_allclose(found.attitude.quaternions, [[1.0, 0.0, 0.0, 0.0]], atol=1e-15)


def test_rounding_is_covered_by_the_errors_that_are_stated() -> None:
    exact = sample_rotation(BODY, START, TIMES, attitude=TURNED)
    short = sample_rotation(BODY, START, TIMES, attitude=TURNED, digits=3)
    assert exact.attitude is not None
    assert short.attitude is not None
    size = np.linalg.norm(exact.motion.state, axis=1).max()
    moved = np.linalg.norm(short.motion.state - exact.motion.state, axis=1).max() / size
    assert 0.0 < moved <= short.motion.accuracy.error
    # A quaternion's error is half that of the attitude.
    turned = np.linalg.norm(short.attitude.quaternions - exact.attitude.quaternions, axis=1).max()
    assert 0.0 < 2.0 * turned <= short.attitude.error
    assert [notice.code for notice in short.warnings][-1] == "rounded-beyond-accuracy"


def test_what_is_not_wanted_is_not_rounded() -> None:
    found = sample_rotation(BODY, START, TIMES, digits=3, outputs=["attitude"])
    assert found.motion.accuracy.error == sample_rotation(BODY, START, TIMES).motion.accuracy.error


def test_attitudes_are_refused_beside_an_integrator_and_beyond_their_bound() -> None:
    with pytest.raises(NotApplicable) as caught:
        sample_rotation(BODY, START, TIMES, attitude=TURNED, method=ExplicitEuler(0.01))
    assert caught.value.path == ("method",)
    assert sample_rotation(BODY, START, TIMES, attitude=TURNED, method=ClosedFormEvaluation()).attitude is not None
    bound = sample_rotation(BODY, START, TIMES, attitude=TURNED).attitude
    assert bound is not None
    rates = sample_rotation(BODY, START, TIMES).motion.accuracy.error
    assert rates < bound.error
    with pytest.raises(AccuracyUnreachable) as refused:
        sample_rotation(BODY, START, TIMES, attitude=TURNED, accuracy=0.5 * (rates + bound.error))
    assert refused.value.achievable == bound.error


def test_figures_beyond_doubles_are_none_with_a_notice() -> None:
    notices: list[Notice] = []
    assert in_range("period", 2.0, notices) == 2.0
    assert in_range("period", None, notices) is None
    assert notices == []
    assert in_range("period", inf, notices) is None
    assert [notice.code for notice in notices] == ["out-of-range"]
