"""Whether the equations of motion are balanced: at the start by the accelerations of the answer, later by rates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.multibody.audit.definitions import Description
from core.multibody.audit.failure import MARGIN, Ledger
from core.multibody.audit.newton import Acceleration, Freedoms, balance
from core.multibody.audit.placement import Numbers, Undefined
from core.multibody.audit.samples import EPSILON, Samples


@dataclass(frozen=True)
class Accelerated:
    """Samples with their accelerations: that of the start, if the answer has its accelerations, and those of windows.

    Attributes
    ----------
    samples : Samples
        With the spins of tops; their forces are those of the answer, NaN where it does not have them.
    accelerations : mapping of str to Acceleration
    unsure : ndarray, shape (freedoms, n)
        How wrong the inertial terms may be.
    starts : bool
        Whether the first sample is that of the start, for which rounding takes the place of stated errors.
    """

    samples: Samples
    accelerations: Mapping[str, Acceleration]
    unsure: Numbers
    starts: bool

    def at(self, rows: Numbers) -> Accelerated:
        """Return some of the samples by their numbers."""
        accelerations = {
            name: Acceleration(one.linear[rows], None if one.angular is None else one.angular[rows])
            for name, one in self.accelerations.items()
        }
        starts = self.starts and bool(len(rows)) and int(rows[0]) == 0
        return replace(
            self,
            samples=self.samples.at(rows),
            accelerations=accelerations,
            unsure=self.unsure[:, rows],
            starts=starts,
        )


def joined_accelerations(parts: Sequence[Acceleration]) -> Acceleration:
    """Return accelerations of one body at several moments, one after another."""
    angular = [one.angular for one in parts if one.angular is not None]
    return Acceleration(np.concatenate([one.linear for one in parts]), np.concatenate(angular) if angular else None)


def check_balance(
    ledger: Ledger, description: Description, freedoms: Freedoms, moments: Accelerated, *, law: str = "Newton and Euler"
) -> None:
    """Compare inertial terms with the forces of the answer, at all moments at once."""
    known = np.isfinite(moments.unsure)
    if not known.all():
        # Rates that are not known in a window say nothing of the forces.
        moments = moments.at(np.flatnonzero(known.all(axis=0)))
    if not len(moments.samples.times):
        return
    try:
        left, allowed = _left(ledger, description, freedoms, moments)
        ledger.checked += 1
        within = left <= allowed
        if within.all():
            return
        moments = moments.at(np.flatnonzero(~within.all(axis=0)))
        left, allowed = _left(ledger, description, freedoms, moments)
        if moments.starts:
            moments = replace(moments, samples=moments.samples.given_first(description.extent))
        allowed += _moved(description, freedoms, moments)
    except Undefined:
        return
    for k, worst in enumerate(np.argmax(left - allowed, axis=0).tolist()):
        where = " at the start" if moments.starts and k == 0 else ""
        time, body = moments.samples.times[k : k + 1], freedoms.body(worst)
        ledger.compare(law + where, body, time, left[worst, k : k + 1], allowed[worst, k : k + 1])


def _left(
    ledger: Ledger, description: Description, freedoms: Freedoms, moments: Accelerated
) -> tuple[Numbers, Numbers]:
    """Return what is left over of the equations, and what may be apart from stated errors, shapes (freedoms, n)."""
    some = moments.samples
    found = balance(description, some.placement, some.motion, moments.accelerations, some.forces, freedoms)
    allowed = found.allowed(moments.unsure, ledger.rounding)
    if moments.starts and found.undecided[0]:
        # Between two values of a force the windows decide; there what stays zero has the value at zero.
        allowed[:, 0] = np.inf
    return np.abs(found.left()), allowed


def _moved(description: Description, freedoms: Freedoms, moments: Accelerated) -> Numbers:
    """Return by how much the stated errors of places, rates and forces change the equations, shape (freedoms, n)."""
    some = moments.samples
    changed = some.perturbed(description.bodies, some.forces)
    count = next(iter(changed.placement.values())).position.shape[0]
    flat = changed.flattened()
    repeated = {
        name: Acceleration(
            np.tile(one.linear, (count, 1)),
            None if one.angular is None else np.tile(one.angular, (count, *(1,) * (one.angular.ndim - 1))),
        )
        for name, one in moments.accelerations.items()
    }
    left = balance(description, flat.placement, flat.motion, repeated, flat.forces).left()
    left = left.reshape(left.shape[0], count, -1)
    moved: Numbers = MARGIN * np.abs(left[:, 1:] - left[:, :1]).sum(axis=1)
    # What is fixed in a body may be the difference of places in space, each rounded, which no sample moves.
    arm = MARGIN * EPSILON * description.extent
    pushed = sum((np.abs(np.nan_to_num(force)) for force in some.forces.values()), np.zeros(len(some.times)))
    for name, body in description.bodies.items():
        if body.inertia is not None:
            moved[freedoms.turning(name)] += arm * pushed
    return moved
