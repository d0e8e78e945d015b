"""The impulse of one contact in the plane by the laws of Poisson and Stronge: slip is followed through the impulse.

With the normal impulse p as the variable, the rates of gap and slip change in proportion to it as long as the slip
keeps its sense: friction is -sigma mu dp. Where the slip stops it sticks, if the friction that this takes is within the
cone, or goes on in the sense that the impulse gives it. Compression ends where the gap stops closing. Poisson's
restitution is by the impulse e p_c that follows, Stronge's by the work e^2 of that of compression.

References
----------
E. J. Routh, "The Elementary Part of a Treatise on the Dynamics of a System of Rigid Bodies" (1905), chapter 5.
Y. Wang, M. T. Mason, "Two-dimensional rigid-body collisions with friction", J. Appl. Mech. 59 (1992).
W. J. Stronge, "Rigid body collisions with friction", Proc. R. Soc. A 431 (1990).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.contacts.contact_responses import Forces, Responses
from core.multibody.contacts.contact_states import Problem
from core.multibody.contacts.impulses import RatesByLine
from core.multibody.table.connection_effects import Unilateral


@dataclass(frozen=True)
class _Pass:
    """Where an impulse has come to.

    Attributes
    ----------
    push, rub : ball
        Impulse along the gap and along the slip.
    closing, slip : ball
        Rates of gap and slip.
    work : ball
        Of the impulse along the gap.
    """

    push: Ball
    rub: Ball
    closing: Ball
    slip: Ball
    work: Ball


@dataclass(frozen=True)
class _Contact:
    """How the rates along one contact answer impulses along it, and its coefficients."""

    nn: Ball
    nt: Ball
    tt: Ball
    static: Ball
    kinetic: Ball

    def friction(self, slip: Ball) -> tuple[Ball, bool]:
        """Return the impulse of friction for a unit of that along the gap, and whether the slip stays zero by it."""
        if slip > 0 or slip < 0:
            return (-self.kinetic if slip > 0 else self.kinetic), False
        if is_zero(self.tt):
            return ZERO, True
        holds = -self.nt / self.tt
        if not abs(holds) > self.static:
            return holds, True
        return (-self.kinetic if self.nt > 0 else self.kinetic), False

    def go_on(self, now: _Pass, target: _Target) -> tuple[_Pass, bool] | None:
        """Return the state where the slip stops or the target is reached, and whether it is; None if neither comes."""
        rub, sticks = self.friction(now.slip)
        opening, gain = self.nn + rub * self.nt, ZERO if sticks else self.nt + rub * self.tt
        left = target.left(now, opening)
        stops = None
        if not is_zero(now.slip) and not is_zero(gain) and now.slip * gain < 0:
            stops = -now.slip / gain
        if left is not None and (stops is None or not left > stops):
            return self._after(now, left, rub, opening, gain), True
        if stops is None:
            return None
        return replace(self._after(now, stops, rub, opening, gain), slip=ZERO), False

    @staticmethod
    def _after(now: _Pass, more: Ball, rub: Ball, opening: Ball, gain: Ball) -> _Pass:
        work = more * (now.closing + opening * more / 2)
        closing, slip = now.closing + opening * more, now.slip + gain * more
        return _Pass(now.push + more, now.rub + rub * more, closing, slip, now.work + work)


@dataclass(frozen=True)
class _Target:
    """What ends a part of an impulse: the rate zero of the gap, an impulse in all, or a work in all."""

    push: Ball | None = None
    work: Ball | None = None

    def left(self, now: _Pass, opening: Ball) -> Ball | None:
        """Return the impulse until then, of which a unit changes the rate of the gap by `opening`; None without end."""
        if self.push is not None:
            return self.push - now.push
        if self.work is None:
            return -now.closing / opening if opening > 0 else None
        # Of u p + k p^2/2 = the work that is left the positive root.
        need = self.work - now.work
        if is_zero(need):
            return ZERO
        square = now.closing * now.closing + 2 * opening * need
        if not square > 0:
            return None
        return 2 * need / (now.closing + square.sqrt())


def impulse_alone(one: Unilateral, i: int, rates: RatesByLine, found: Responses) -> Forces | Problem:
    """Return the impulses of one contact that acts alone, by its law.

    Parameters
    ----------
    i : int
        Its number among the measures.
    rates : dict of int to ball
        Before the impulse.
    """
    a = found.normal[i]
    b = found.slips.get(i)
    nn = found.matrix[a][a]
    nt, tt = (ZERO, ZERO) if b is None else (found.matrix[a][b], found.matrix[b][b])
    contact = _Contact(nn, nt, tt, one.static, one.kinetic)
    now = _Pass(ZERO, ZERO, rates[a], ZERO if b is None else rates[b], ZERO)
    compressed = _until(contact, now, _Target())
    if compressed is None:
        return _without_end(one)
    e = one.restitution
    target = _Target(push=(1 + e) * compressed.push)
    if one.law == "stronge":
        target = _Target(work=compressed.work * (1 - e * e))
    end = _until(contact, replace(compressed, closing=ZERO), target)
    if end is None:
        return _without_end(one)
    return {a: end.push} if b is None else {a: end.push, b: ZERO if is_zero(end.rub) else end.rub}


def _until(contact: _Contact, now: _Pass, target: _Target) -> _Pass | None:
    # It slides, sticks or slides on: the slip stops once at most.
    for _ in range(3):
        found = contact.go_on(now, target)
        if found is None:
            return None
        now, reached = found
        if reached:
            return now
    return None


def _without_end(one: Unilateral) -> Problem:
    return Problem(
        "no-impact",
        "friction presses on so strongly that the impulse has no end",
        (one.name,),
        decided_by="a smaller coefficient of friction",
    )
