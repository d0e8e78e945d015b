"""From the moves of a body's tensor and of the start to those of principal moments, components and constants."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from core.rotation.closed_form.circulation import PERIODIC, SEPARATRIX, STEADY
from core.rotation.closed_form.constants_of_motion import Motion
from core.rotation.uncertainty import constant_sensitivities as moved
from core.rotation.uncertainty.phase_sensitivities import LARGEST_MODULUS, phase_errors
from core.rotation.uncertainty.projected_sensitivities import moves_along_axes, moves_of_given_moments

Floats = NDArray[np.float64]

FIRST_ORDER = 0.1
"""Beyond this an error, and a relative move of a constant, is no longer told by its first derivative."""

MOST_INPUTS = 3000
"""With more inputs the bounds that need no phases are stated."""

_MOST = 700.0
_LEAST = 2.0**-1074
_THINNEST = 2.0**-1000
_PLANES = ((0, 1), (1, 2), (2, 0))


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """First-order moves of one motion for a relative uncertainty of one, in units in which figures are of order one.

    Attributes
    ----------
    moments, components : ndarray, shape (3,)
        Ascending principal moments, and the start along their axes.
    gaps : tuple of 2 floats
        B - A and C - B.
    own, own_start : float
        Sums over the inputs of the norms of their moves of tensor and of start.
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
        motion: Motion,
        largest: float,
        unit: float,
    ) -> Sensitivities:
        """Project the moves of a tensor, shape (n, 3, 3), in body axes, or of the moments themselves where it is None.

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
        sums, crossed = np.zeros(moved.COUNT), False
        dn, k1 = _start_of(moments, gaps, components, motion)
        if moments[0] == 0.0:
            # A line of matter along a body axis, which no uncertainty gives a moment about itself.
            moments = np.maximum(moments, moments[1])
        if axes is None or tensors is None:
            dI, dw, turns = moves_of_given_moments(moments, components)
            own, own_start = sum(moments.tolist()), sum(map(abs, components.tolist()))
        else:
            dI, dw, turns, crosses, own = moves_along_axes(*gaps, components, axes, velocity, tensors)
            own_start = sum(map(abs, velocity.tolist()))
            for plane, across in zip(_PLANES, crosses, strict=True):
                if across.any():
                    crossed = True
                    _add_crossed(moments, gaps, components, motion, plane, across, sums)
        table = _add(moments, gaps, components, motion, dI, dw, turns, k1, sums)
        phases = None
        if motion.regime == PERIODIC and motion.m <= LARGEST_MODULUS and not crossed and len(table) <= MOST_INPUTS:
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
        """Return the bound for early times: Euler's equations, of bounded steepness, from a moved start."""
        first, second, third = self._ratios
        s, w = self.sums, self.largest
        step, force = s[moved.START], w * w * s[moved.FORCE] / math.sqrt(3.0)
        in_body = self.own_start, w * w * self.own * (1.0 + max(first, second, third)) / float(self.moments[0])
        along_axes = self._carried(step, force, time) + s[moved.TURN] * w
        if uncertainty * s[moved.TURN] > FIRST_ORDER:
            along_axes = math.inf
        return uncertainty * min(along_axes, self._carried(*in_body, time))

    def _carried(self, step: float, force: float, time: float) -> float:
        """Return what a moved start and a moved torque have come to."""
        first, second, third = self._ratios
        if 0.0 in self.gaps:
            # The component along the third axis drifts, and turns the other two.
            turn = max(first, third) * self.largest * time
            return step * (1.0 + turn) + force * time * (1.0 + 0.5 * turn)
        # Grönwall's lemma, with the symmetric part of the Jacobian; the middle coefficient has the other sign.
        steepest = max(abs(first - second), abs(second - third), abs(third + first))
        power = math.sqrt(1.0 / 3.0) * steepest * self.largest * time
        return (step + force * time) * math.exp(power) if power < _MOST else math.inf

    def crosswise(self, time: float) -> float:
        """Return by how much what is across a steady spin along a principal axis grows."""
        if self.crossed or np.count_nonzero(self.components) > 1:
            return math.inf
        if not self.sums[moved.CROSSWISE]:
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


def _start_of(moments: Floats, gaps: tuple[float, float], w: Floats, motion: Motion) -> tuple[float, float]:
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
    moments: Floats, gaps: tuple[float, float], w: Floats, motion: Motion,
    dI: Floats, dw: Floats, turns: Floats, k1: float, sums: Floats,
) -> Floats:  # fmt: skip
    moved.add_start(moments, w, dI, dw, turns, sums)
    table = np.zeros((len(dI), 6))
    if motion.regime != STEADY:
        moved.add_constants(moments, *gaps, w, motion.circled, motion.m, k1, motion.lattice.K, dI, dw, sums, table)
    return table


def _add_crossed(
    moments: Floats, gaps: tuple[float, float], w: Floats, motion: Motion,
    plane: tuple[int, int], across: Floats, sums: Floats,
) -> None:  # fmt: skip
    """Add moves that would turn the axes of two equal moments, which may as well be chosen at 45 degrees."""
    j, k = plane
    turned = w.copy()
    turned[j], turned[k] = math.sqrt(0.5) * (w[j] + w[k]), math.sqrt(0.5) * (w[k] - w[j])
    dI = np.zeros((len(across), 3))
    dI[:, j], dI[:, k] = across, -across
    _, k1 = _start_of(moments, gaps, turned, motion)
    _add(moments, gaps, turned, motion, dI, np.zeros_like(dI), np.zeros(len(across)), k1, sums)
