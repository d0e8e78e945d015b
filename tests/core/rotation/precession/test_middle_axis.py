"""The tilt of the middle axis against a linear programme in rational arithmetic, and against samples."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.bodies.measured import InertiaTensor, PrincipalMoments
from core.certified.free_rotation import CertifiedRotation
from core.certified.precession import certified_precession
from core.rotation.precession.precession import Precession, precession
from core.rotation.torque_free import TorqueFree
from tests.core.bodies.exact_tensors import of_tensor
from tests.drawn import draws

ANGLE = 4 * 2.0**-52
"""Of an angle in doubles, relative: one unit of the arctangent, a rounding, and the same of the difference from pi."""

COMPONENTS = st.one_of(
    st.just(0.0),
    st.sampled_from([1.0, -1.0, 2.0, 3.0, 1e-9, -1e-30, 1e-150]),
    st.floats(-10, 10, allow_subnormal=False).map(lambda x: x if abs(x) > 1e-100 else 0.0),
)
MOMENTS = st.one_of(
    st.permutations([1.0, 2.0, 3.0]),
    st.permutations([14.0, 21.0, 24.0]),
    st.permutations([1.0, 1.0, 2.0]),
    st.lists(st.floats(1, 1.999), min_size=3, max_size=3),
)
TURN = np.array([[1, 2, 2], [2, 1, -2], [2, -2, 1]]) / 3


def cosine_squared(moments: list[float], spin: list[float]) -> Fraction:
    """Return the largest (M_b/L)^2 on the curve where both quadrics of the angular momentum meet.

    In the squares of its components the quadrics are planes, sum M^2 = L^2 and sum M^2/I = 2E. A linear function is
    greatest at a vertex of what they cut out of the octant: where the first or the last square vanishes.
    """
    order = sorted(range(3), key=lambda k: moments[k])
    i, w = [Fraction(moments[k]) for k in order], [Fraction(spin[k]) for k in order]
    whole = sum((x * x * y * y for x, y in zip(i, w, strict=True)), Fraction(0))
    energy = sum((x * y * y for x, y in zip(i, w, strict=True)), Fraction(0))
    found = []
    for k in (0, 2):
        # M_k^2 + M_1^2 = L^2 and M_k^2/I_k + M_1^2/I_1 = 2E.
        middle = (energy - whole / i[k]) / (1 / i[1] - 1 / i[k])
        if 0 <= middle <= whole:
            found.append(middle / whole)
    return max(found)


def least_angle(square: Fraction) -> mp.mpf:
    with mp.workdps(60):
        across, along = (mp.sqrt(mp.mpf(x.numerator) / x.denominator) for x in (1 - square, square))
        return mp.atan2(across, along)


def steady(spin: list[float]) -> bool:
    return sum(x != 0.0 for x in spin) == 1


def answer(moments: list[float], spin: list[float]) -> Precession:
    return precession(PrincipalMoments(tuple(moments)).mass_properties(), tuple(spin))  # type: ignore[arg-type]


@settings(deadline=None, max_examples=draws(300), derandomize=True)
@given(moments=MOMENTS, spin=st.lists(COMPONENTS, min_size=3, max_size=3))
def test_the_range_is_that_of_the_linear_programme(moments: list[float], spin: list[float]) -> None:
    found = answer(moments, spin)
    exact = CertifiedRotation.of_moments(moments, spin)
    proven = certified_precession(exact, 25)
    assert found.tumbles == proven.tumbles == exact.tumbles
    if found.symmetry != "triaxial" or not any(spin):
        assume(len(set(moments)) < 3 or not any(spin))
        assert found.middle_axis_tilt is proven.middle_axis_tilt is None
        assert not found.tumbles
        assert found.absent == proven.absent
        return
    assert found.middle_axis_tilt is not None
    assert proven.middle_axis_tilt is not None
    least, largest = found.middle_axis_tilt
    square = cosine_squared(moments, spin)
    true = least_angle(square)
    assert found.tumbles == (not steady(spin) and square > Fraction(1, 2))
    if steady(spin) and square == 1:
        backwards = spin[sorted(range(3), key=lambda k: moments[k])[1]] < 0
        assert least == largest == (math.pi if backwards else 0.0)
    else:
        assert abs(least - true) <= ANGLE * true
        assert abs(largest - (mp.pi - true)) <= ANGLE * largest
    for numeral, double in zip(proven.middle_axis_tilt, found.middle_axis_tilt, strict=True):
        assert float(numeral) == pytest.approx(double, rel=ANGLE, abs=0)
    system = TorqueFree(PrincipalMoments(tuple(moments)).mass_properties(), np.array(spin))  # type: ignore[arg-type]
    tilt = system.closed_form().middle_axis_tilt
    assert tilt is not None
    assert (tilt.range, tilt.tumbles) == (found.middle_axis_tilt, found.tumbles)


@settings(deadline=None, max_examples=draws(60), derandomize=True)
@given(
    moments=st.permutations([1.0, 2.0, 3.0]),
    spin=st.lists(st.sampled_from([-2.0, -0.5, 0.0, 0.25, 1.0, 3.0]), min_size=3, max_size=3),
)
def test_a_turned_body_tilts_as_the_same_body_along_its_axes(moments: list[float], spin: list[float]) -> None:
    # Exactly 45 degrees are decided with the rounding of a turned body's derived moments.
    assume(not any(spin) or len(set(moments)) < 3 or cosine_squared(moments, spin) != Fraction(1, 2))
    # Nine times the tensor and three times the spin are integers and quarters, exact in doubles.
    tensor, start = 9 * TURN @ np.diag(moments) @ TURN.T, 3 * TURN @ np.array(spin)
    tensor, start = np.round(tensor), np.round(start * 4) / 4
    rows: Any = tuple(tuple(row) for row in tensor.tolist())
    turned = precession(InertiaTensor(rows).mass_properties(), tuple(start.tolist()))
    plain = answer(moments, spin)
    exact = CertifiedRotation.of(of_tensor(tensor.tolist()), start.tolist())
    assert turned.tumbles == plain.tumbles == exact.tumbles
    proven = exact.middle_axis_tilt(20)
    if plain.middle_axis_tilt is None:
        assert turned.middle_axis_tilt is proven is None
        return
    if plain.middle_axis_tilt[0] == plain.middle_axis_tilt[1] != 0.5 * math.pi:
        # The sense of a turned axis follows from its own components, of which two may tie.
        assert turned.middle_axis_tilt in ((0.0, 0.0), (math.pi, math.pi))
        assert proven in (("0", "0"), ("3.1415926535897932385",) * 2)
        return
    assert turned.middle_axis_tilt == pytest.approx(plain.middle_axis_tilt, rel=ANGLE, abs=0)
    assert proven is not None
    assert [float(x) for x in proven] == pytest.approx(plain.middle_axis_tilt, rel=ANGLE, abs=0)


@pytest.mark.parametrize(
    ("spin", "tumbles"),
    [
        ((2.0, 0.01, 0.01), False),
        ((0.01, 2.0, 0.01), True),
        ((0.01, 0.01, 2.0), False),
        ((1.0, 1.0, 1.0), True),
        ((1.0, 0.2, 1.0), False),
    ],
)
def test_samples_stay_within_the_range_and_come_to_its_ends(spin: tuple[float, float, float], tumbles: bool) -> None:
    body = PrincipalMoments((1.0, 2.0, 3.0)).mass_properties()
    rotation = TorqueFree(body, np.array(spin)).closed_form()
    tilt, period = rotation.middle_axis_tilt, rotation.period
    assert tilt is not None
    assert period is not None
    momentum = rotation.sample(np.linspace(0.0, period, 20001)) * np.array([1.0, 2.0, 3.0])
    angles = np.arctan2(np.hypot(momentum[:, 0], momentum[:, 2]), momentum[:, 1])
    assert angles.min() >= tilt.least - 1e-14
    assert angles.max() <= tilt.largest + 1e-14
    assert [angles.min(), angles.max()] == pytest.approx(tilt.range, abs=1e-6)
    assert tilt.tumbles is tumbles
    assert tumbles == bool(angles.min() < math.pi / 4 and angles.max() > 3 * math.pi / 4)


def test_45_degrees_exactly_is_no_tumbling() -> None:
    # cos = I_b w_b/L = 6/sqrt(72) where the first component vanishes.
    assert answer([1.0, 2.0, 3.0], [0.0, 3.0, 2.0]).tumbles is False
    assert answer([1.0, 2.0, 3.0], [0.0, 3.0, 1.9999999999999998]).tumbles is True
    # The same turned, its moments the roots of a cubic.
    tensor = np.round(9 * TURN @ np.diag([1.0, 2.0, 3.0]) @ TURN.T).tolist()
    start = np.round(3 * TURN @ np.array([0.0, 3.0, 2.0])).tolist()
    assert CertifiedRotation.of(of_tensor(tensor), start).tumbles is False


def test_the_separatrix_tends_to_both_ends() -> None:
    found = answer([14.0, 21.0, 24.0], [6.0, 2.0, 7.0])
    assert found.regime == "separatrix"
    assert found.middle_axis_tilt == (0.0, math.pi)
    assert found.tumbles


def test_a_tilt_below_the_doubles_is_null_and_said_to_be() -> None:
    moments = [1e-150, 1.0, 1.0 + 2.0**-52]
    assert answer(moments, [0.0, 1.0, 1e-280]).middle_axis_tilt is not None
    found = answer(moments, [1e-200, 1.0, 1e-280])
    assert found.tumbles
    assert found.middle_axis_tilt is None
    assert found.absent["middle_axis_tilt"] == "leaves the range of double precision"
    assert "middle_axis_tilt leaves the range of double precision and is null" in [w.detail for w in found.warnings]
