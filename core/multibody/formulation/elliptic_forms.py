"""Angles of pendulums as functions of the time: what an equation a v'' + b sin(n v) + c cos(n v) = 0 alone says."""

from __future__ import annotations

from flint import arb

from core.formulas import Node
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, is_zero
from core.multibody.formulation.formula_nodes import Terms, call, node_of_terms
from core.multibody.formulation.trigonometric_sums import TIME, Sum, Term, Variable
from core.scenes.pendulum import Pendulum


def elliptic_form(name: str, equation: Sum, start: Ball, rate: Ball) -> Node | None:
    """Return the variable of a pendulum's equation as a formula of the time, None of another equation.

    The functions are sn(u, m) and am(u, m) of Jacobi with the parameter m = k^2, and elementary ones on the separatrix.

    Parameters
    ----------
    name : str
        Of the variable.
    equation : Sum
        What is zero.
    start, rate : ball
        Of the variable, at the time 0.

    References
    ----------
    NIST Digital Library of Mathematical Functions, 22.19(i).
    """
    form = _form(name, equation)
    if form is None:
        return None
    factor, pull, offset = form
    angle = factor * start + offset
    turns = round(float(angle / (2 * ONE.pi())))
    half = angle / 2 - turns * ONE.pi()
    sine, cosine = half.sin(), half.cos()
    if not cosine > 0:
        # Upright, or not told from it.
        return None
    pendulum = Pendulum(pull.sqrt(), _known(sine), cosine, _known(factor * rate))
    shown = _half_angle(pendulum)
    if shown is None:
        return None
    way, node = shown
    terms: Terms = [(2 * way / factor, [node])]
    shift = (2 * turns * ONE.pi() - offset) / factor
    if not is_zero(shift):
        terms.append((shift, []))
    return node_of_terms(terms)


def _known(value: Ball) -> Ball:
    """Return a number that is zero where it is not told from it: what is at rest is at rest."""
    return ZERO if is_zero(value) else value


def _form(name: str, equation: Sum) -> tuple[Ball, Ball, Ball] | None:
    """Return n, w^2 and d of an equation that says u'' = -w^2 sin u of u = n v + d, None of another one."""
    inertia, parts, waves = ZERO, {"sin": ZERO, "cos": ZERO}, set()
    for term, value in equation.terms.items():
        if term == Term(((Variable(name, 2), 1),)):
            inertia = value
        elif not term.factors and term.function and {x for x, _ in term.wave} == {name}:
            parts[term.function] = value
            waves.add(term.wave[0][1])
        else:
            return None
    if len(waves) != 1 or not inertia > 0:
        return None
    factor = ONE * waves.pop()
    size = (parts["sin"] ** 2 + parts["cos"] ** 2).sqrt()
    return factor, factor * size / inertia, arb.atan2(parts["cos"], parts["sin"])


def _half_angle(pendulum: Pendulum) -> tuple[int, Node] | None:
    """Return half the angle of a pendulum with its sign as a formula of the time; None where it rests."""
    regime = pendulum.regime
    if regime == "rest":
        return None
    argument = _affine(pendulum.speed, pendulum.start)
    if regime == "separatrix":
        return pendulum.direction, call("atan", call("sinh", argument))
    parameter = pendulum.m if regime == "libration" else 1 / pendulum.m
    if float(parameter) == 1:
        # No double tells it from the separatrix.
        return None
    shown = node_of_terms([(parameter, [])])
    if regime == "rotation":
        return pendulum.direction, call("am", argument, shown)
    return 1, call("asin", node_of_terms([(pendulum.m.sqrt(), [call("sn", argument, shown)])]))


def _affine(speed: Ball, start: Ball) -> Node:
    terms: Terms = [(speed, [Node("name", TIME)])]
    if not is_zero(start):
        terms.append((start, []))
    return node_of_terms(terms)
