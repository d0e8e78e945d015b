"""Whether the equations of motion are balanced: at the start by the accelerations of the answer, later by rates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.multibody.audit.definitions import Description
from core.multibody.audit.failure import MARGIN, Ledger
from core.multibody.audit.newton import Acceleration, Forces, Freedoms, balance
from core.multibody.audit.placement import Motion, Numbers, Undefined
from core.multibody.audit.samples import Samples


@dataclass(frozen=True)
class Moment:
    """Samples with their accelerations.

    Attributes
    ----------
    law : str
    rows : slice
        Which of the samples of the audit.
    accelerations : mapping of str to Acceleration
    forces, force_errors : mapping of str to ndarray, shape (n,)
    unsure : ndarray, shape (freedoms, n)
        How wrong the inertial terms may be.
    stated : bool
        Whether the stated errors of places and rates enter, beside rounding.
    """

    law: str
    rows: slice
    accelerations: Mapping[str, Acceleration]
    forces: Forces
    force_errors: Forces
    unsure: Numbers
    stated: bool


def check_balance(
    ledger: Ledger,
    description: Description,
    freedoms: Freedoms,
    samples: Samples,
    motion: Motion,
    moments: Sequence[Moment],
) -> None:
    """Compare inertial terms with the forces of the answer, at all moments at once.

    Parameters
    ----------
    samples : Samples
        Those of the audit.
    motion : mapping of str to Twist
        That of the samples, with the spins of tops.
    """
    # Rates that are not known in a window say nothing of the forces.
    moments = [moment for moment in moments if np.isfinite(moment.unsure).all()]
    if not moments:
        return
    rows = np.concatenate([np.arange(len(samples.times))[moment.rows] for moment in moments])
    counts = [moment.unsure.shape[1] for moment in moments]
    some = Samples(
        samples.times, samples.placement, motion, {}, samples.errors, {}, samples.placed
    ).at(rows)  # fmt: skip
    accelerations = {name: _joined([moment.accelerations[name] for moment in moments]) for name in description.bodies}
    forces = _spread([moment.forces for moment in moments], counts, np.nan)
    known = _spread([moment.force_errors for moment in moments], counts, 0.0)
    try:
        found = balance(description, some.placement, some.motion, accelerations, forces, known, freedoms)
    except Undefined:
        return
    left = np.abs(found.left())
    allowed = found.allowed(np.concatenate([moment.unsure for moment in moments], axis=1), ledger.rounding)
    ledger.checked += 1
    beyond = np.flatnonzero(~(left <= allowed).all(axis=0))
    if not len(beyond):
        return
    left, allowed = left[:, beyond], allowed[:, beyond]
    stated = np.repeat([moment.stated for moment in moments], counts)[beyond]
    there = {name: _rows(one, beyond) for name, one in accelerations.items()}
    allowed = allowed + stated * _moved(
        description, some.at(beyond), there, {name: values[beyond] for name, values in forces.items()}
    )
    laws = np.repeat([moment.law for moment in moments], counts)[beyond]
    for k, worst in enumerate(np.argmax(left - allowed, axis=0).tolist()):
        name = max(
            (one for one in freedoms.where if freedoms.where[one][0] <= worst), key=lambda one: freedoms.where[one]
        )
        time = some.times[beyond[k : k + 1]]
        ledger.compare(str(laws[k]), name, time, left[worst, k : k + 1], allowed[worst, k : k + 1])


def _joined(parts: Sequence[Acceleration]) -> Acceleration:
    angular = [one.angular for one in parts if one.angular is not None]
    return Acceleration(np.concatenate([one.linear for one in parts]), np.concatenate(angular) if angular else None)


def _rows(one: Acceleration, rows: Numbers) -> Acceleration:
    return Acceleration(one.linear[rows], None if one.angular is None else one.angular[rows])


def _spread(parts: Sequence[Forces], counts: Sequence[int], missing: float) -> dict[str, Numbers]:
    """Return forces at all moments, with a number where one of them lacks a force."""
    names = dict.fromkeys(name for part in parts for name in part)
    lacking = [np.full(count, missing) for count in counts]
    return {
        name: np.concatenate([part.get(name, none) for part, none in zip(parts, lacking, strict=True)])
        for name in names
    }  # fmt: skip


def _moved(
    description: Description, samples: Samples, accelerations: Mapping[str, Acceleration], forces: Forces
) -> Numbers:
    """Return by how much the stated errors of places and rates change the equations, shape (freedoms, n)."""
    changed = samples.perturbed(description.bodies)
    count = next(iter(changed.placement.values())).position.shape[0]
    flat = changed.flattened()
    repeated = {
        name: Acceleration(
            np.tile(one.linear, (count, 1)),
            None if one.angular is None else np.tile(one.angular, (count, *(1,) * (one.angular.ndim - 1))),
        )
        for name, one in accelerations.items()
    }
    every = {name: np.tile(values, count) for name, values in forces.items()}
    left = balance(description, flat.placement, flat.motion, repeated, every).left()
    left = left.reshape(left.shape[0], count, -1)
    moved: Numbers = MARGIN * np.abs(left[:, 1:] - left[:, :1]).sum(axis=1)
    return moved
