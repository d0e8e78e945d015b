"""Impacts: Newton's law of restitution, with impulses of friction, by trying all combinations.

With p the impulses along gaps, s along slips: p >= 0 and the gap opens at e times the rate at which it closed, or p = 0
and it opens faster; where p > 0, either the slip stops and |s| <= mu p, or s = -sigma mu p and the slip has the sign
sigma.
Where more than one contact takes an impulse, rigid bodies do not say whether they do so together or one after another:
all orders are tried, and if they disagree the outcome is undecided unless the client orders them.

References
----------
F. Pfeiffer, C. Glocker, "Multibody Dynamics with Unilateral Contacts" (1996), chapter 8. T. R. Kane, "A dynamics
puzzle" (1984): with friction, Newton's law may add energy; such an outcome is refused.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations, product

from flint import arb_mat

from core.errors import BudgetExceeded
from core.multibody.complementarity import MOST, Responses, clusters, gap_rate, lines_of, responses, slip_rate
from core.multibody.contact_states import Problem, State, phase_table
from core.multibody.measures import Unilateral
from core.multibody.polynomials import ZERO, Ball, is_zero
from core.multibody.table import Table

_MOST_IN_TURN = 400
"""Impacts one after another before an order is given up."""
_LIMIT = 2.0**-40
_MOST_ORDERED = 4
"""Contacts of which every order is tried."""


@dataclass(frozen=True)
class Impact:
    """What happens at an impact.

    Attributes
    ----------
    v : list of ball
        Rates afterwards.
    impulses : mapping of int to (ball, ball)
        Of every measure that takes one: along its gap, and along its slip.
    loss : ball
        Kinetic energy that is lost.
    together : bool
        Whether several take impulses at once.
    """

    v: list[Ball]
    impulses: dict[int, tuple[Ball, Ball]]
    loss: Ball
    together: bool = False


def approaching(unilateral: Sequence[Unilateral], touching: Sequence[int], q: list[Ball], v: list[Ball]) -> list[int]:
    """Return the touching measures whose gaps would become negative."""
    rates = {i: gap_rate(unilateral[i], q, v) for i in touching}
    return [i for i, x in rates.items() if not is_zero(x) and x < 0]


def impact(
    base: Table,
    unilateral: Sequence[Unilateral],
    touching: Sequence[int],
    q: list[Ball],
    v: list[Ball],
    *,
    settled: bool = False,
) -> Impact | Problem:
    """Return the outcome of an impact of the touching measures, or why it is undecided.

    If it is `settled` that only one outcome is possible, as far as the state is known, none other is looked for.

    Raises
    ------
    BudgetExceeded
        For more than eight touching contacts that push one another.
    """
    rows, normal, slips = lines_of(unilateral, touching)
    table = phase_table(base, (), (), q, v).table
    found = responses(table, rows)
    before = _energy(table, v)
    after, impulses, together = list(v), {}, False
    for group in clusters(touching, normal, slips, found.matrix):
        if not approaching(unilateral, group, q, v):
            continue
        if len(group) > MOST:
            names = ", ".join(unilateral[i].name for i in group)
            raise BudgetExceeded(
                f"contacts in one impact ({names})",
                len(group),
                MOST,
                path=("connections",),
                remedy="hold some of them by connections of another kind",
            )
        outcome = _group(unilateral, group, q, v, found, normal, slips, settled=settled)
        if isinstance(outcome, Problem):
            return outcome
        for b, x in outcome.items():
            if x != 0:
                after = [a + x * y for a, y in zip(after, found.columns[b], strict=True)]
        taking = [i for i in group if outcome.get(normal[i], ZERO) != 0]
        together = together or len(taking) > 1
        impulses.update({i: (outcome[normal[i]], outcome.get(slips.get(i, -1), ZERO)) for i in taking})
    loss = before - _energy(table, after)
    if not is_zero(loss) and loss < 0 and not settled:
        return Problem(
            "energy-gain",
            f"Newton's law of restitution with friction would add {float(-loss):.6g} J to the motion",
            tuple(unilateral[i].name for i in impulses),
            decided_by="another law of impact (Poisson's or Stronge's), or a smaller coefficient of restitution",
        )
    return Impact(after, impulses, ZERO if is_zero(loss) else loss, together)


def _energy(table: Table, v: Sequence[Ball]) -> Ball:
    return sum((p * x for p, x in zip(table.inertial(v), v, strict=True)), ZERO) / 2


Impulses = dict[int, Ball]
"""Impulses by line."""


def _group(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    q: list[Ball],
    v: list[Ball],
    found: Responses,
    normal: dict[int, int],
    slips: dict[int, int],
    *,
    settled: bool,
) -> Impulses | Problem:
    rates = {normal[i]: gap_rate(unilateral[i], q, v) for i in group}
    rates |= {slips[i]: slip_rate(unilateral[i], q, v) for i in group if i in slips}
    rates = {a: ZERO if is_zero(x) else x for a, x in rates.items()}
    names = tuple(unilateral[i].name for i in group)
    given = [i for i in group if unilateral[i].order is not None]
    if len(given) == len(group) > 1:
        ordered = sorted(given, key=lambda i: (float(unilateral[i].order or ZERO), i))
        in_turn = _in_turn(unilateral, ordered, rates, found, normal, slips)
        return in_turn if in_turn is not None else _endless(names)
    at_once = _at_once(unilateral, group, rates, found, normal, slips)
    if isinstance(at_once, Problem) or settled:
        return at_once
    taking = [i for i in group if at_once.get(normal[i], ZERO) != 0]
    # A taut string passes on what pulls it at once.
    apart = [i for i in taking if rates[normal[i]] != 0 or unilateral[i].closes != "taut"]
    if len(apart) <= 1 and sum(rates[normal[i]] < 0 for i in group) <= 1:
        return at_once
    outcomes: list[tuple[str, Impulses]] = [("together", at_once)]
    if len(group) <= _MOST_ORDERED:
        for order in permutations(group):
            in_turn = _in_turn(unilateral, order, rates, found, normal, slips)
            if in_turn is not None:
                outcomes.append((" then ".join(unilateral[i].name for i in order), in_turn))
    first = _after(at_once, rates, found)
    if len(group) <= _MOST_ORDERED and all(_alike(first, _after(one, rates, found)) for _, one in outcomes[1:]):
        return at_once
    different: list[tuple[str, dict[int, Ball]]] = []
    for told, one in outcomes:
        then = _after(one, rates, found)
        if not any(_alike(then, other) for _, other in different):
            different.append((told, then))
    return Problem(
        "simultaneous-impacts",
        "several contacts take impulses at once, and rigid bodies do not say in which order",
        names,
        tuple(
            {"order": told} | {unilateral[i].name: f"opens at {float(then[normal[i]]):.10g}" for i in group}
            for told, then in different
        ),
        'the order in which they happen, as "order" of the contacts',
    )


def _endless(names: tuple[str, ...]) -> Problem:
    return Problem("simultaneous-impacts", "in this order the impacts never end", names, decided_by="another order")


def _after(impulses: Impulses, rates: dict[int, Ball], found: Responses) -> dict[int, Ball]:
    return {a: x + sum((found.matrix[a][b] * p for b, p in impulses.items()), ZERO) for a, x in rates.items()}


def _alike(first: dict[int, Ball], second: dict[int, Ball]) -> bool:
    """Return whether two outcomes are one: impacts in turn may come to it as a limit only."""
    scale = max((float(abs(x)) for x in first.values()), default=0.0)
    return all(is_zero(x - second[a]) or bool(abs(x - second[a]) < _LIMIT * scale) for a, x in first.items())


def _in_turn(
    unilateral: Sequence[Unilateral],
    order: Sequence[int],
    rates: dict[int, Ball],
    found: Responses,
    normal: dict[int, int],
    slips: dict[int, int],
) -> Impulses | None:
    """Return the sum of the impulses if the first that approaches always comes first; None if that does not end."""
    total: Impulses = {}
    now = dict(rates)
    # Impacts that only come ever nearer to an end have come to it here.
    least = _LIMIT * max((float(abs(x)) for x in rates.values()), default=0.0) * 2.0**-24
    for _ in range(_MOST_IN_TURN):
        hit = next((i for i in order if now[normal[i]] < -least), None)
        if hit is None:
            return total
        one = _at_once(unilateral, [hit], now, found, normal, slips)
        if isinstance(one, Problem):
            return None
        for b, x in one.items():
            total[b] = total.get(b, ZERO) + x
        now = _after(total, rates, found)
        now = {a: ZERO if is_zero(x) else x for a, x in now.items()}
    return None


def _at_once(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    rates: dict[int, Ball],
    found: Responses,
    normal: dict[int, int],
    slips: dict[int, int],
) -> Impulses | Problem:
    """Return the impulses if all act together."""
    consistent: list[tuple[tuple[State, ...], Impulses]] = []
    choices = [
        (State.OPEN, State.STICK, State.FORWARD, State.BACKWARD) if i in slips else (State.OPEN, State.CLOSED)
        for i in group
    ]
    for states in product(*choices):
        impulses = _solved(unilateral, group, states, rates, found, normal, slips)
        if impulses is None:
            continue
        after = _after(impulses, rates, found)
        if all(
            _holds(unilateral[i], i, state, after, impulses, rates, normal, slips)
            for i, state in zip(group, states, strict=True)
        ):
            consistent.append((states, impulses))
    names = tuple(unilateral[i].name for i in group)
    if not consistent:
        return Problem(
            "no-impact",
            "no impulses of friction and restitution go with this impact",
            names,
            decided_by="another law of impact",
        )
    least = [one for one in consistent if not any(_sticks_more(other[0], one[0]) for other in consistent)]
    first = _after(least[0][1], rates, found)
    for _, other in least[1:]:
        if not _alike(first, _after(other, rates, found)):
            return Problem(
                "several-impacts",
                "several outcomes of the impact are possible",
                names,
                tuple({name: s.value for name, s in zip(names, states, strict=True)} for states, _ in least),
                "another law of impact",
            )
    return min(least, key=lambda one: sum(state is not State.OPEN for state in one[0]))[1]


def _sticks_more(other: Sequence[State], one: Sequence[State]) -> bool:
    pairs = list(zip(other, one, strict=True))
    return any(a is not b for a, b in pairs) and all(a is b or (a is State.STICK and b.sense != 0) for a, b in pairs)


def _solved(
    unilateral: Sequence[Unilateral],
    group: Sequence[int],
    states: Sequence[State],
    rates: dict[int, Ball],
    found: Responses,
    normal: dict[int, int],
    slips: dict[int, int],
) -> Impulses | None:
    unknowns: list[Impulses] = []
    lines: list[int] = []
    right: list[Ball] = []
    for i, state in zip(group, states, strict=True):
        if state is State.OPEN:
            continue
        push: Impulses = {normal[i]: ZERO + 1}
        if state.sense:
            push[slips[i]] = -state.sense * unilateral[i].kinetic
        unknowns.append(push)
        lines.append(normal[i])
        closing = rates[normal[i]]
        right.append(-closing - (unilateral[i].restitution * closing if closing < 0 else ZERO))
        if state is State.STICK:
            unknowns.append({slips[i]: ZERO + 1})
            lines.append(slips[i])
            right.append(-rates[slips[i]])
    if not lines:
        return {}
    matrix = [[sum((found.matrix[a][b] * x for b, x in push.items()), ZERO) for push in unknowns] for a in lines]
    try:
        solved = arb_mat(matrix).solve(arb_mat([[x] for x in right])).entries()
    except ZeroDivisionError:
        return None
    impulses: Impulses = {}
    for x, push in zip(solved, unknowns, strict=True):
        for b, factor in push.items():
            impulses[b] = impulses.get(b, ZERO) + x * factor
    return {b: ZERO if is_zero(x) else x for b, x in impulses.items()}


def _holds(
    one: Unilateral,
    i: int,
    state: State,
    after: dict[int, Ball],
    impulses: Impulses,
    rates: dict[int, Ball],
    normal: dict[int, int],
    slips: dict[int, int],
) -> bool:
    closing = rates[normal[i]]
    if state is State.OPEN:
        spare = after[normal[i]] + (one.restitution * closing if closing < 0 else ZERO)
        return is_zero(spare) or bool(spare > 0)
    push = impulses[normal[i]]
    if not (is_zero(push) or push > 0):
        return False
    if state is State.STICK:
        rub = impulses[slips[i]]
        spare = one.static * push - abs(rub)
        return is_zero(spare) or bool(spare > 0)
    if state.sense:
        slip = state.sense * after[slips[i]]
        return is_zero(slip) or bool(slip > 0)
    return True
