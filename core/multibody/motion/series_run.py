"""Runs by Taylor series: the orders and tolerances of each kind."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from core.arrays import Floats
from core.errors import AccuracyUnreachable
from core.multibody.equations.packed import Packed, Units, two_to
from core.multibody.motion.run import Run, begun, run_by
from core.multibody.motion.series import STUCK, advance
from core.multibody.motion.series_pairs import advance_pairs
from core.multibody.table.table import Table

GivesUp = Callable[[Floats, Floats, float, float], bool]

_CHUNK = 2**21
"""Bytes for the first steps of a run in pairs, twice those of as many in doubles; what is not used is not touched.

Both together are so much less than twice the larger that the C library does not map them anew for every run.
"""
# A higher order would take longer steps at the same tolerance, until they are longer than the series of neighbouring
# motions converge, which may have a singularity that the motion itself has not; rounding then grows from step to step.
ORDER, TOLERANCE = 24, 2.0**-56
REFERENCE_ORDER, REFERENCE_TOLERANCE = 28, 2.0**-72
FINE_ORDER, FINE_TOLERANCE = 32, 2.0**-100
CHECK_ORDER, CHECK_TOLERANCE = 30, 2.0**-94
"""Of series in doubles, of what they are compared with, and of two runs in pairs whose difference is their error."""


def integrate(
    table: Table,
    arrays: Packed,
    units: Units,
    kind: str,
    end: float,
    since: Run | None = None,
    gives_up: GivesUp | None = None,
) -> Run:
    """Take steps to a time in the units of the arrays, from the start, or from where the last step of a run starts.

    Parameters
    ----------
    gives_up : callable, optional
        Called with places, rates, the time to be reached and the steps that this takes, when the arrays are full:
        whether another method is better.

    Raises
    ------
    BudgetExceeded
        Where more steps would be needed than one part may take.
    AccuracyUnreachable
        Where the motion leaves the range of doubles, or a formula does not say how it goes on.
    """
    order, tolerance = {
        "doubles": (ORDER, TOLERANCE),
        "reference": (REFERENCE_ORDER, REFERENCE_TOLERANCE),
        "fine": (FINE_ORDER, FINE_TOLERANCE),
        "check": (CHECK_ORDER, CHECK_TOLERANCE),
    }[kind]
    (q, v), clock, before = begun(table, units, since)
    shape = (len(q), order + 1) if kind == "doubles" else (len(q), order + 1, 2)
    start = (q[:, 0], v[:, 0]) if kind == "doubles" else (q, v)
    take = advance if kind == "doubles" else advance_pairs

    def steps(clock: Floats, starts: Floats, series: Floats) -> tuple[int, int]:
        ended, count = take(arrays, q, v, clock, end, tolerance, starts, series)
        if ended == STUCK:
            time = clock[0] * two_to(units.time)
            raise AccuracyUnreachable(
                None,
                np.inf,
                f"a formula does not say how the motion goes on from {time:.10g} s: either side of the zero on which "
                "it depends leads back to it, or it begins with a power of time beyond those of the series",
                path=("times",),
                remedy="ask for earlier times, or describe friction that holds what is at rest by a contact",
            )
        return ended, count

    def stops(needed: float) -> bool:
        return gives_up is not None and gives_up(q, v, end, needed)

    many = max(16, _CHUNK // (16 * len(q) * (order + 1)))
    return run_by(steps, end, start, shape, many, clock, before, stops)
