"""Samples of a scene with fewer digits, and the errors that cover them."""

from __future__ import annotations

from dataclasses import replace

from core.multibody.answer import Column, SceneTrajectory
from core.multibody.columns import largest_of, worst
from core.notices import Notice
from core.systems.rounding import Digits, rounded


def shortened(trajectory: SceneTrajectory, digits: Digits) -> SceneTrajectory:
    """Return a trajectory with fewer digits in every column, whose stated error covers that.

    Parameters
    ----------
    digits : int or "meaningful"
        Significant digits, or the decimal places that the error of each column supports, and the inherited one where
        it is known.
    """
    columns = {name: _shortened(column, digits) for name, column in trajectory.columns.items()}
    stated = replace(trajectory.accuracy, error=worst(columns))
    warnings = trajectory.warnings
    if trajectory.accuracy.error <= stated.requested < stated.error:
        detail = f"rounding leaves an error of {stated.error:.3g}, where {stated.requested:.3g} was asked for"
        warnings = (*warnings, Notice("rounded-beyond-accuracy", detail, ("round",)))
    return replace(trajectory, columns=columns, accuracy=stated, warnings=warnings)


def _shortened(column: Column, digits: Digits) -> Column:
    scale = largest_of(column)
    if scale == 0.0:
        return column
    unknown = (column.error + (column.inherited or 0.0)) / scale
    values, added = rounded(column.values, digits, unknown, scale)
    return replace(column, values=values, error=column.error + added * scale)
