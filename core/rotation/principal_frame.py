"""Between the axes in which a body was defined and its principal axes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from core.compiled import kernel
from core.double_double import dd_add, dd_mul_d
from core.integration.system import Floats


@kernel()
def _components(
    axes: NDArray[np.float64], tail: NDArray[np.float64], v: NDArray[np.float64], out: NDArray[np.float64]
) -> None:
    for k in range(3):
        h, low = 0.0, 0.0
        for j in range(3):
            ph, pl = dd_mul_d(axes[j, k], tail[j, k], v[j])
            h, low = dd_add(h, low, ph, pl)
        out[0, k], out[1, k] = h, low


@dataclass(frozen=True, eq=False)
class PrincipalFrame:
    """Principal axes as columns in body axes, right-handed, as the sum of two arrays of shape (3, 3)."""

    axes: Floats
    axes_tail: Floats

    @cached_property
    def aligned(self) -> bool:
        """Whether the principal axes are the body axes, in some order and with some signs, exactly."""
        a = self.axes
        return bool(np.all((a == 0.0) | (np.abs(a) == 1.0))) and not np.any(self.axes_tail)

    @cached_property
    def rows(self) -> list[int]:
        """Body axis along which each principal axis lies, where they are aligned."""
        return [int(k) for k in np.argmax(np.abs(self.axes), axis=0)]

    @cached_property
    def signs(self) -> list[float]:
        """Sign of each principal axis along its body axis, where they are aligned."""
        return [float(self.axes[row, k]) for k, row in enumerate(self.rows)]

    def components(self, vector: Floats) -> tuple[Floats, Floats]:
        """Return a vector's principal components and their tails, each of shape (3,), exact where axes are aligned."""
        if self.aligned:
            exact = np.array([sign * vector[row] for row, sign in zip(self.rows, self.signs, strict=True)])
            return exact, np.zeros(3)
        out = np.empty((2, 3))
        _components(
            np.ascontiguousarray(self.axes),
            np.ascontiguousarray(self.axes_tail),
            np.ascontiguousarray(vector, dtype=np.float64),
            out,
        )
        return out[0], out[1]
