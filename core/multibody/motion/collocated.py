"""Runs by collocation, and their steps as pieces of a search."""

from __future__ import annotations

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.double_double import dd_add, dd_mul
from core.multibody.equations.packed import FORCES, Packed, Units, two_to
from core.multibody.motion.collocation import advance_collocated
from core.multibody.motion.radau import radau
from core.multibody.motion.run import Run, begun, run_by
from core.multibody.table.table import Table

AT_ONCE = 64
"""Steps for which there is room at once."""
FIRST = 2.0**-4
"""Share of the unit of time with which the first step is tried."""

PIECE, BEYOND = 0.5, 0.125
"""Share of a step that is a piece of a search, on which powers of time differ by no more than the motion itself, and by
how much a piece may reach beyond the end of a step, where its polynomial is a thousand times less exact."""

METHODS = {"doubles": (9, 2.0**-54), "reference": (11, 2.0**-66), "check": (13, 2.0**-78), "fine": (14, 2.0**-84)}
"""Stages and tolerances: all are in pairs of doubles, and named after the kinds of series that they replace."""


def collocated(table: Table, arrays: Packed, units: Units, kind: str, end: float, since: Run | None = None) -> Run:
    """Take steps by collocation to a time after the start, in the units of the arrays, or on from a run.

    It is singular where steps become too short.

    Raises
    ------
    BudgetExceeded
        Where more steps would be needed than one part may take.
    AccuracyUnreachable
        Where the motion leaves the range of doubles.
    """
    stages, tolerance = METHODS[kind]
    method = radau(stages)
    (q, v), clock, before = begun(table, units, since)
    largest, first = np.zeros((FORCES + 2, 2)), FIRST
    if since is not None:
        for power in range(2):
            np.maximum.at(largest[:, power], arrays.group, np.abs(since.series[:, :, power, 0]).max(axis=0))
        if before:
            first = float(since.starts[-2, 0] - since.starts[-3, 0])

    def steps(clock: Floats, starts: Floats, series: Floats) -> tuple[int, int]:
        nonlocal first
        ended, count, first = advance_collocated(
            arrays, method, q, v, clock, end, tolerance, largest, first, starts, series
        )
        return ended, count

    return run_by(steps, end, (q.copy(), v.copy()), (len(q), stages + 2, 2), AT_ONCE, clock, before)


def pieces_of_steps(
    run: Run, group: Integers, units: Units, times: Floats, reach: Floats, order: int
) -> tuple[tuple[Floats, Floats], Floats, Floats]:
    """Return the polynomials of a run about times after the start, as `Motion.steps_about` does."""
    scaled = np.asarray(times, dtype=np.float64) * two_to(-units.time)
    which, count, n = run.which(scaled), len(times), run.series.shape[1]
    long = np.diff(run.starts[:, 0])[which]
    rest = run.starts[which + 1, 0] - scaled
    natural = np.minimum(PIECE * long, np.maximum(rest, BEYOND * long)) * two_to(units.time)
    exponents = np.where(natural < reach, np.floor(np.log2(natural)), np.ceil(np.log2(reach)))
    lengths = np.exp2(exponents)
    series = np.zeros((count, n, order + 1, 2))
    paired = np.zeros((count, 2))
    paired[:, 0] = scaled
    shift_steps(run.starts, run.series, paired, which, series)
    powers = (lengths * two_to(-units.time))[:, None] ** np.arange(order + 1)
    series *= powers[:, None, :, None] * units.up[:, None, None]
    sizes = np.zeros(series.shape[:-1])
    for g in np.unique(group):
        own = group == g
        largest = np.max(np.abs(series[..., 0])[:, own], axis=1, keepdims=True)
        # Of what is even in time every other power is rounding: a power is at least as large as later ones.
        sizes[:, own] = np.maximum.accumulate(largest[..., ::-1], axis=-1)[..., ::-1]
    return (lengths, natural), series, sizes


@kernel()
def shift_steps(starts: Floats, series: Floats, times: Floats, which: Integers, out: Floats) -> None:
    """Fill in the series of the steps `which` about times, pairs of shape (t, 2), into `out` of shape (t, n, k, 2)."""
    last = series.shape[2] - 1
    for s in range(times.shape[0]):
        step = which[s]
        hh, hl = dd_add(times[s, 0], times[s, 1], -starts[step, 0], -starts[step, 1])
        for i in range(series.shape[1]):
            c = out[s, i]
            c[: last + 1] = series[step, i]
            # Horner's rule, again and again: the remainders are the coefficients.
            for k in range(last):
                for j in range(last - 1, k - 1, -1):
                    ph, pl = dd_mul(c[j + 1, 0], c[j + 1, 1], hh, hl)
                    c[j, 0], c[j, 1] = dd_add(c[j, 0], c[j, 1], ph, pl)
