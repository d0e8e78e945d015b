"""Between the axes in which a body was defined and its principal axes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.bodies.principal_inertia import RESOLUTION, PrincipalInertia
from core.compiled import kernel
from core.double_double import dd_add, dd_mul_d


@kernel()
def _own_axes(axes: NDArray[np.float64], tail: NDArray[np.float64]) -> bool:
    for row in range(3):
        for column in range(3):
            x = axes[row, column]
            if not (x == 0.0 or x == 1.0 or x == -1.0) or tail[row, column] != 0.0:
                return False
    return True


@kernel()
def resolve(
    axes: NDArray[np.float64],
    axes_tail: NDArray[np.float64],
    moments: NDArray[np.float64],
    moments_tail: NDArray[np.float64],
    x: float,
    y: float,
    z: float,
    derived: bool,
    out: NDArray[np.float64],
) -> float:
    """Fill `out`, shape (4, 3), with moments, angular velocity along their axes and the tails of each, in pairs.

    The moments are those of the motion and (x, y, z) the angular velocity in body axes. Where the axes were derived,
    what is below the resolution of derived numbers is noise, whose sign would decide the regime, and is taken as 0.
    Where they are exact so is every component, however small. What is returned is the largest share of the largest
    moment or component that was taken as 0.
    """
    for k in range(3):
        out[0, k], out[1, k] = moments[k], moments_tail[k]
        # Along body axes, in whatever order, the sum has one term that is not 0, and is exact.
        h, low = dd_mul_d(axes[0, k], axes_tail[0, k], x)
        ph, pl = dd_mul_d(axes[1, k], axes_tail[1, k], y)
        h, low = dd_add(h, low, ph, pl)
        ph, pl = dd_mul_d(axes[2, k], axes_tail[2, k], z)
        out[2, k], out[3, k] = dd_add(h, low, ph, pl)
    dropped = 0.0
    if not derived:
        return dropped
    for k in range(2):
        # With the tails: over many turns a difference far below an ulp is seen.
        gap = (out[0, k + 1] - out[0, k]) + (out[1, k + 1] - out[1, k])
        if gap <= RESOLUTION * moments[2]:
            out[0, k + 1], out[1, k + 1] = out[0, k], out[1, k]
            dropped = max(dropped, abs(gap) / moments[2])
    largest = max(abs(out[2, 0]), abs(out[2, 1]), abs(out[2, 2]))
    for k in range(3):
        if abs(out[2, k]) <= RESOLUTION * largest and largest > 0.0:
            dropped = max(dropped, abs(out[2, k]) / largest)
            out[2, k], out[3, k] = 0.0, 0.0
    return dropped


class Resolved(NamedTuple):
    """Principal moments, ascending, and angular velocity along their axes, each with its tail, shape (3,).

    `dropped` is what was taken for noise, as a share of the largest moment or component.
    """

    moments: Floats
    moments_tail: Floats
    angular_velocity: Floats
    angular_velocity_tail: Floats
    dropped: float

    @property
    def numbers(self) -> tuple[Floats, Floats, Floats, Floats]:
        """Moments and angular velocity with their tails."""
        return self.moments, self.moments_tail, self.angular_velocity, self.angular_velocity_tail

    @classmethod
    def of(cls, inertia: PrincipalInertia, angular_velocity: Floats) -> Resolved:
        """Return what `resolve` makes of a body and its angular velocity in body axes, shape (3,)."""
        found = np.empty((4, 3))
        x, y, z = map(float, angular_velocity)
        derived = not inertia.rounding.exact_zeros
        dropped = resolve(
            inertia.axes, inertia.axes_tail, inertia.moments, inertia.moments_tail, x, y, z, derived, found
        )
        if inertia.tensor is not None and inertia.tensor.turns_steadily(angular_velocity):
            # Of several components all but one are noise, unless they belong to equal moments.
            main = int(np.abs(found[2]).argmax())
            equal = [k for k in range(3) if found[0, k] == found[0, main] and found[1, k] == found[1, main]]
            found[2:, [k for k in range(3) if k not in equal]] = 0.0
        return cls(found[0], found[1], found[2], found[3], dropped)


@dataclass(frozen=True, eq=False)
class PrincipalFrame:
    """Principal axes as columns in body axes, right-handed, as the sum of two arrays of shape (3, 3)."""

    axes: Floats
    axes_tail: Floats

    @cached_property
    def aligned(self) -> bool:
        """Whether the principal axes are the body axes, in some order and with some signs, exactly."""
        return bool(_own_axes(self.axes, self.axes_tail))

    @cached_property
    def rows(self) -> list[int]:
        """Body axis along which each principal axis lies, where they are aligned."""
        columns = zip(*self.axes.tolist(), strict=True)
        return [next(row for row, x in enumerate(column) if x) for column in columns]

    @cached_property
    def signs(self) -> list[float]:
        """Sign of each principal axis along its body axis, where they are aligned."""
        return [float(self.axes[row, k]) for k, row in enumerate(self.rows)]

    def to_body(self, vectors: Floats) -> Floats:
        """Return vectors given by principal components, shape (n, 3), in body axes, exactly where axes are aligned."""
        if not self.aligned:
            turned: Floats = vectors @ self.axes.T
            return turned
        body = np.empty_like(vectors)
        for k, (row, sign) in enumerate(zip(self.rows, self.signs, strict=True)):
            body[:, row] = sign * vectors[:, k]
        return body
