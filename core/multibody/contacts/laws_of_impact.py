"""Impulses of contacts that act together, by their laws: Newton's, Poisson's or Stronge's.

Newton's law is one of the rates before and after. By Poisson's law contacts without friction compress together, to
rates of gaps that are zero at least, and every one then takes the share e of its own impulse again; what approaches by
that is held by as much more. One contact that acts alone is followed through its impulse, with friction.

References
----------
C. Glocker, F. Pfeiffer, "Multiple impacts with friction in rigid multibody systems", Nonlinear Dynamics 7 (1995).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.multibody.algebra.polynomials import ZERO, is_zero
from core.multibody.contacts.contact_responses import MOST_UNDECIDED, Forces, Responses
from core.multibody.contacts.contact_states import Problem
from core.multibody.contacts.frictionless import impulses_without_friction
from core.multibody.contacts.impulses import RatesByLine, impulses_at_once, rates_after
from core.multibody.contacts.slip_through_impact import impulse_alone
from core.multibody.table.connection_effects import Unilateral


def impulses_together(
    unilateral: Sequence[Unilateral], group: Sequence[int], rates: RatesByLine, found: Responses
) -> Forces | Problem:
    """Return the impulses of contacts that act together, or what is undecided about them."""
    laws = {unilateral[i].law for i in group}
    inelastic = all(is_zero(unilateral[i].restitution) for i in group)
    smooth = not any(found.grip(i) for i in group)
    if laws == {"newton"} or (inelastic and smooth):
        at_once = impulses_without_friction if smooth and len(group) > MOST_UNDECIDED else impulses_at_once
        return at_once(unilateral, group, rates, found)
    approaching = [i for i in group if rates[found.normal[i]] < 0]
    if len(approaching) == 1:
        i = approaching[0]
        one = unilateral[i]
        impulses = impulses_at_once(unilateral, [i], rates, found) if one.law == "newton" else None
        impulses = impulse_alone(one, i, rates, found) if impulses is None else impulses
        if isinstance(impulses, Problem):
            return impulses
        after = rates_after(impulses, rates, found)
        if all(after[found.normal[j]] >= 0 or is_zero(after[found.normal[j]]) for j in group):
            return impulses
    if laws == {"poisson"} and smooth:
        return _by_poisson(unilateral, group, rates, found)
    return Problem(
        "simultaneous-impacts",
        "how contacts share an impulse that act together is not determined by the laws of Poisson, with friction, and "
        "of Stronge",
        tuple(unilateral[i].name for i in group),
        decided_by='"simultaneous": "in order", or "impacts": "newton"',
    )


def _by_poisson(
    unilateral: Sequence[Unilateral], group: Sequence[int], rates: RatesByLine, found: Responses
) -> Forces | Problem:
    """Return the impulses of contacts without friction: of compression, of expansion, and of what that presses on."""
    plastic = [replace(one, restitution=ZERO) for one in unilateral]
    at_once = impulses_without_friction if len(group) > MOST_UNDECIDED else impulses_at_once
    compression = at_once(plastic, group, rates, found)
    if isinstance(compression, Problem):
        return compression
    total = {b: (1 + unilateral[i].restitution) * compression.get(b, ZERO) for i in group for b in [found.normal[i]]}
    after = {a: ZERO if is_zero(x) else x for a, x in rates_after(total, rates, found).items()}
    held = at_once(plastic, group, after, found)
    if isinstance(held, Problem):
        return held
    return {b: x + held.get(b, ZERO) for b, x in total.items()}
