"""Places of rest that are no points: a scene that can be moved and still rests, as a bead on a level line.

Newton's method finds many places of such a line or surface, and each is one of many. Two of them belong to one
continuum if a place of rest is found between them, nearer to each of them than they are to one another; the potential
energy of a continuum is one number, which tells different ones apart.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from core.arrays import Floats
from core.multibody.algebra.polynomials import is_zero
from core.multibody.statics.exact_places import ExactPlace, RestEquations

_BETWEEN = 0.75
"""Share of the distance of two places within which a place between them is from both: along a circle it is at most
0.71 of their chord, a quarter of a turn apart."""

_FAILURES, _FAILURES_OF_EACH = 3, 6
"""Pairs of two continua without a place between them after which these are two; and of all, for each place."""


def one_of_each(places: Sequence[ExactPlace], equations: RestEquations) -> list[ExactPlace]:
    """Return places of rest in their order, of every continuum the first alone.

    Parameters
    ----------
    places : sequence of ExactPlace
    equations : RestEquations
    """
    many = [k for k, place in enumerate(places) if place.continuum]
    sizes = [float(size) for size in equations.sizes[: equations.count]]
    at = np.array([[float(x.mid()) / size for x, size in zip(places[k].q, sizes, strict=True)] for k in many])
    first = {k: k for k in many}

    def root(k: int) -> int:
        while first[k] != k:
            k = first[k]
        return k

    failed = Counter[tuple[int, int]]()
    for i, j in _pairs(at):
        one, other = sorted((root(many[i]), root(many[j])))
        if one == other or failed[one, other] == _FAILURES or failed.total() == _FAILURES_OF_EACH * len(many):
            continue
        if _differ(places[one], places[other], equations):
            continue
        if _joined(places[many[i]], places[many[j]], equations, at[i], at[j]):
            first[other] = one
        else:
            failed[one, other] += 1
    return [place for k, place in enumerate(places) if first.get(k, k) == k]


def _differ(one: ExactPlace, other: ExactPlace, equations: RestEquations) -> bool:
    """Return whether two places have different potential energies."""
    return not is_zero(equations.potential(one.q) - equations.potential(other.q))


def _pairs(at: Floats) -> list[tuple[int, int]]:
    """Return all pairs, the nearest first."""
    first, second = np.triu_indices(len(at), 1)
    distances = np.linalg.norm(at[first] - at[second], axis=1) if len(at) > 1 else np.empty(0)
    order = np.argsort(distances, kind="stable")
    return list(zip(first[order].tolist(), second[order].tolist(), strict=True))


def _joined(one: ExactPlace, other: ExactPlace, equations: RestEquations, at: Floats, beside: Floats) -> bool:
    """Return whether a place of rest is between two."""
    middle = [
        ((x + y) / 2).mid() for x, y in zip([*one.q, *one.multipliers], [*other.q, *other.multipliers], strict=True)
    ]
    found = equations.refined(middle)
    if found is None or not found.continuum or _differ(found, one, equations):
        return False
    sizes = equations.sizes[: equations.count]
    here = np.array([float((x / size).mid()) for x, size in zip(found.q, sizes, strict=True)])
    apart = float(np.linalg.norm(at - beside))
    return max(float(np.linalg.norm(here - at)), float(np.linalg.norm(here - beside))) <= _BETWEEN * apart
