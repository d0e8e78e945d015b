"""From the sensitivities of a body's tensor and of the start to those of principal moments, components, constants."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.arrays import Floats
from core.rotation.closed_form.circulation import PERIODIC, SEPARATRIX, STEADY
from core.rotation.closed_form.constants_of_motion import ConstantsOfMotion
from core.rotation.uncertainty import constant_sensitivities as at
from core.rotation.uncertainty.phase_sensitivities import LARGEST_MODULUS, phase_errors
from core.rotation.uncertainty.projected_sensitivities import given_moment_sensitivities, projected_sensitivities

FIRST_ORDER = 0.1
"""Beyond this a first derivative no longer bounds an error, or the relative change of a constant."""

MOST_INPUTS_WITH_PHASES = 3000
"""With more inputs the bounds that need no phases are stated."""

_MOST = 700.0
_LEAST = 2.0**-1074
_THINNEST = 2.0**-1000
_PLANES = ((0, 1), (1, 2), (2, 0))

COMPONENTS = np.zeros((6, 3, 3))
"""The changes of a symmetric tensor by each of its six components."""
for _n, (_i, _j) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))):
    COMPONENTS[_n, _i, _j] = COMPONENTS[_n, _j, _i] = 1.0
COMPONENTS.setflags(write=False)


def tensors_of_moments(axes: Floats, moments: Floats, apart: tuple[bool, bool]) -> Floats:
    """Return the tensors, shape (n, 3, 3), that each moment by itself stands for; equal moments stand together.

    Parameters
    ----------
    axes : ndarray, shape (3, 3)
        Principal axes as columns.
    moments : ndarray, shape (3,)
        Ascending.
    apart : pair of bool
        Whether each of the first two differs from the next.
    """
    groups = np.cumsum([0, *apart])
    return np.array([(axes * np.where(groups == g, moments, 0.0)) @ axes.T for g in range(groups[2] + 1)])


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """First derivatives of one motion for a relative uncertainty of one, in units in which figures are of order one.

    Attributes
    ----------
    moments, components : ndarray, shape (3,)
        Ascending principal moments, and the start along their axes.
    gaps : tuple of 2 floats
        B - A and C - B.
    own, own_start : float
        Bounds of the norms of the changes of tensor and of start by all inputs together.
    sums : list of COUNT floats
        Of `core.rotation.uncertainty.constant_sensitivities`.
    largest : float
        Largest norm of the angular velocity.
    crossed : bool
        Whether an input would turn the axes of equal moments.
    dn, k1 : float
        At the start: the component along the circled axis as a share of its amplitude; the complementary modulus.
    phases : ndarray or None
        Of `core.rotation.uncertainty.phase_sensitivities`, where the motion is far enough from the separatrix.
    """

    moments: Floats
    components: Floats
    gaps: tuple[float, float]
    own: float
    own_start: float
    sums: list[float]
    largest: float
    crossed: bool
    dn: float
    k1: float
    phases: Floats | None

    @classmethod
    def of(
        cls,
        moments: Floats,
        gaps: tuple[float, float],
        components: Floats,
        axes: Floats | None,
        tensors: Floats | None,
        velocity: Floats,
        motion: ConstantsOfMotion,
        largest: float,
        unit: float,
    ) -> Sensitivities:
        """Project the sensitivities of a tensor, shape (n, 3, 3), in body axes, or of the moments where it is None.

        Parameters
        ----------
        moments, gaps, components, largest
            As the attributes; the largest norm of the angular velocity.
        axes : ndarray, shape (3, 3), or None
            Principal axes as columns, where they are not body axes.
        velocity : ndarray, shape (3,)
            The start in body axes.
        unit : float
            What brings the motion's rates to these units.
        """
        sums, crossed = np.zeros(at.COUNT), False
        dn, k1 = _start_of(moments, gaps, components, motion)
        if moments[0] == 0.0:
            # A line of matter along a body axis, which no uncertainty gives a moment about itself. Two moments below
            # every double next to the third are those of no matter: bounds that divide by them grow beyond all.
            moments = np.maximum(moments, max(moments[1], _THINNEST))
        if axes is None or tensors is None:
            dI, dw, turns = given_moment_sensitivities(moments, components)
            own, own_start = sum(moments.tolist()), math.hypot(*components.tolist())
        else:
            dI, dw, turns, crosses, own = projected_sensitivities(*gaps, components, axes, velocity, tensors)
            own_start = math.hypot(*velocity.tolist())
            for plane, across in zip(_PLANES, crosses, strict=True):
                if across.any():
                    crossed = True
                    _add_crossed(moments, gaps, components, motion, plane, across, sums)
        table = _add(moments, gaps, components, motion, dI, dw, turns, k1, sums)
        phases = None
        if (
            motion.regime == PERIODIC
            and motion.m <= LARGEST_MODULUS
            and not crossed
            and len(table) <= MOST_INPUTS_WITH_PHASES
        ):
            c = 0 if motion.circled == 2 else 2
            A_c, A_b, A_d = (abs(x) * unit for x in (motion.A_c, motion.A_b, motion.A_d))
            start = math.atan2(float(components[1]) * A_c, float(components[c]) * A_b)
            found = phase_errors(A_c, A_b, A_d, motion.m, start, k1, table)
            phases = found if np.isfinite(found).all() else None
        return cls(moments, components, gaps, own, own_start, sums.tolist(), largest, crossed, dn, k1, phases)

    @cached_property
    def finite(self) -> bool:
        """Whether every sum is a number, none having left the range of doubles on its way."""
        return all(map(math.isfinite, self.sums))

    @cached_property
    def _ratios(self) -> tuple[float, float, float]:
        """Euler's coefficients, in size."""
        (A, B, C), (low, high) = self.moments.tolist(), self.gaps
        return high / A, (low + high) / B, low / C

    def early(self, uncertainty: float, time: float) -> float:
        """Return the bound for early times: Euler's equations, of bounded steepness, from another start."""
        first, second, third = self._ratios
        s, w = self.sums, self.largest
        step, force = math.hypot(*s[at.START_A : at.START_C + 1]), w * w * s[at.FORCE]
        in_body = self.own_start, w * w * self.own * (1.0 + max(first, second, third)) / float(self.moments[0])
        along_axes = self._carried(step, force / math.sqrt(3.0), time)
        if self.third >= 0:
            along_axes = min(along_axes, self._of_equal_moments(time))
        along_axes += s[at.TURN] * w
        if uncertainty * s[at.TURN] > FIRST_ORDER:
            along_axes = math.inf
        return uncertainty * min(along_axes, self._carried(*in_body, time))

    @property
    def third(self) -> int:
        """Axis of the third moment where just two are equal, -1 otherwise."""
        return int(at.third_axis(*self.gaps))

    def _of_equal_moments(self, time: float) -> float:
        """Return the bound for two equal moments I, component by component; docs/physics/error-statements.md, bound 5.

        Unequal changes of the two moments drive the spin w_3 along the third axis, and w_3 turns the rest of the
        angular velocity: at the rate |I_3 - I|/I times its own change, and by what the two other coefficients change.
        Where neither changes, as for a cylinder known by radius and height that spins across its axis, nothing grows.
        """
        s, k = self.sums, self.third
        along = s[at.START_A + k]
        across = math.hypot(*(s[at.START_A + j] for j in range(3) if j != k))
        spin = abs(float(self.components[k]))
        rest = math.hypot(*(float(self.components[j]) for j in range(3) if j != k))
        drive = 0.5 * rest * rest * s[at.FORCE_ALONG] * time
        turning = max(self._ratios[0], self._ratios[2]) * (along + 0.5 * drive) + spin * s[at.FORCE_ACROSS]
        grown = math.hypot(along + drive, across + rest * time * turning)
        return grown if math.isfinite(grown) else math.inf

    def _carried(self, step: float, force: float, time: float) -> float:
        """Return what another start and another torque have come to."""
        first, second, third = self._ratios
        if 0.0 in self.gaps:
            # The component along the third axis drifts, and turns the other two.
            turn = max(first, third) * self.largest * time
            return step * (1.0 + turn) + force * time * (1.0 + 0.5 * turn)
        return (step + force * time) * growth_factor(first, second, third, math.sqrt(1.0 / 3.0) * self.largest * time)

    def crosswise(self, time: float) -> float:
        """Return by how much what is across a steady spin along a principal axis grows."""
        if self.crossed or np.count_nonzero(self.components) > 1:
            return math.inf
        if not self.sums[at.CROSSWISE]:
            return 1.0
        (A, B, C), (low, high) = self.moments.tolist(), self.gaps
        rate = self.largest * time
        axis = int(np.flatnonzero(self.components)[0])
        one, other = ((low / C, (low + high) / B), (low / C, high / A), (high / A, (low + high) / B))[axis]
        if axis == 1 and low and high:
            power = math.sqrt(one * other) * rate
            skew = math.sqrt(one / other)
            return math.exp(power) * max(skew, 1.0 / skew) if power < _MOST else math.inf
        # x' = -a y, y' = b x: an ellipse of axes in the ratio sqrt(b/a), or in short times a straight line.
        skew = 1.0
        for a, b in ((one, other), (other, one)):
            skew = max(skew, min(math.sqrt(b / a) if a else math.inf, 1.0 + b * rate))
        return skew


