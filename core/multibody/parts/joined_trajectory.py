"""The trajectory of a scene from those of its independent parts: every column with the error that it has in its part.

A column of several parts is one of the whole scene: momentum, energy, the work of gravity. It is the sum of theirs, and
so is its error.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import reduce

import numpy as np

from core.arrays import Floats
from core.multibody.parts.common_span import PartAnswer
from core.multibody.trajectory.inherited import NO_HORIZON_NEEDED
from core.systems.trajectory import HORIZON, Accuracy, Column, How, MotionEvent, Trajectory, Work

_ROUNDING = 2.0**-53
"""Relative error of a sum of two doubles."""


def joined_trajectory(
    answers: Sequence[PartAnswer], times: Floats, events: Sequence[MotionEvent], ended: MotionEvent | None
) -> Trajectory | None:
    """Return the samples of a scene at those of the times that all parts reach; None without times."""
    found = [(one.solution.trajectory, one.rows) for one in answers]
    own = [(trajectory, rows) for trajectory, rows in found if trajectory is not None]
    if not own:
        return None
    rows = reduce(np.intersect1d, [rows for _, rows in own], np.arange(len(times)))
    columns: dict[str, Column] = {}
    sums: set[str] = set()
    for trajectory, its_rows in own:
        picked = np.isin(its_rows, rows)
        for name, column in trajectory.columns.items():
            part = replace(column, values=column.values[picked])
            sums |= {name} & columns.keys()
            columns[name] = _sum(columns[name], part) if name in columns else part
    stated = [trajectory.accuracy for trajectory, _ in own]
    errors = [_relative(columns[name]) for name in sums]
    return Trajectory(
        times[rows],
        columns,
        _accuracy(stated, max([one.error for one in stated] + errors)),
        None,
        own[0][0].method,
        _work([trajectory.work for trajectory, _ in own], len(rows)),
        ended=HORIZON if ended is None else ended.kind,
        rows=rows,
        events=events,
        warnings=tuple(dict.fromkeys(notice for trajectory, _ in own for notice in trajectory.warnings)),
    )


def _sum(one: Column, other: Column) -> Column:
    """Return a column of the whole scene from those of two parts, at the same times."""
    values = one.values + other.values
    rounding = _ROUNDING * replace(one, values=np.abs(one.values) + np.abs(other.values)).largest
    known = one.inherited is not None and other.inherited is not None
    how: How = one.how if one.how == other.how else "measured against pairs"
    return Column(
        values,
        one.unit,
        one.error + other.error + rounding,
        how,
        (one.inherited or 0.0) + (other.inherited or 0.0) if known else None,
        max(one.scale or 0.0, other.scale or 0.0),
    )


def _relative(column: Column) -> float:
    return column.error / column.scale if column.scale else 0.0


def _accuracy(stated: Sequence[Accuracy], error: float) -> Accuracy:
    """Return the accuracy of a scene: the largest errors of its parts, and the earliest horizon."""
    exact = all(one.how == "closed form" for one in stated)
    lacking = next((one for one in stated if one.why is not None and one.why != NO_HORIZON_NEEDED), None)
    inherited = [one.inherited for one in stated if one.inherited is not None]
    horizon = min((one.horizon for one in stated if one.horizon is not None), default=math.inf)
    known = lacking is None and math.isfinite(horizon)
    return Accuracy(
        stated[0].requested,
        error,
        "closed form" if exact else "measured against pairs",
        inherited=max(inherited) if len(inherited) == len(stated) else None,
        horizon=horizon if known else None,
        why=None if known else stated[0].why if lacking is None else lacking.why,
    )


def _work(parts: Sequence[Work], samples: int) -> Work:
    return Work(samples, sum(work.evaluations for work in parts))
