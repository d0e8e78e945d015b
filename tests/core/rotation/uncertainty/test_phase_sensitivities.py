"""The error of the angular velocity phase by phase against difference quotients of the motion itself, at 40 digits."""

from __future__ import annotations

import mpmath
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from core.rotation.uncertainty.phase_sensitivities import BETWEEN, STEPS, largest_until, phase_errors
from tests.drawn import draws

STEP = mpmath.mpf(10) ** -15

amplitude = st.floats(0.2, 2.0)
move = st.floats(-1.0, 1.0)
parameter = st.floats(0.01, 0.9)
start = st.floats(-3.0, 3.0)
rows = st.tuples(*6 * [move])


class Family:
    """Motions (A_c cn, A_b sn, A_d dn) whose constants move along one row of the table."""

    def __init__(self, amplitudes, m: float, phase: float, row) -> None:
        self.amplitudes, self.row = [mpmath.mpf(a) for a in amplitudes], [mpmath.mpf(x) for x in row]
        self.m, self.phase = mpmath.mpf(m), mpmath.mpf(phase)
        self.k1 = mpmath.sqrt(1 - self.m)
        self.delta = mpmath.sqrt(1 - self.m * mpmath.sin(self.phase) ** 2)

    def at(self, step, gone) -> list:
        """Return the angular velocity where the motion that is not moved has gone so far in u."""
        m = self.m + step * self.row[5] * self.k1
        u = mpmath.ellipf(self.phase + step * self.row[3] * self.delta, m) + gone * mpmath.exp(step * self.row[4])
        turned = (
            (a + step * x) * mpmath.ellipfun(name, u, m=m)
            for a, x, name in zip(self.amplitudes, self.row, ("cn", "sn", "dn"), strict=False)
        )
        return list(turned)

    def moved(self, gone) -> mpmath.mpf:
        above, below = self.at(STEP, gone), self.at(-STEP, gone)
        return mpmath.norm([(a - b) / (2 * STEP) for a, b in zip(above, below, strict=True)])


@settings(deadline=None, derandomize=True, max_examples=draws(40))
@given(st.tuples(amplitude, amplitude, amplitude), parameter, start, rows, st.integers(0, 2 * STEPS + 1))
def test_error_at_a_phase_is_the_derivative_of_the_motion(amplitudes, m, phase, row, place) -> None:
    with mpmath.workdps(40):
        family = Family(amplitudes, m, phase, row)
        out = phase_errors(*amplitudes, m, phase, float(family.k1), np.array([row]))
        side, j = divmod(place, STEPS + 1)
        way = 1 - 2 * side
        phi = family.phase + way * j * mpmath.pi / STEPS
        gone = mpmath.ellipf(phi, family.m) - mpmath.ellipf(family.phase, family.m)
        # Gauss's two points on steps h = pi/32: h^4/4320 of the fourth derivative of sin^2/2 Delta^3, which grows as
        # Delta^-7 and is 2.1e-8 60/k1^7 at most; that of 1/Delta is smaller.
        quadrature = 2.2e-8 * 60 / float(family.k1) ** 7 * np.pi
        assert abs(out[place, 0] - abs(gone)) <= quadrature
        assert abs(out[place, 1] - family.moved(gone)) <= 6 * quadrature + 1e-13
        # What the motion itself does in a unit of u.
        slope = mpmath.norm([mpmath.diff(lambda u, n=n: family.at(mpmath.mpf(0), u)[n], gone) for n in range(3)])
        assert abs(out[place, 2] - slope) <= 1e-12


@settings(deadline=None, derandomize=True, max_examples=draws(40))
@given(st.tuples(amplitude, amplitude, amplitude), parameter, start, rows, st.floats(-1.0, 1.0), st.floats(0.1, 12.0))
def test_the_largest_covers_every_phase_that_is_reached(amplitudes, m, phase, row, part, angle) -> None:
    with mpmath.workdps(40):
        family = Family(amplitudes, m, phase, row)
        phases = phase_errors(*amplitudes, m, phase, float(family.k1), np.array([row]))
        K = mpmath.ellipk(family.m)
        drift = abs(family.row[4] - mpmath.diff(mpmath.ellipk, family.m) / K * family.row[5] * family.k1)
        stated = largest_until(phases, angle, float(2 * K), float(drift))
        assert family.moved(mpmath.mpf(part) * angle) <= stated


def test_nothing_moves_nothing() -> None:
    phases = phase_errors(1.0, 1.0, 1.0, 0.5, 0.3, 0.5**0.5, np.zeros((2, 6)))
    assert phases.shape == (2 * STEPS + 2, 3)
    assert not phases[:, 1].any()
    assert largest_until(phases, 100.0, 3.7, 0.0) == 0.0
    # One amplitude alone: cos phi of it, at phi = 0.
    alone = np.zeros((1, 6))
    alone[0, 0] = 2.0
    phases = phase_errors(1.0, 1.0, 1.0, 0.5, 0.0, 0.5**0.5, alone)
    assert phases[0, 1] == 2.0
    assert largest_until(phases, 0.0, 3.7, 0.0) == BETWEEN * 2.0
