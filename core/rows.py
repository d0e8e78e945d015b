"""Many quantities of one kind, stored in one array.

The annotation is used like `core.quantities.Quantity`: by `check`, by the validator of the service, which does not
convert such arrays, and in its OpenAPI document.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.errors import InvalidParameter, Path
from core.quantities import Quantity
from core.work import spend


@dataclass(frozen=True)
class Rows:
    """Rows of numbers in one array. An array is checked without creating a Python object for each number.

    Parameters
    ----------
    width : int
        Numbers per row; 0 for a plain list of numbers.
    quantity : Quantity
        Unit and range of each number.
    at_least, at_most : int
        Admissible numbers of rows.
    whole : bool
        Whether the numbers are indices, stored as integers.
    """

    width: int
    quantity: Quantity
    at_least: int = 1
    at_most: int = 1_000_000
    whole: bool = False

    def read(self, path: Path, value: object) -> NDArray[Any]:
        """Return `value` as a read-only array, shape (n, width) or (n,).

        Raises
        ------
        InvalidParameter
            With the path of the first entry that is not a finite number of the right kind.
        """
        if isinstance(value, np.ndarray) and value.dtype.kind in ("iu" if self.whole else "fiu"):
            return self._kept(path, value)
        rows = value.tolist() if isinstance(value, np.ndarray) else value
        if not isinstance(rows, (list, tuple)):
            raise InvalidParameter(path, "be a list")
        if not self.at_least <= len(rows) <= self.at_most:
            raise InvalidParameter(path, f"have from {self.at_least} to {self.at_most} entries, not {len(rows)}")
        spend(len(rows))
        # Types and lengths are collected as sets, without Python code for each row.
        if self.width and not (set(map(type, rows)) <= {list, tuple} and set(map(len, rows)) <= {self.width}):
            i = next(i for i, row in enumerate(rows) if type(row) not in (list, tuple) or len(row) != self.width)
            raise InvalidParameter((*path, i), f"be a list of {self.width} numbers")
        flat = list(chain.from_iterable(rows)) if self.width else rows
        kinds = list(map(type, flat))
        wrong = set(kinds) - ({int} if self.whole else {int, float})
        if wrong:
            i = min(map(kinds.index, wrong))
            raise InvalidParameter((*path, *self._place(i)), "be a whole number" if self.whole else "be a number")
        try:
            array = np.array(flat, dtype=np.int64 if self.whole else np.float64)
        except OverflowError:
            limit = 2**63 - 1 if self.whole else 10**308
            i = next(i for i, entry in enumerate(flat) if type(entry) is int and abs(entry) > limit)
            kind = "64-bit integers" if self.whole else "doubles"
            raise InvalidParameter((*path, *self._place(i)), f"be within the range of {kind}") from None
        self._require_inside(path, array)
        array = array.reshape(-1, self.width) if self.width else array
        array.setflags(write=False)
        return array

    def _kept(self, path: Path, value: NDArray[Any]) -> NDArray[Any]:
        """Return a read-only copy of an array, checked without a Python loop over its numbers."""
        if value.ndim == 0:
            raise InvalidParameter(path, "be a list")
        if not self.at_least <= len(value) <= self.at_most:
            raise InvalidParameter(path, f"have from {self.at_least} to {self.at_most} entries, not {len(value)}")
        if value.shape[1:] != ((self.width,) if self.width else ()):
            raise InvalidParameter((*path, 0), f"be a list of {self.width} numbers" if self.width else "be a number")
        kind: type[np.generic] = np.int64 if self.whole else np.float64
        if value.dtype.kind == "u" and self.whole and value.max(initial=0) > np.iinfo(np.int64).max:
            at = int(np.argmax(value > np.iinfo(np.int64).max))
            raise InvalidParameter((*path, *self._place(at)), "be within the range of 64-bit integers")
        array = np.array(value, dtype=kind, order="C")
        self._require_inside(path, array)
        array.setflags(write=False)
        return array

    def _require_inside(self, path: Path, array: NDArray[Any]) -> None:
        if not self._inside(array):
            flat, q = array.reshape(-1), self.quantity
            good = np.isfinite(flat) & (flat > q.above) & (flat >= q.at_least) & (flat <= q.at_most) & (flat < q.below)
            at = int(np.argmin(good))
            q.check((*path, *self._place(at)), flat[at].item())

    def _place(self, i: int) -> Path:
        return (i // self.width, i % self.width) if self.width else (i,)

    def _inside(self, array: NDArray[Any]) -> bool:
        if not array.size:
            return True
        q = self.quantity
        low, high = float(array.min()), float(array.max())
        return (
            isfinite(low)
            and isfinite(high)
            and low > q.above
            and low >= q.at_least
            and high <= q.at_most
            and high < q.below
        )

    def test(self, value: object) -> bool:
        """Return whether `value` has already been read."""
        return isinstance(value, np.ndarray)

    def check(self, path: Path, value: object) -> None:
        """Raise `InvalidParameter` unless `value` is such an array or can be read as one."""
        if not isinstance(value, np.ndarray):
            self.read(path, value)

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> dict[str, Any]:
        return {"type": "any", "metadata": {"rows": self}}

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        number = {"type": "integer" if self.whole else "number", **self.quantity.limits, "x-unit": self.quantity.unit}
        row = (
            {"type": "array", "items": number, "minItems": self.width, "maxItems": self.width} if self.width else number
        )
        return {"type": "array", "items": row, "minItems": self.at_least, "maxItems": self.at_most}
