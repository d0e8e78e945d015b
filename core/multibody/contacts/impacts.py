"""Impacts: laws of restitution, with impulses of friction.

Where more than one contact takes an impulse, rigid bodies do not say whether they do so together or one after another:
all orders are tried, and if they disagree the outcome is undecided unless the client orders them.

References
----------
T. R. Kane, "A dynamics puzzle" (1984): with friction, Newton's law may add energy; such an outcome is refused.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import permutations

from flint import arb, arb_mat

from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.algebra.rank import Elimination, independent
from core.multibody.contacts.contact_responses import (
    Forces,
    Responses,
    across_rate,
    gap_rate,
    require_few,
    responses,
    slip_rate,
)
from core.multibody.contacts.contact_states import Problem, phase_table
from core.multibody.contacts.frictionless import is_smooth
from core.multibody.contacts.impulses import LIMIT, RatesByLine, alike, likest, rates_after
from core.multibody.contacts.laws_of_impact import impulses_together
from core.multibody.contacts.slip_directions import along_slip
from core.multibody.equations.dynamics import kinetic
from core.multibody.language.contacts import Simultaneous
from core.multibody.table.connection_effects import Unilateral
from core.multibody.table.measures import COMPONENTS
from core.multibody.table.table import Table

_MOST_IN_TURN = 400
"""Impacts one after another before an order is given up."""
_MOST_ORDERED = 4
"""Contacts of which every order is tried."""
_MOST_ON_THE_WAY = 1000
"""Different rates between impacts in turn of more contacts, whichever is next: six balls in a row come to 720."""
_TOLD_APART = 2.0**-30
"""Share of the largest rate in which rates on the way are counted: those beside a step may be followed twice."""


@dataclass(frozen=True)
class Impact:
    """What happens at an impact.

    Attributes
    ----------
    v : list of ball
        RatesByLine afterwards.
    impulses : mapping of int to (ball, ball, ball)
        Of every measure that takes one: along its gap, and along its slip, of which there are two in space.
    works : mapping of int to ball
        Of these impulses (J): they add up to the change of kinetic energy.
    unilateral : sequence of Unilateral
        The measures, those that slip in space turned into the direction in which they did.
    changes : mapping of int to list of ball
        What the impulses of each measure change of all rates.
    together : bool
        Whether several take impulses at once.
    shared : set of int
        Measures of which other impulses have the same outcome: places side by side on one body.
    in_turn : bool
        Whether contacts have acted one after another, so that impulses are known without their width.
    """

    v: list[Ball]
    impulses: dict[int, tuple[Ball, Ball, Ball]]
    works: dict[int, Ball]
    unilateral: Sequence[Unilateral]
    changes: dict[int, list[Ball]]
    together: bool = False
    shared: set[int] = field(default_factory=set)
    in_turn: bool = False

    def widened(self, others: Sequence[Impact]) -> Impact:
        """Return it with the impulses and works of impacts in turn as wide as their difference from those of others.

        The others are the same impact, of states between which that is known of which this is the middle.
        """
        if not self.in_turn:
            return self
        nothing = (ZERO, ZERO, ZERO)
        every = {i for one in (self, *others) for i in one.impulses}
        impulses, works = dict(self.impulses), dict(self.works)
        for i in every:
            for other in others:
                own, beside = impulses.get(i, nothing), other.along_directions_of(self, i)
                impulses[i] = (own[0].union(beside[0]), own[1].union(beside[1]), own[2].union(beside[2]))
                work: Ball = works.get(i, ZERO)
                works[i] = work.union(other.works.get(i, ZERO))
        return replace(self, impulses=impulses, works=works)

    def along_directions_of(self, other: Impact, i: int) -> tuple[Ball, Ball, Ball]:
        """Return the impulse of a measure along the directions of slip of another impact, in space other ones."""
        push, *rubs = self.impulses.get(i, (ZERO, ZERO, ZERO))
        own, others = self.unilateral[i].tangents, other.unilateral[i].tangents
        if own is None or others is None:
            return push, rubs[0], rubs[1]
        vector = [rubs[0] * x + rubs[1] * y for x, y in zip(*own, strict=True)]
        first, second = (sum((x * y for x, y in zip(vector, e, strict=True)), ZERO) for e in others)
        return push, first, second

    def components(self, i: int) -> dict[str, Ball]:
        """Return the impulse of a measure by its names: along the gap, and of friction in the plane or along axes."""
        return _by_names(self.unilateral[i], *self.impulses[i])

    def rates(self, i: int, q: Sequence[Ball], v: Sequence[Ball]) -> dict[str, Ball]:
        """Return the rates of gap and slip of a measure in a state, by the names of its impulses."""
        one = self.unilateral[i]
        return _by_names(one, gap_rate(one, q, v), slip_rate(one, q, v), across_rate(one, q, v))


def _by_names(one: Unilateral, normal: Ball, slip: Ball, across: Ball) -> dict[str, Ball]:
    """Return what is along gap and slip by the names of the impulses; in space, slips are along axes."""
    found = {"normal": normal}
    if one.tangents is not None:
        for axis, x, y in zip(COMPONENTS, *one.tangents, strict=True):
            found[f"friction.{axis}"] = slip * x + across * y
    elif one.slip is not None:
        found["friction"] = slip
    return found


@dataclass(frozen=True)
class _Outcome:
    """Impulses by line, the work of each measure that gives them, and whether they act one after another."""

    impulses: Forces
    works: dict[int, Ball]
    in_turn: bool = False


def _outcome(group: Sequence[int], impulses: Forces, rates: RatesByLine, found: Responses) -> _Outcome:
    """Return impulses at once with their works: each times the mean of its rates before and after.

    References
    ----------
    W. Thomson, P. G. Tait, "Treatise on Natural Philosophy" (1867), section 309.
    """
    after, works = rates_after(impulses, rates, found), {}
    for i in group:
        lines = [found.normal[i], *found.grip(i)]
        work = sum((impulses[a] * (rates[a] + after[a]) / 2 for a in lines if a in impulses), ZERO)
        works[i] = ZERO if is_zero(work) else work
    return _Outcome(impulses, works)


def approaching(unilateral: Sequence[Unilateral], touching: Sequence[int], q: list[Ball], v: list[Ball]) -> list[int]:
    """Return the touching measures whose gaps would become negative."""
    rates = {i: gap_rate(unilateral[i], q, v) for i in touching}
    return [i for i, x in rates.items() if not is_zero(x) and x < 0]


def impact(
    base: Table,
    measures: Sequence[Unilateral],
    touching: Sequence[int],
    q: list[Ball],
    v: list[Ball],
    *,
    settled: Impact | None = None,
    simultaneous: Simultaneous = "undecided",
) -> Impact | Problem:
    """Return the outcome of an impact of the touching measures, or why it is undecided.

    If it is `settled` which outcome is the only possible one, as far as the state is known, its like is returned.
    Contacts that take impulses at one time act as `simultaneous` says.

    Raises
    ------
    BudgetExceeded
        For more than eight touching contacts that push one another by friction, unless they act in order; and for more
        than four that come to too many different rates in different orders.
    """
    # Forces do nothing in no time: formulas of them need not have a piece yet.
    table = replace(phase_table(base, (), (), q, v).table, laws=[])
    unilateral = along_slip(measures, touching, q, v)
    found = responses(table, unilateral, touching)
    normal, slips, across = found.normal, found.slips, found.across
    before, after, lines = kinetic(table), list(v), range(len(found.columns))
    impulses: dict[int, tuple[Ball, Ball, Ball]] = {}
    works: dict[int, Ball] = {}
    changes: dict[int, list[Ball]] = {}
    together, in_turn, shared, driven = False, False, set[int](), ZERO
    for group in found.clusters():
        # What has stayed closed until now may be off by rounding on a track: it does not strike.
        if not (approaching(unilateral, group, q, v) if settled is None else settled.changes.keys() & set(group)):
            continue
        # One after another any number may act.
        if simultaneous != "in order" and not is_smooth(unilateral, group):
            require_few(unilateral, group, "contacts in one impact")
        outcome = _group(unilateral, group, q, v, found, simultaneous, settled=settled)
        if isinstance(outcome, Problem):
            return outcome
        works.update(outcome.works)
        in_turn = in_turn or outcome.in_turn
        driven = driven + _driven(table, found, outcome.impulses)
        for i in group:
            own = (normal[i], *found.grip(i))
            changes[i] = found.accelerations(
                [outcome.impulses.get(b, ZERO) if b in own else ZERO for b in lines], from_rest=True
            )
            after = [a + x for a, x in zip(after, changes[i], strict=True)]
        taking = [i for i in group if outcome.impulses.get(normal[i], ZERO) != 0]
        together = together or len(taking) > 1
        if _shares(unilateral, group, q, v, after, found):
            shared.update(taking)
        rubs = [[outcome.impulses.get(lines.get(i, -1), ZERO) for lines in (slips, across)] for i in taking]
        impulses.update({i: (outcome.impulses[normal[i]], rub[0], rub[1]) for i, rub in zip(taking, rubs, strict=True)})
    gain = kinetic(replace(table, v=after)) - before - driven
    if not is_zero(gain) and gain > 0 and settled is None:
        return Problem(
            "energy-gain",
            f"{_laws(unilateral, impulses)} law of restitution with friction would add {float(gain):.6g} J",
            tuple(unilateral[i].name for i in impulses),
            decided_by='"impacts": "stronge", or a smaller coefficient of restitution',
        )
    return Impact(after, impulses, works, unilateral, changes, together, shared, in_turn)


def _driven(table: Table, found: Responses, impulses: Forces) -> Ball:
    """Return the work that drives do while impulses act: of every row its impulse times the rate that it holds."""
    return sum((p * x * table.rows[r].rate for b, p in impulses.items() for r, x in found.reactions[b].items()), ZERO)


def _laws(unilateral: Sequence[Unilateral], taking: Iterable[int]) -> str:
    """Return whose laws some measures follow, in words."""
    return " and ".join(dict.fromkeys(f"{unilateral[i].law.capitalize()}'s" for i in taking))


def _shares(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    q: list[Ball],
    v: list[Ball],
    after: list[Ball],
    found: Responses,
) -> bool:
    """Return whether contacts could share an impulse otherwise: those that leave it as they do where they take one."""
    lines = []
    for i in group:
        one = unilateral[i]
        before = gap_rate(one, q, v)
        if one.law != "newton" or is_zero(gap_rate(one, q, after) + (one.restitution * before if before < 0 else ZERO)):
            lines.append(found.normal[i])
            if one.slips and is_zero(slip_rate(one, q, after) + one.tangential * slip_rate(one, q, v)):
                lines.extend(found.grip(i))
    if len(lines) < 2:
        return False
    return bool(arb_mat([[found.matrix[a][b] for b in lines] for a in lines]).det().contains(0))


def _group(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    q: list[Ball],
    v: list[Ball],
    found: Responses,
    simultaneous: Simultaneous,
    *,
    settled: Impact | None,
) -> _Outcome | Problem:
    """Return the impulses of contacts that push one another, or why they are undecided."""
    normal = found.normal
    rates = {a: ZERO if is_zero(x) else x for a, x in _rates(unilateral, group, q, v, found).items()}
    names = tuple(unilateral[i].name for i in group)
    given = [i for i in group if unilateral[i].order is not None]
    if len(given) == len(group) > 1:
        return _in_turn(unilateral, _by_order(unilateral, given), rates, found)
    if simultaneous == "in order" and len(group) > 1:
        others = [[i] for i in sorted(group, key=lambda i: unilateral[i].listed) if unilateral[i].order is None]
        return _in_turn(unilateral, [*_by_order(unilateral, given), *others], rates, found)
    if settled is not None and all(unilateral[i].law == "newton" for i in group):
        known = [settled.changes[i] for i in group if i in settled.changes]
        change = [sum(parts, ZERO) for parts in zip(*known, strict=True)] or [ZERO] * len(v)
        return _outcome(group, likest(unilateral, group, rates, change, found), rates, found)
    impulses = impulses_together(unilateral, group, rates, found)
    if isinstance(impulses, Problem):
        return impulses
    at_once = _outcome(group, impulses, rates, found)
    taking = [i for i in group if impulses.get(normal[i], ZERO) != 0]
    # A taut string, and a guide without play, passes on at once what pulls or presses it.
    passing = [i for i in group if unilateral[i].closes == "taut" or unilateral[i].opposite is not None]
    apart = [i for i in taking if rates[normal[i]] != 0 or i not in passing]
    if simultaneous == "together" or settled is not None:
        return at_once
    if len(apart) <= 1 and sum(rates[normal[i]] < 0 for i in group) <= 1:
        return at_once
    outcomes: list[tuple[str, Forces]] = [("together", impulses)]
    for order in permutations(group) if len(group) <= _MOST_ORDERED else _rotations(group):
        in_turn = _in_turn(unilateral, [[i] for i in order], rates, found)
        if isinstance(in_turn, _Outcome):
            outcomes.append((" then ".join(unilateral[i].name for i in order), in_turn.impulses))
    different: list[tuple[str, RatesByLine]] = []
    for described, one in outcomes:
        then = rates_after(one, rates, found)
        if not any(alike(then, other, rates) for _, other in different):
            different.append((described, then))
    if len(different) == 1 and (
        len(group) <= _MOST_ORDERED
        or _only_close(unilateral, group, rates, found)
        or _ends_alike(unilateral, group, *_without_width(rates, found))
    ):
        return at_once
    return Problem(
        "simultaneous-impacts",
        "several contacts take impulses at once, and rigid bodies do not say in which order",
        names,
        tuple(
            {"order": described}
            | {unilateral[i].name: _gap_afterwards(unilateral[i], normal[i], then, rates) for i in group}
            for described, then in different
        ),
        'the order in which they happen, as "order" of the contacts, equal where they act together',
    )


def _only_close(unilateral: Sequence[Unilateral], group: Sequence[int], rates: RatesByLine, found: Responses) -> bool:
    """Return whether every order of impacts ends with all contacts closed: nothing bounces, opens, or is opened.

    Where an impulse on one gap closes all others, or leaves them, rates that are not positive remain so until none is
    left. Impulses that leave no rate along any gap have one outcome: the part of the motion that is free.
    """
    normals, rubs = [found.normal[i] for i in group], [b for i in group for b in found.grip(i)]
    if not all(is_zero(unilateral[i].restitution) for i in group) or not all(is_zero(rates[b]) for b in rubs):
        return False
    beside = [found.matrix[a][b] for a in normals for b in normals if a != b]
    across = [found.matrix[a][b] for a in normals for b in rubs]
    return all(not x > 0 for x in [*beside, *(rates[a] for a in normals)]) and all(map(is_zero, across))


def _ends_alike(unilateral: Sequence[Unilateral], group: Sequence[int], rates: RatesByLine, found: Responses) -> bool:
    """Return whether impacts in turn end with the same rates, whichever of the contacts that approach is next.

    Raises
    ------
    BudgetExceeded
        For more rates on the way than `_MOST_ON_THE_WAY`.
    """
    least, unit = _least_rate(rates), _TOLD_APART * max(float(abs(x)) for x in rates.values())
    seen, left, ends = set[tuple[int, ...]](), [rates], list[RatesByLine]()
    while left:
        now = left.pop()
        hits = [i for i in group if now[found.normal[i]] < -least]
        if not hits:
            if ends and not alike(now, ends[0], rates):
                return False
            ends.append(now)
        for i in hits:
            impulses = impulses_together(unilateral, [i], now, found)
            if isinstance(impulses, Problem):
                continue
            then = {a: ZERO if is_zero(x) else x for a, x in rates_after(impulses, now, found).items()}
            steps = tuple(round(float(x) / unit) for x in then.values())
            if steps in seen:
                continue
            seen.add(steps)
            left.append(then)
            if len(seen) > _MOST_ON_THE_WAY:
                raise BudgetExceeded(
                    f"rates between the impacts of {', '.join(unilateral[i].name for i in group)}, in every order",
                    len(seen),
                    _MOST_ON_THE_WAY,
                    path=("connections",),
                    remedy='take "simultaneous": "together" or "in order", or give the contacts an "order"',
                )
    return True


def _least_rate(rates: RatesByLine) -> float:
    """Return the rate below which impacts that only come ever nearer to an end have come to it."""
    return LIMIT * max((float(abs(x)) for x in rates.values()), default=0.0) * 2.0**-24


def _by_order(unilateral: Sequence[Unilateral], group: Iterable[int]) -> list[list[int]]:
    """Return contacts in their order, those of equal order together."""
    orders = {i: unilateral[i].order or ZERO for i in group}
    found: list[list[int]] = []
    for i in sorted(orders, key=lambda i: float(orders[i])):
        if found and is_zero(orders[found[-1][0]] - orders[i]):
            found[-1].append(i)
        else:
            found.append([i])
    return found


def _rotations(group: Sequence[int]) -> Iterator[Sequence[int]]:
    """Yield the orders that begin with each contact and go on in one sense or the other."""
    for way in (list(group), list(group)[::-1]):
        for k in range(len(way)):
            yield [*way[k:], *way[:k]]


def _without_width(rates: RatesByLine, found: Responses) -> tuple[RatesByLine, Responses]:
    """Return the middle of what is known of rates and responses.

    Impacts in turn may come to their outcome as a limit only, while the width of balls grows with every one of them: it
    would hide what is left before the limit is reached.
    """
    matrix = [[ZERO if is_zero(x) else arb(x.mid()) for x in line] for line in found.matrix]
    return {a: arb(x.mid()) for a, x in rates.items()}, replace(found, matrix=matrix)


def _rates(
    unilateral: Sequence[Unilateral], group: Sequence[int], q: list[Ball], v: list[Ball], found: Responses
) -> RatesByLine:
    """Return the rates along all lines of a group."""
    rates: RatesByLine = {}
    for i in group:
        one = unilateral[i]
        lines = [found.normal[i], *found.grip(i)]
        rates.update(zip(lines, (gap_rate(one, q, v), slip_rate(one, q, v), across_rate(one, q, v)), strict=False))
    return rates


def _gap_afterwards(one: Unilateral, line: int, after: RatesByLine, before: RatesByLine) -> str:
    """Return in words how a gap changes after an impact; what is left of a zero by rounding is zero."""
    rate = float(after[line])
    if abs(rate) <= LIMIT * max(abs(float(x)) for x in (*after.values(), *before.values())):
        return "stays closed"
    return f"opens at {rate:.10g} {'rad/s' if one.unit == 'N m' else 'm/s'}"


def _in_turn(
    unilateral: Sequence[Unilateral], order: Sequence[Sequence[int]], given: RatesByLine, known: Responses
) -> _Outcome | Problem:
    """Return the sum of the impulses if of groups that act together the first in which one approaches comes first."""
    rates, found = _without_width(given, known)
    total: Forces = {}
    works: dict[int, Ball] = {}
    normal = found.normal
    now = dict(rates)
    least = _least_rate(rates)
    for _ in range(_MOST_IN_TURN):
        hit = next((one for one in order if any(now[normal[i]] < -least for i in one)), None)
        if hit is None:
            return _Outcome(_at_the_limit(total, now, least, found, known), works, in_turn=True)
        impulses = impulses_together(unilateral, hit, now, found)
        if isinstance(impulses, Problem):
            return impulses
        for i, more in _outcome(hit, impulses, now, found).works.items():
            work = more + works.get(i, ZERO)
            works[i] = ZERO if is_zero(work) else work
        for b, x in impulses.items():
            total[b] = total.get(b, ZERO) + x
        now = rates_after(total, rates, found)
        now = {a: ZERO if is_zero(x) else x for a, x in now.items()}
    names = tuple(unilateral[i].name for one in order for i in one)
    return Problem("simultaneous-impacts", "in this order the impacts never end", names, decided_by="another order")


def _at_the_limit(total: Forces, now: RatesByLine, least: float, found: Responses, known: Responses) -> Forces:
    """Return impulses that leave no rate at all where impacts in turn have left less than the least that counts.

    What is left would be an impact again at the same instant. Of several shares of an impulse that leave nothing one is
    taken: lines that depend on one another, as far as they are `known`, would share without a bound.
    """
    lines = [a for a, x in now.items() if total.get(a, ZERO) != 0 and float(abs(x)) <= least]
    if all(now[a] == 0 for a in lines):
        return total
    chosen = independent({b: known.matrix[a][b] for b in lines if not is_zero(known.matrix[a][b])} for a in lines)
    lines = [lines[k] for k in chosen]
    elimination = Elimination()
    for a in lines:
        left = elimination.add({b: found.matrix[a][b] for b in lines if found.matrix[a][b] != 0}, -now[a])
        if left is not None and not is_zero(left):
            return total
    return total | {a: total[a] + more for a, more in zip(lines, elimination.solution(lines), strict=True)}