def growth_factor(first: float, second: float, third: float, time: float) -> float:
    """Return by how much a disturbance may have grown, by Grönwall's lemma in the norm that shows it best.

    With the sizes q of Euler's coefficients (that of the middle axis has the other sign), the square of a difference of
    two motions that weighs the axis k of an extreme moment s >= 1 times the others grows no faster than by the
    symmetric part of the Jacobian in that norm: with k the axis of the largest moment by

        max(|q_1 - q_2|, s q_3 + q_1/s, |s q_3 - q_2/s|)

    per unit of time, and the difference itself is at most s times as large. Where two moments are nearly equal, q_3 is
    small, and s in proportion to the time leaves a growth in proportion to it, as for two equal moments.

    Parameters
    ----------
    first, second, third : float
        (C - B)/A, (C - A)/B, (B - A)/C.
    time : float
        In units of sqrt(3) over the largest rate: |m.e|-type terms are at most 1/sqrt(3) of the product of norms.
    """
    least = math.inf
    for own, other in ((third, first), (first, third)):
        for weight in {1.0, max(1.0, time * max(other, second))}:
            rate = max(abs(other - second), weight * own + other / weight, abs(weight * own - second / weight))
            least = min(least, math.log(weight) + rate * time)
    return math.exp(least) if least < _MOST else math.inf


