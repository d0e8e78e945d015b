"""How contacts that bounce as one share their impulses.

More contacts than are independent, as the corners of a box that falls flat, have many shares with one effect. Where
the effects of impulses are dependent, every combination of them that is zero may be added: the smallest shares are
taken, those of a box that falls level being equal. (A. Ben-Israel, T. N. E. Greville, "Generalized Inverses", section
3.2: the solution of least norm has no part along the null space.)
"""

from __future__ import annotations

from collections.abc import Sequence

from flint import arb_mat

from core.multibody.algebra.polynomials import ONE, ZERO, Ball, is_zero
from core.multibody.algebra.rank import independent
from core.multibody.contacts.contact_responses import Forces, Responses


def shared_impulses(found: Responses, openings: Sequence[Ball], ratios: Sequence[Ball | None]) -> Forces | None:
    """Return impulses by their lines that raise the rate of the first gap by one, and those of all in proportion.

    None where there are none, or where one of them would pull.

    Parameters
    ----------
    openings : sequence of ball
        Rates at which the gaps open.
    ratios : sequence of (ball or None)
        Of friction to push, None where that is not always the same.
    """
    pushes: list[Forces] = []
    for n, ratio in enumerate(ratios):
        if ratio is None:
            return None
        pushes.append({found.normal[n]: ONE} if ratio == 0 else {found.normal[n]: ONE, found.slips[n]: ratio})
    matrix = found.among(pushes, [found.normal[n] for n in range(len(pushes))])
    solved = _least(matrix, _effects(found, pushes), [x / openings[0] for x in openings])
    if solved is None or not all(x > 0 for x in solved):
        return None
    return {line: p * x for p, push in zip(solved, pushes, strict=True) for line, x in push.items()}


def _effects(found: Responses, pushes: Sequence[Forces]) -> list[dict[int, Ball]]:
    """Return what every push adds to the rates of all coordinates."""
    effects = []
    for push in pushes:
        columns = [[x * y for y in found.columns[line]] for line, x in push.items()]
        effects.append(dict(enumerate(sum(parts, ZERO) for parts in zip(*columns, strict=True))))
    return effects


def _least(
    matrix: Sequence[Sequence[Ball]], effects: Sequence[dict[int, Ball]], wanted: Sequence[Ball]
) -> list[Ball] | None:
    """Return the smallest impulses with the rates of gaps that are wanted, None where there are none."""
    kept = independent(effects)
    others = [n for n in range(len(wanted)) if n not in kept]
    try:
        inverse = arb_mat([[matrix[a][b] for b in kept] for a in kept]).inv()
    except ZeroDivisionError:
        return None
    solved = (inverse * arb_mat([[wanted[a]] for a in kept])).entries()
    for a in others:
        if not is_zero(sum((matrix[a][b] * x for b, x in zip(kept, solved, strict=True)), ZERO) - wanted[a]):
            return None
    found = [ZERO] * len(wanted)
    for b, x in zip(kept, solved, strict=True):
        found[b] = x
    if not others:
        return found
    same = inverse * arb_mat([[matrix[a][b] for b in others] for a in kept])
    null = arb_mat(len(wanted), len(others))
    for k, n in enumerate(others):
        null[n, k] = ONE
        for r, b in enumerate(kept):
            null[b, k] = -same[r, k]
    start = arb_mat([[x] for x in found])
    along = (null.transpose() * null).solve(null.transpose() * start)
    return (start - null * along).entries()
