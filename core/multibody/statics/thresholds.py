"""Between which values of one number a scene stays at rest: a coefficient of friction, a slope, a force.

At rest a scene is in equilibrium if forces exist that balance it, with every contact pushing, every string taut and
every friction within its cone. Whether they do is decided in balls, and the ends of the range are bisected. Where the
number is a load or a coefficient of friction the balancing forces and the number form a convex set, or a larger number
only admits more: rest is one interval, and nothing between its ends is missed. Geometry may have more than one
interval; there it is looked at in `PROBES` values on either side, and a gap between neighbours is not seen.

References
----------
J.-S. Pang, J. Trinkle, "Stability characterizations of rigid body contact problems with Coulomb friction", ZAMM 80
(2000): what is found here is weak stability, that some forces balance the scene.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import arb

from core.balls import distance_bound
from core.errors import InvalidParameter, MechanicsError, NotApplicable, Path, pointer_of
from core.multibody.algebra.polynomials import Ball, is_zero
from core.multibody.answer import RestEnd, RestRange
from core.multibody.assembly.assembled_scene import assembled
from core.multibody.contacts.complementarity import decided, stays
from core.multibody.contacts.contact_start import assemble_contacts
from core.multibody.contacts.contact_states import Problem, State
from core.multibody.equations.packed import nearest
from core.multibody.language.numerals import Numerals
from core.multibody.language.scene import Scene
from core.multibody.language.written import Number
from core.multibody.language.written_units import unit_at, within_object
from core.multibody.table.description import Described, described
from core.near_names import did_you_mean
from core.work import spend

PROBES = 64
"""Values between the written one and each bound that are looked at where rest need not be one interval."""
_NARROW = 2.0**-64
"""Width of what is left at an end, relative to its value."""
_MOST_HALVINGS = 200
"""Halvings of an end: 64 reach `_NARROW`, and 128 an end at zero."""

_UNITS_OF_A_PROBE = 50.0
"""Work of one probe, for every coordinate of the scene."""


_BECOMES = {State.OPEN: "open", State.FORWARD: "slide", State.BACKWARD: "slide"}
"""What becomes of a contact that does not hold."""


@dataclass(frozen=True)
class RestOf:
    """A question: in which range of a number does the scene stay at rest?

    Attributes
    ----------
    vary : str
        JSON pointer of a number of the description, as ``/connections/0/friction`` or ``/let/alpha``.
    between : sequence of number
        Two bounds as they are written, with the written value between them.
    """

    vary: str
    between: Sequence[Number]


@dataclass(frozen=True)
class _Varied:
    """A scene with one number to vary, at `path`; `where` is the place of the question.

    What touches is known by name: a guide is one of the contacts only where it rubs.
    """

    scene: Scene
    path: Path
    where: Path
    touching: frozenset[str]

    def at(self, value: Ball) -> tuple[Described, list[int]]:
        """Return the scene with another value of the number, and which of its contacts touch."""
        numerals = Numerals.of(self.scene.let, self.scene.numbers, instead={self.path: value})
        try:
            base = _base(self.scene, numerals)
            spend(_UNITS_OF_A_PROBE * len(base.measures.table.names))
            touching = assemble_contacts(base).touching
        except MechanicsError as fault:
            raise InvalidParameter(
                (*self.where, "between"),
                f"stay where the scene can be; with the value {float(value):.10g} it cannot: {fault.detail}",
            ) from fault
        if _touching_contacts(base, touching) != self.touching:
            raise NotApplicable(
                f"with the value {float(value):.10g} other places touch than with the written one",
                path=(*self.where, "vary"),
                remedy="write the places as formulas over a name in let, and vary that name",
            )
        return base, touching

    def rests(self, value: Ball) -> bool:
        """Return whether the scene stays at rest with another value."""
        return _rests(*self.at(value))


def _touching_contacts(base: Described, touching: Sequence[int]) -> frozenset[str]:
    """Return the names of the contacts that touch, guides left out, which hold their places with and without it."""
    contacts = (base.measures.unilateral[i] for i in touching)
    return frozenset(contact.name for contact in contacts if contact.opposite is None)


def _base(scene: Scene, numerals: Numerals) -> Described:
    """Return the table of a scene; of a sketch, with the places that it has for these numbers."""
    if scene.assemble is None:
        return described(scene, numerals, one_sided=True)
    return described(assembled(scene, numerals).scene, numerals.without_places(), one_sided=True)


def _rests(base: Described, touching: Sequence[int]) -> bool:
    table = base.measures.table
    if table.laws:
        raise NotApplicable("ranges of rest are not answered yet where forces are formulas", path=("outputs",))
    return all(is_zero(x) for x in table.v) and stays(table, base.measures.unilateral, touching)


def range_of_rest(scene: Scene, question: RestOf, where: Path = ()) -> RestRange:
    """Return the range of a number in which a scene stays at rest; the precision of balls is the caller's.

    Parameters
    ----------
    where : path
        Of the question, for what is wrong with it.

    Raises
    ------
    InvalidParameter
        For a pointer that names no number, bounds that do not hold its value, and for a scene that cannot be, as it
        stands or with another value between the bounds.
    NotApplicable
        Where other places touch with another value.
    """
    path, least, most = _checked(scene, question, where)
    if not scene.continues:
        raise NotApplicable(
            "thresholds of rest are not answered beside a chain",
            path=where,
            remedy="ask for accelerations with other values of the number: at rest they are zero",
        )
    numerals = Numerals.of(scene.let, scene.numbers)
    base = _base(scene, numerals)
    if base.measures.level_rims:
        raise NotApplicable(
            "thresholds of rest are not answered where a disc or cylinder stands level: it may tip over any point of "
            "its rim, and not over four of them alone",
            path=where,
            remedy="describe places of the rim that touch",
        )
    if (inner := within_object(scene, path)) is not None:
        rule = "lead to the number itself, which is written with its unit"
        raise InvalidParameter((*where, "vary"), rule, remedy=f"write {pointer_of(inner)}; between is in that unit")
    if path not in numerals.every:
        near = did_you_mean(question.vary, [pointer_of(one) for one in numerals.every])
        raise InvalidParameter(
            (*where, "vary"),
            f'be the JSON pointer of a number of the description, unlike "{question.vary[:80]}"',
            remedy=f"{f'{near} ' if near else ''}name one that is written there, as /connections/0/friction",
        )
    written = numerals.every[path]
    if written < least or written > most:
        raise InvalidParameter((*where, "between"), f"hold the written value {float(written):.10g}")
    touching = assemble_contacts(base).touching
    value = nearest(written)
    error = distance_bound(written, value) or 0.0
    unit = unit_at(scene, path)
    if not _rests(base, touching):
        return RestRange(question.vary, unit, value, None, None, _why_not(base, touching), error)
    varied = _Varied(scene, path, where, _touching_contacts(base, touching))
    lower, upper = _end(varied, written, least), _end(varied, written, most)
    return RestRange(question.vary, unit, value, lower, upper, None, error)


def _why_not(base: Described, touching: Sequence[int]) -> str:
    """Return why a scene does not rest as it is written."""
    table, unilateral = base.measures.table, base.measures.unilateral
    moving = dict.fromkeys(
        name.partition(".")[0] for name, x in zip(table.names, table.v, strict=True) if not is_zero(x)
    )
    if moving:
        return f"with the written value it does not rest: at the start {', '.join(moving)} has a velocity"
    found = decided(table, unilateral, touching, table.q, table.v)
    if isinstance(found, Problem):
        return f"with the written value it does not rest: {found.explanation}"
    states = [
        f"{unilateral[i].name} would {_BECOMES[found.states[i]]}" for i in touching if found.states[i] in _BECOMES
    ]
    return f"with the written value no forces balance it{': ' if states else ''}{', '.join(states)}"


def _checked(scene: Scene, question: RestOf, where: Path) -> tuple[Path, Ball, Ball]:
    """Return the path of the number and the bounds."""
    if not isinstance(question.vary, str) or not question.vary.startswith("/"):
        raise InvalidParameter((*where, "vary"), "be a JSON pointer, which begins with /")
    bounds = question.between
    if isinstance(bounds, str) or not isinstance(bounds, Sequence) or len(bounds) != 2:
        raise InvalidParameter((*where, "between"), "be two numbers")
    numerals = Numerals.of(scene.let, scene.numbers)
    least, most = (numerals.number(x, (*where, "between", i)) for i, x in enumerate(bounds))
    path = tuple(int(part) if part.isdecimal() else part for part in question.vary[1:].split("/"))
    return path, least, most


def one_interval(scene: Scene, path: Path) -> bool:
    """Return whether a number is such that a scene rests in one interval of it.

    Equilibrium at given places is linear in the contact forces and each weight, force, torque or stiffness together:
    what is balanced is a convex set. A larger coefficient of friction admits all that a smaller one does.
    """
    if "polar" in path:
        return False
    if path[0] == "gravity" or (path[0] == "bodies" and path[2:] == ("mass",)):
        return True
    linear = ("friction", "force", "torque", "stiffness", "rest_length", "rest_angle", "strength", "constant")
    return path[0] == "connections" and path[2] in linear


def _end(varied: _Varied, inside: Ball, bound: Ball) -> RestEnd:
    """Return where rest ends between a value with it and a bound."""
    written = inside
    probes = 1 if one_interval(varied.scene, varied.path) else PROBES
    for k in range(1, probes + 1):
        outside = bound if k == probes else arb((written + (bound - written) * k / probes).mid())
        if not varied.rests(outside):
            return _bisected(varied, inside, outside)
        inside = outside
    return RestEnd(nearest(bound), 0.0, None, None)


def _bisected(varied: _Varied, inside: Ball, outside: Ball) -> RestEnd:
    """Return the end of rest between a value with it and one without."""
    inside, first = arb(inside.mid()), abs(float(outside - inside))
    for _ in range(_MOST_HALVINGS):
        middle = arb(((inside + outside) / 2).mid())
        # An end at zero is known relative to where it was looked for.
        if abs(float(outside - inside)) <= _NARROW * max(abs(float(middle)), _NARROW * first):
            break
        if varied.rests(middle):
            inside = middle
        else:
            outside = middle
    value = nearest((inside + outside) / 2)
    error = max(float(abs(x - arb(value)).upper()) for x in (inside, outside))
    base, touching = varied.at(outside)
    table, unilateral = base.measures.table, base.measures.unilateral
    found = decided(table, unilateral, touching, table.q, table.v)
    if isinstance(found, Problem):
        return RestEnd(value, error, {}, found.code)
    return RestEnd(value, error, {unilateral[i].name: found.states[i].value for i in touching}, None)