def _start_of(moments: Floats, gaps: tuple[float, float], w: Floats, motion: ConstantsOfMotion) -> tuple[float, float]:
    """Return dn at the start and the complementary modulus, which is right where its square has left the doubles."""
    if motion.regime == STEADY:
        return 1.0, 1.0
    d, c = (2, 0) if motion.circled == 2 else (0, 2)
    (low, high), i, x = gaps, moments.tolist(), np.abs(w).tolist()
    near, far = (high, low) if d == 2 else (low, high)
    # A line of matter has no least moment, and then nothing between the others either.
    # That of the thinnest needle may be below every double next to the others.
    share = i[1] * far / max(_THINNEST, i[d] * (low + high)) if far > 0.0 else 0.0
    # Components below every double next to the largest leave nothing to divide by, and bounds that are infinite.
    dn = max(_LEAST, x[d] / max(_LEAST, math.hypot(x[d], math.sqrt(share) * x[1])))
    if motion.regime == SEPARATRIX or motion.m1 > 1e-290:
        return dn, math.sqrt(motion.m1)
    ratio = x[c] / max(_LEAST, x[d])
    return dn, dn * math.sqrt(max(1e-15, 1.0 - i[c] * far / max(_THINNEST, i[d] * near) * ratio * ratio))


def _add(
    moments: Floats, gaps: tuple[float, float], w: Floats, motion: ConstantsOfMotion,
    dI: Floats, dw: Floats, turns: Floats, k1: float, sums: Floats,
) -> Floats:  # fmt: skip
    axis = int(np.abs(w).argmax()) if motion.regime == STEADY else motion.circled
    at.add_start(moments, *gaps, w, axis, dI, dw, turns, sums)
    table = np.zeros((len(dI), 6))
    if motion.regime != STEADY:
        at.add_constants(moments, *gaps, w, motion.circled, motion.m, k1, motion.lattice.K, dI, dw, sums, table)
    return table


def _add_crossed(
    moments: Floats, gaps: tuple[float, float], w: Floats, motion: ConstantsOfMotion,
    plane: tuple[int, int], across: Floats, sums: Floats,
) -> None:  # fmt: skip
    """Add changes that would turn the axes of two equal moments, which may as well be chosen at 45 degrees."""
    j, k = plane
    turned = w.copy()
    turned[j], turned[k] = math.sqrt(0.5) * (w[j] + w[k]), math.sqrt(0.5) * (w[k] - w[j])
    dI = np.zeros((len(across), 3))
    dI[:, j], dI[:, k] = across, -across
    _, k1 = _start_of(moments, gaps, turned, motion)
    _add(moments, gaps, turned, motion, dI, np.zeros_like(dI), np.zeros(len(across)), k1, sums)
