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
        # Nine numbers: plain Python is quicker than arrays.
        entries = (x for row in self.axes.tolist() for x in row)
        return all(x in (0.0, 1.0, -1.0) for x in entries) and not any(
            x for row in self.axes_tail.tolist() for x in row
        )

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

    def components(self, vector: Floats) -> tuple[Floats, Floats]:
        """Return a vector's principal components and their tails, each of shape (3,), exact where axes are aligned."""
        if self.aligned:
            given = vector.tolist()
            exact = np.array([sign * given[row] for row, sign in zip(self.rows, self.signs, strict=True)])
            return exact, np.zeros(3)
        out = np.empty((2, 3))
        _components(
            np.ascontiguousarray(self.axes),
            np.ascontiguousarray(self.axes_tail),
            np.ascontiguousarray(vector, dtype=np.float64),
            out,
        )
        return out[0], out[1]
