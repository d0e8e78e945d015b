"""Bounds of the errors of mass properties that are rounded to doubles.

A derived number is known as the sum of two doubles, value and tail. Its value alone is wrong by the tail, and by what
the sum may be wrong by (`core.bodies.principal_inertia.Rounding`).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from core.arrays import Floats
from core.bodies.mass_properties import MassProperties
from core.bodies.principal_inertia import EPSILON, GIVEN, ROUNDED_ONCE, PrincipalInertia

WIDER = 1.0 + 8.0 * EPSILON
"""For the rounding of the bounds themselves."""

LEAST = 2.0**-1074
"""A tail is a multiple of this."""

WEYL = 4.0
"""A moment is wrong by at most the norm of the tensor's error, which is three times its largest component, and by its
own rounding (H. Weyl, Mathematische Annalen 71 (1912), 441)."""

TURN = 4.0
"""An axis turns by at most so many times the norm of the tensor's error over the difference of two moments (G. H.
Golub, C. F. Van Loan, "Matrix Computations", 4th ed. (2013), theorem 8.1.12)."""


def rounding_errors(body: MassProperties) -> dict[str, Any]:
    """Return bounds of the errors of the doubles of mass properties.

    Returns
    -------
    dict
        ``mass`` (kg), ``center_of_mass`` of shape (3,) (m), ``inertia`` and ``inertia_about_origin`` of shape (3, 3)
        (kg m^2), ``principal`` and ``principal_about_origin`` with ``moments`` of shape (3,) (kg m^2) and ``axes`` of
        shape (3, 3); None for what is not known of the body. Where moments are equal, axes are right whatever they are
        in their plane.
    """
    share = 0.0 if body.rounding == GIVEN else max(body.rounding.share, ROUNDED_ONCE.share)
    once = min(share, ROUNDED_ONCE.share)
    wrong = share * float(np.abs(body.inertia).max())
    errors: dict[str, Any] = dict.fromkeys(("mass", "center_of_mass", "inertia_about_origin", "principal_about_origin"))
    errors["inertia"] = _bounds(body.inertia_tail, wrong)
    errors["principal"] = principal_errors(body.principal, wrong)
    if body.mass is not None:
        errors["mass"] = float(_bounds(np.array(body.mass_tail), once * body.mass + body.mass_error))
    if body.center_of_mass is not None:
        tail = np.zeros(3) if body.center_of_mass_tail is None else body.center_of_mass_tail
        reach = float(np.abs(body.center_of_mass).max())
        errors["center_of_mass"] = _bounds(tail, once * reach + body.center_of_mass_error)
        if body.about_origin is not None and body.principal_about_origin is not None and body.mass is not None:
            moved, moved_tail = body.about_origin
            # Of m (d.d 1 - d d^T), with |d| up to twice its largest coordinate.
            wrong += 12.0 * body.mass * reach * body.center_of_mass_error + 3.0 * body.mass_error * reach**2
            wrong += 2.0 * max(share, ROUNDED_ONCE.share) * float(np.abs(moved).max())
            errors["inertia_about_origin"] = _bounds(moved_tail, wrong)
            errors["principal_about_origin"] = principal_errors(body.principal_about_origin, wrong)
    return errors


def _bounds(tail: Floats, wrong: float) -> Floats:
    found: Floats = np.abs(tail) * WIDER + (WIDER * wrong + LEAST if wrong else 0.0)
    return found


def principal_errors(inertia: PrincipalInertia, wrong: float) -> dict[str, Floats]:
    """Return bounds for moments and axes of a tensor of which a component may be wrong by so much."""
    if inertia.rounding.exact_zeros:
        return {"moments": _bounds(inertia.moments_tail, wrong), "axes": np.zeros((3, 3))}
    wrong = WEYL * (wrong + inertia.rounding.share * float(np.abs(inertia.moments).max()))
    low, high = np.where(inertia.apart, np.diff(inertia.moments), np.inf).tolist()
    nearest = np.array([low, min(low, high), high])
    with np.errstate(divide="ignore"):
        turned = np.minimum(1.0, TURN * wrong / nearest)
    axes = np.abs(inertia.axes_tail) * WIDER + turned
    return {"moments": _bounds(inertia.moments_tail, wrong), "axes": axes}
