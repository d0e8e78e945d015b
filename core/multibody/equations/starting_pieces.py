"""On which pieces of its formulas a motion begins."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from core.errors import InvalidParameter
from core.formulas import names_of
from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.equations.expansion import Expansion, Series, expansion, leading_sign
from core.multibody.laws.law import Law
from core.multibody.laws.series import LawSeries, values_at
from core.multibody.table.law_pieces import Argument, Key, in_pieces, key_of
from core.multibody.table.table import Table

ORDER = 6
"""Highest power of time by which a sign is decided: a force that grows with its cube moves a place by the fifth."""
MOST_OPEN = 4
"""Arguments of which the signs may have to be tried: sixteen combinations."""

Moving = Callable[[Table], Table | None]
"""From a table of one piece to that by which its coordinates move, which contacts may decide; None if they do not."""


class NoPiece(InvalidParameter):
    """Neither side of the zero of an argument is left by the motion on that side, or both are.

    Attributes
    ----------
    law : Law
        The argument.
    without_value : bool
        Whether it has no value.
    """

    def __init__(self, law: Law, rule: str, *, without_value: bool = False) -> None:
        remedy = "describe friction that holds what is at rest by a contact, or start beside the zero"
        super().__init__(law.path, rule, remedy=None if without_value else remedy)
        self.law, self.without_value = law, without_value


@dataclass(frozen=True)
class InPieces:
    """A table with formulas of one piece.

    Attributes
    ----------
    table : Table
    arguments : mapping of Key to Argument
    tried : mapping of Key to int
        Signs that are supposed: their arguments are zero, as far as places and rates tell.
    """

    table: Table
    arguments: Mapping[Key, Argument]
    tried: Mapping[Key, int]


def table_in_pieces(table: Table, q: Sequence[Ball], v: Sequence[Ball], moving: Moving) -> InPieces | None:
    """Return a table with its formulas on the pieces that follow a state; None if what moves decides none.

    Where an argument is zero, its first derivative that does not vanish tells the piece. Where that depends on the
    piece, the motion begins on the piece whose own motion leads there.

    Raises
    ------
    NoPiece
        Where no piece does, or more than one: neither side of the zero is left, or the formula does not say which; and
        for an argument, or a piece, without a value.
    """
    kept: list[tuple[Mapping[Key, int], Expansion]] = []
    undecided, last = False, None
    for one in _candidates(table, q, v):
        if not one.tried:
            return _with_values(one, q, v)
        last, own = one, moving(one.table)
        if own is None:
            undecided = True
            continue
        motion = expansion(own, ORDER)
        signs = {key: _sign_along(one.arguments[key].law, motion) for key in one.tried}
        if not all(sign in (0, one.tried[key]) for key, sign in signs.items()):
            continue
        # What pieces of an argument depend on are arguments as well, others on every piece.
        if not any(signs == others or _are_alike(motion, other) for others, other in kept):
            kept.append((signs, motion))
    assert last is not None, "there is a candidate at least"
    if len(kept) != 1:
        if undecided and not kept:
            return None
        argument = last.arguments[next(iter(last.tried))].law
        raise NoPiece(argument, "lead away from the zero of what its pieces depend on, on one side alone")
    leads, along = kept[0]
    return _with_values(InPieces(*in_pieces(table, _signs(q, v, leads, along)), leads), q, v)


def _with_values(found: InPieces, q: Sequence[Ball], v: Sequence[Ball]) -> InPieces:
    """Return a table whose formulas have values at a state; it raises `NoPiece` for another, as beyond the last point.

    Elsewhere a formula that has none is one that the motion approaches; a change of piece may lead into it at once.
    """
    for law in found.table.acting:
        try:
            values_at([law], q, v)
        except InvalidParameter as fault:
            raise NoPiece(law, fault.rule, without_value=True) from None
    return found


def _sign_along(law: Law, motion: Expansion) -> int:
    """Return the sign just after the start of an argument that is zero there."""
    return leading_sign(series_of(law, motion, ORDER)[1:])


def _are_alike(first: Expansion, second: Expansion) -> bool:
    """Return whether two motions are one, as far as they are looked at."""
    return all(
        is_zero(x - y) for both in zip(first.places, second.places, strict=True) for x, y in zip(*both, strict=True)
    )


def _candidates(table: Table, q: Sequence[Ball], v: Sequence[Ball]) -> Iterator[InPieces]:
    """Yield tables of one piece, one for each combination of signs that a state leaves open."""
    waiting: list[dict[Key, int]] = [{}]
    while waiting:
        tried = waiting.pop()
        try:
            yield InPieces(*in_pieces(table, _signs(q, v, tried)), tried)
        except _Open as at:
            if len(tried) == MOST_OPEN:
                raise NoPiece(at.law, f"have at most {MOST_OPEN} zeros of what pieces depend on") from None
            waiting += [{**tried, key_of(at.law): sign} for sign in (-1, 1)]


class _Open(Exception):
    """A state does not tell the sign of an argument."""

    def __init__(self, law: Law) -> None:
        super().__init__(law)
        self.law = law


def _signs(
    q: Sequence[Ball], v: Sequence[Ball], tried: Mapping[Key, int], motion: Expansion | None = None
) -> Callable[[Law], int]:
    """Return the signs of arguments just after a state, as far as places and rates tell, or as they are supposed.

    Others follow from the motion, once it is known: where an argument stays zero, more may show that do.
    """

    def sign(law: Law) -> int:
        rated = any(one.rate for name, one in law.inputs.items() if name in names_of(law.root))
        state = Expansion([[x, y] for x, y in zip(q, v, strict=True)], [])
        series = series_of(law, state, 1 if rated else 2)
        if not series[0].is_finite():
            rule = "have a value: it divides by zero, or leaves the domain of a function"
            raise NoPiece(law, rule, without_value=True)
        found = leading_sign(series)
        if found or not law.inputs:
            return found
        if key_of(law) in tried:
            return tried[key_of(law)]
        if motion is None:
            raise _Open(law)
        return _sign_along(law, motion)

    return sign


def series_of(law: Law, motion: Expansion, count: int) -> Series:
    """Return the first coefficients of a formula along a motion, of which those of its rates are one less."""
    part = LawSeries([replace(law, push={})])
    rates = [[*((k + 1) * x for k, x in enumerate(place[1:])), ZERO] for place in motion.places]
    for k in range(count):
        part.add_to([ZERO] * len(motion.places), motion.places, rates, k)
    return part.values[part.tape.outputs[0]]
