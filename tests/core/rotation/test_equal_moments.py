"""One rule for moments that are nearly equal, in every answer about the same body."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.bodies.composite import Composite, Part
from core.bodies.mass_properties import MassProperties, diagonal
from core.bodies.principal_inertia import EQUAL
from core.bodies.solids import Cuboid
from core.rotation.ensemble import ensemble
from core.rotation.equal_moments import NEARLY_EQUAL, curve_notices, moments_of_kinds
from core.rotation.precession.precession import precession
from core.rotation.stability.stability import stability
from core.rotation.surfaces.polhodes import polhode, separatrix
from core.rotation.torque_free import TorqueFree
from tests.drawn import draws

ULP = 2.0**-52
ulps = st.sampled_from((0, 1, 2, 7, 40))
spin = st.tuples(*3 * [st.sampled_from((0.0, 1.0, -1.0, 0.5, 1e-9))]).filter(any)


def codes(notices) -> set[str]:
    return {notice.code for notice in notices}


@settings(deadline=None, derandomize=True, max_examples=draws(200))
@given(ulps, ulps, st.booleans(), spin)
def test_no_answer_contradicts_another(first, second, wide, start):
    moments = (1.0, 1.0 + first * ULP, 1.7 if wide else 1.0 + (first + second) * ULP)
    body, times = diagonal(moments), np.array([0.0, 1.0])
    system = TorqueFree(body, np.array(start))
    motion, figures = system.closed_form(), precession(body, start)
    steady = motion.model.regime.endswith("steady rotation")
    assert (figures.regime == "steady") == steady
    assert figures.period == (None if motion.period is None else pytest.approx(motion.period, rel=4e-16))
    assert figures.flip_interval == (
        None if motion.flip_interval is None else pytest.approx(motion.flip_interval, rel=4e-16)
    )
    curve = polhode(body, np.array(start), 8)
    assert curve.regime == motion.model.regime
    # Every motion whose precession hangs on the difference is warned of it, alone and among others.
    hangs = "moments-nearly-equal" in codes(system.warnings)
    assert hangs == ("moments-nearly-equal" in codes(figures.warnings) and not steady)
    many = ensemble(body, np.array([start, start]), times)
    assert hangs == ("moments-nearly-equal" in codes(many.warnings))
    found = stability(body, 1.0)
    near = any(0.0 < b - a <= EQUAL * moments[2] for a, b in itertools.pairwise(moments))
    assert (codes(found.warnings) == {"moments-nearly-equal"}) == near
    assert bool(curve_notices(body.principal_of_motion)) == near
    distinct = len(set(moments)) == 3
    assert bool(separatrix(body, 1.0, 8)) == distinct
    assert ("saddle" in {e.kind for e in found.equilibria}) == distinct


def test_three_nearly_equal_moments_turn_as_they_are():
    found = precession(diagonal((1.0, 1.0 + ULP, 1.0 + 2 * ULP)), (1.0, 1.0, 1.0))
    assert (found.symmetry, found.regime) == ("spherical", "periodic")
    assert found.period == pytest.approx(2.0036041422813165e17, rel=4e-16)
    assert found.body_rate is None
    assert "sphere" in found.absent["body_rate"]
    assert found.warnings == (NEARLY_EQUAL,)
    # Two of them are the same: a body with an axis of symmetry, whose rate is the difference.
    found = precession(diagonal((1.0, 1.0, 1.0 + ULP)), (0.5, 0.5, 2.0))
    assert found.body_rate == 2.0 * ULP
    assert found.period == pytest.approx(math.pi / ULP, rel=4e-16)


@pytest.mark.parametrize("start", [(1.0, 1.0, 0.0), (0.0, -3.0, 0.0)])
def test_a_spin_across_the_axis_of_symmetry_goes_round_it_at_the_rate_zero(start):
    found = precession(diagonal((1.0, 1.0, 2.0)), start)
    assert found.body_rate == 0.0
    assert "body_rate" not in found.absent
    assert "period" in found.absent
    assert precession(diagonal((1.0, 1.0, 2.0)), (0.0, 0.0, 1.0)).body_rate is None


def test_kinds_go_by_the_moments_along_the_axes_and_by_a_mean_of_derived_ones():
    (low, middle, _), notices = moments_of_kinds(diagonal((1.0, 1.0 + ULP, 2.0)).principal)[0][0], ()
    assert low < middle
    c, s = math.cos(0.7), math.sin(0.7)
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    tensor = turn @ np.diag([1.0, 1.0 + 3 * ULP, 2.0]) @ turn.T
    inertia = MassProperties(0.5 * (tensor + tensor.T), np.zeros((3, 3))).principal
    (values, tails), notices = moments_of_kinds(inertia)
    assert (values[0], tails[0]) == (values[1], tails[1])
    exact = [
        Fraction(float(h)) + Fraction(float(t)) for h, t in zip(inertia.moments, inertia.moments_tail, strict=True)
    ]
    mean = Fraction(float(values[0])) + Fraction(float(tails[0]))
    assert abs(mean - (exact[0] + exact[1]) / 2) <= Fraction(2) ** -104
    assert codes(notices) == {"moments-equal-within-rounding"}
    cube = Composite((Part(Cuboid(edges=(0.3, 0.3, 0.3), mass=1.0), attitude=(0.3, 0.1, -0.7, 0.2)),))
    (values, _), notices = moments_of_kinds(cube.mass_properties().principal)
    assert len(set(values.tolist())) == 1
    assert notices == ()
