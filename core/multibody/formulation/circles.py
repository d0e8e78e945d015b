"""Circles and spheres among the measures of a table: their centres and radii as affine polynomials."""

from __future__ import annotations

from core.multibody.algebra.polynomials import ONE, Poly, combined, degree, entry, is_zero


def neighbours(among: list[int]) -> list[list[int]]:
    """Return three or two neighbours of some coordinates, all three of a vector first."""
    threes = [among[k : k + 3] for k in range(len(among) - 2)] if len(among) == 3 else []
    return threes + [[a, b] for k, a in enumerate(among) for b in among[k + 1 :]]


def circle_of(measure: Poly, chosen: list[int]) -> tuple[list[Poly], Poly] | None:
    """Return the arms and the radius of a measure that is a circle or sphere in some coordinates, None of another."""
    lead = measure[chosen[0], chosen[0]]
    arms, rest = [], dict(measure)
    for i in chosen:
        arm: Poly = {(i,): ONE}
        for key, value in measure.items():
            if i in key and key != (i, i):
                other = tuple(k for k in key if k != i)
                if set(other) & set(chosen):
                    return None
                arm[other] = value / (2 * lead)
        arms.append(arm)
        rest = combined((ONE, rest), (-lead, _square(arm)))
    return None if (radius := _root(combined((-1 / lead, rest)))) is None else (arms, radius)


def _square(form: Poly) -> Poly:
    found: Poly = {}
    for a, x in form.items():
        for b, y in form.items():
            key = tuple(sorted(a + b))
            found[key] = entry(found, key) + x * y
    return {key: value for key, value in found.items() if not is_zero(value)}


def _root(poly: Poly) -> Poly | None:
    """Return the affine polynomial of which a quadratic is the square, None without one."""
    square = next((key for key in poly if len(key) == 2 and key[0] == key[1]), None)
    if square is None:
        if degree(poly) > 0 or not entry(poly, ()) > 0:
            return None
        return {(): poly[()].sqrt()}
    if not poly[square] > 0:
        return None
    lead, i = poly[square].sqrt(), square[0]
    root: Poly = {(i,): lead}
    for key, value in poly.items():
        if i in key and key != square:
            root[tuple(k for k in key if k != i)] = value / (2 * lead)
    return root if not combined((ONE, poly), (-ONE, _square(root))) else None
