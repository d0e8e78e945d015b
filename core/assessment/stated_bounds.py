"""What an answer says beside a figure: the bound of its error, and the body axis to which it belongs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from core.arrays import Floats
from core.assessment.compare import Reference
from core.assessment.figures import inside, value_at
from core.errors import Path

ONE_ERROR = ("value", "values", "time", "least", "largest")
"""Figures of objects whose `error` is that of these alone."""

OF_PROJECTIONS = 6.0
"""How far an entry of a projection on at most three axes may be off, over that of their components: a projection is
the sum of the products of each unit vector with itself, and either factor of a product may be wrong."""

ALONG = 1e-9
"""By how much the component of a unit vector along a body axis may miss 1."""


def bound_beside(answer: Mapping[str, Any], path: Path) -> float | Floats | None:
    """Return the bound that an answer states of a figure: under `errors` by its name, or as `error` of the only one."""
    names = [k for k, step in enumerate(path) if isinstance(step, str)]
    for k in reversed(names):
        bound = inside(_reached(answer, path[:k]), "errors")
        for step in path[k:]:
            if isinstance(bound, (float, list, tuple, np.ndarray)) or bound is None:
                break
            # Values by names have their errors by the same names beside them.
            bound = bound if step == "values" and isinstance(bound, Mapping) else inside(bound, step)
        found = value_at({"": bound}, ("",))
        if isinstance(found, (float, np.ndarray)):
            return found
    if path[names[-1]] in ONE_ERROR:
        found = value_at(answer, (*path[: names[-1]], "error"))
        return found if isinstance(found, (float, np.ndarray)) else None
    return None


def _reached(answer: Any, path: Path) -> Any:
    """Return whatever stands at a path of an answer."""
    for step in path:
        answer = inside(answer, step)
    return answer


def distance_of(bare: Reference, bound: float | Floats) -> float:
    """Return how far a figure is from the true one, as its form measures it, if its entries are wrong by `bound`."""
    wrong = float(np.max(bound))
    return OF_PROJECTIONS * wrong if bare.form in ("axes", "direction") else wrong


def body_axis_of(answer: Mapping[str, Any], path: Path) -> int | None:
    """Return which body axis a figure belongs to, 1, 2 or 3; None if it belongs to none of them."""
    last = path[-1]
    if isinstance(last, int) and len(path) > 1 and path[-2] == "moments":
        axes = value_at(answer, (*path[:-2], "axes"))
        axis = None if axes is None else axes[:, last]
    else:
        axis = value_at(answer, (*path[:-1], "axis"))
    if not isinstance(axis, np.ndarray) or axis.shape != (3,):
        return None
    along = int(np.abs(axis).argmax())
    return along + 1 if abs(axis[along]) > 1.0 - ALONG else None
