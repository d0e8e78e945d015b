"""Whether friction goes on not to depend on how a load is shared, once what slides turns its slip.

Four feet of a table that slides without a turn rub along one direction, and how they share the load moves nothing. As
soon as the table turns, each rubs along a direction of its own, and the shares count: nothing in the mechanics of rigid
bodies tells them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.contacts.conditions_of_states import LOOKED
from core.multibody.equations.expansion import Expansion, Series, expansion, product
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.table import Table

Share = Mapping[int, Ball]
"""Normal forces, by contacts, that may be added in any multiple with all that is held as it is."""


def share_that_counts(
    table: Table, unilateral: Sequence[Unilateral], shares: Sequence[Share], turning: Sequence[str]
) -> tuple[str, ...]:
    """Return the contacts of a share that moves something just after a state, though not there; none if none does.

    Parameters
    ----------
    table : Table
        Of the phase that begins.
    shares : sequence of Share
        That move nothing at the state.
    turning : sequence of str
        The contacts whose slip turns: where none of a share does, its friction stays what it is.
    """
    affected = [share for share in shares if any(unilateral[i].name in turning for i in share)]
    if not affected:
        return ()
    motion = expansion(table, LOOKED)
    for share in affected:
        if _is_kept(motion, unilateral, share) and not _vanishes(_friction(motion, unilateral, share)):
            return tuple(unilateral[i].name for i in share)
    return ()


def _is_kept(motion: Expansion, unilateral: Sequence[Unilateral], share: Share) -> bool:
    """Return whether the normal forces of a share go on to hold one another in balance."""
    total: dict[int, Series] = {}
    for i, force in share.items():
        for j, poly in unilateral[i].normal.items():
            _add(total, j, [force * x for x in motion.of(poly)])
    return _vanishes(total)


def _friction(motion: Expansion, unilateral: Sequence[Unilateral], share: Share) -> dict[int, Series]:
    """Return the friction that goes with a share along every coordinate."""
    total: dict[int, Series] = {}
    for i, force in share.items():
        one = unilateral[i]
        if one.slip is None or one.across is None:
            continue
        slips = [motion.of_rates(line) for line in (one.slip, one.across)]
        units = _direction(*slips)
        for line, unit in zip((one.slip, one.across), units, strict=True):
            for j, poly in line.items():
                along = motion.of(poly)[: len(unit)]
                _add(total, j, [-force * one.kinetic * x for x in product(unit, along)])
    return total


def _direction(along: Series, across: Series) -> tuple[Series, Series]:
    """Return the direction of a slip, from which its lowest power of time is divided out."""
    first = next((k for k, pair in enumerate(zip(along, across, strict=True)) if not all(map(is_zero, pair))), None)
    if first is None:
        return [], []
    x, y = along[first:], across[first:]
    square = [a + b for a, b in zip(product(x, x), product(y, y), strict=True)]
    size: Series = []
    for k, s in enumerate(square):
        # |s|^2 power by power.
        inner = sum((size[a] * size[k - a] for a in range(1, k)), ZERO)
        size.append(s.sqrt() if k == 0 else (s - inner) / (2 * size[0]))
    units: tuple[Series, Series] = ([], [])
    for unit, slip in zip(units, (x, y), strict=True):
        for k, s in enumerate(slip):
            unit.append((s - sum((unit[a] * size[k - a] for a in range(k)), ZERO)) / size[0])
    return units


def _add(total: dict[int, Series], j: int, series: Series) -> None:
    known = total.get(j)
    # What is known of several directions is known up to the lowest of their powers.
    total[j] = series if known is None else [a + b for a, b in zip(known, series, strict=False)]


def _vanishes(total: Mapping[int, Series]) -> bool:
    return all(is_zero(x) for series in total.values() for x in series)
