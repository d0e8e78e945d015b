"""From a description to the motion of its parts: the table, its passes, and the smallest model of each part."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import arb

from core.balls import precision
from core.errors import InvalidParameter, NotApplicable
from core.multibody.algebra.polynomials import BITS, ZERO, Ball, entry, is_zero
from core.multibody.assembly.assembled_scene import assembled
from core.multibody.equations.assembly import assemble_places, assemble_rates
from core.multibody.equations.dynamics import accelerations, parts, restricted, singular_row
from core.multibody.equations.expansion import expansion
from core.multibody.language.numerals import Numerals
from core.multibody.language.scene import Scene
from core.multibody.language.switches import switches_of
from core.multibody.laws.series import values_at
from core.multibody.motion.dissipative import Dissipative, dissipates
from core.multibody.motion.driven_modes import driven_modes
from core.multibody.motion.euler_poisson import EulerPoisson
from core.multibody.motion.free_body import freely_turning
from core.multibody.motion.generic_equation import SceneSystem, scene_system
from core.multibody.motion.kepler import keplerian
from core.multibody.motion.modes import Modes
from core.multibody.motion.motion import Motion, Rest
from core.multibody.motion.numerical import Numerical
from core.multibody.motion.pendulum import LATE, plane_pendulum
from core.multibody.motion.periods import repeating
from core.multibody.motion.turning import turning
from core.multibody.motion.turning_body import turning_body
from core.multibody.motion.uniform import Uniform
from core.multibody.motion.vertical_symmetry import precessing
from core.multibody.motion.whole import Whole
from core.multibody.reduction.passes import further, reduced
from core.multibody.reduction.reduction import Reduced
from core.multibody.reduction.turned_axes import line_axes, plane_axes, spans_plane, turned_to, vertical_axes
from core.multibody.table.description import Described, described
from core.multibody.table.law_pieces import switching
from core.multibody.table.table import Table

_ANY_TIME = 1e300
"""Time (s) before which, and after minus which, everything happens."""
_LATER = 4
"""Order of the derivatives that show a plane: of a pendulum at rest beside its support the third one is zero."""


@dataclass(frozen=True)
class Piece:
    """A part of a reduced table that the others do not see.

    Attributes
    ----------
    indices : list of int
        Its coordinates.
    table : Table
    acceleration : list of balls
        At the start.
    chosen : list of int
        Its independent rows.
    """

    indices: list[int]
    table: Table
    acceleration: list[Ball]
    chosen: list[int]

    @property
    def freedom(self) -> int:
        """Degrees of freedom."""
        return len(self.table.names) - len(self.chosen)


@dataclass(frozen=True)
class Modelled:
    """A scene with its models.

    Attributes
    ----------
    described : Described
    whole : Whole
    pieces : list of Piece
        In the order of ``whole.parts``.
    moved, fitted : list of str
        Connections for which positions, and velocities that were, taken as rounded.
    """

    described: Described
    whole: Whole
    pieces: list[Piece]
    moved: list[str]
    fitted: list[str]

    @property
    def moving(self) -> list[tuple[Piece, Motion]]:
        """The parts that bodies follow: a clock that formulas alone read moves nothing."""
        table, expressions = self.described.measures.table, self.whole.reduced.expressions
        followed = {key[0] for e, unit in zip(expressions, table.units, strict=True) if unit != "s" for key in e if key}
        parts = zip(self.pieces, self.whole.parts, strict=True)
        return [(piece, motion) for piece, (indices, motion) in parts if followed.intersection(indices)]


def modelled(scene: Scene, numerals: Numerals | None = None) -> Modelled:
    """Return the models of a scene, whose numbers may be read in another way; the precision of balls is the caller's.

    Raises
    ------
    InvalidParameter
        For a scene that cannot be, with the path to the fault; `SlackAtStart` where a string is too long to be taut.
    NotApplicable
        For a scene with contacts, or with formulas of several pieces.
    """
    found = described(scene, numerals)
    table = found.measures.table
    if found.measures.unilateral:
        raise NotApplicable(
            "contacts change the equations of motion at every event: such a scene is answered by its own phases alone",
            path=("connections", found.paths[found.measures.unilateral[0].name][-1]),
            remedy="leave out the method, or hold what touches by a connection of another kind",
        )
    law = next((law for law in table.laws if switching([law])), None)
    if law is not None:
        raise NotApplicable(
            "a formula of several pieces changes the equations of motion at every zero of what these depend on: such "
            "a scene is answered by its own phases alone",
            path=law.path,
            remedy="leave out the method or the chain, or write a formula of one piece",
        )
    moved = list(dict.fromkeys([*found.measures.coordinates.rounded, *assemble_places(table, found.paths)]))
    fitted = assemble_rates(table, found.measures.coordinates.given, found.paths)
    return models_of(found, moved, fitted)


def models_of(found: Described, moved: list[str], fitted: list[str], rounding: float = 0.0) -> Modelled:
    """Return the models of a table whose start meets its rows.

    Parameters
    ----------
    rounding : float
        Share of the largest rate or acceleration (SI units) up to which one may be rounding: that is no direction.
    """
    small = _upright(found)
    pieces, accelerations, full = _start_of(found, small)
    turned = _turned(found, small, full, rounding)
    if turned is not None:
        small = turned
        pieces, accelerations, full = _start_of(found, small)
    motions = [(piece.indices, _motion(piece)) for piece in pieces]
    dropped = any(len(piece.chosen) < len(piece.table.rows) for piece in pieces)
    whole = Whole(found.measures, small, full, accelerations, motions, dropped)
    return Modelled(found, whole, pieces, moved, fitted)


def _start_of(found: Described, small: Reduced) -> tuple[list[Piece], list[Ball], list[Ball]]:
    """Return the parts of a reduced table, its accelerations at the start, and those of the coordinates described."""
    whole = [_piece(found, small.table, indices) for indices in parts(small.table)]
    pieces = [piece for one in whole for piece in _apart_from_clock(one)]
    accelerations: list[Ball] = [ZERO] * len(small.table.names)
    for piece in pieces:
        for i, x in zip(piece.indices, piece.acceleration, strict=True):
            accelerations[i] = x
    return pieces, accelerations, small.directions(accelerations)


def _apart_from_clock(piece: Piece) -> list[Piece]:
    """Return what rests at all times, apart from the clock that its formulas read; or the part as it is.

    What rests goes on to do so if the forces that read the clock have the same values whenever nothing moves.
    """
    table = piece.table
    clocks = [k for k, unit in enumerate(table.units) if unit == "s"]
    others = [k for k in range(len(table.names)) if k not in clocks]
    moves = [x for k in others for x in (table.v[k], piece.acceleration[k]) if not is_zero(x)]
    seen = [row.coordinates() for row in table.rows]
    if moves or not clocks or not others or any(x.intersection(clocks) and x.intersection(others) for x in seen):
        return [piece]
    laws = [law for law in table.acting if law.coordinates().intersection(clocks)]
    if any(next(switches_of(law.root), None) is not None for law in laws):
        # Of several pieces a ball of all times would choose one.
        return [piece]
    at_any_time = [arb(0, _ANY_TIME) if k in clocks else x for k, x in enumerate(table.q)]
    try:
        now, then = (values_at(laws, q, table.v) for q in (table.q, at_any_time))
    except InvalidParameter:
        return [piece]
    if any(x.rad() > 4 * y.rad() for x, y in zip(then, now, strict=True)):
        return [piece]
    found = []
    for own in (others, clocks):
        part = restricted(table, own)
        for law, value in zip(laws, now, strict=True):
            for i, x in law.push.items():
                if i in own:
                    part.load[own.index(i)] = entry(part.load, own.index(i)) + x * value
        gain, chosen = accelerations(part)
        found.append(Piece([piece.indices[k] for k in own], part, gain, chosen))
    return found


def _upright(found: Described) -> Reduced:
    """Return a scene reduced along axes of which one is vertical."""
    coordinates, table = found.measures.coordinates, found.measures.table
    axes = vertical_axes(coordinates.gravity)
    if axes is None:
        return reduced(table, pinning=True)
    vectors = [*coordinates.vectors, *coordinates.directions]
    return further(turned_to(table, vectors, [axes] * len(vectors)), pinning=True)


def _turned(found: Described, small: Reduced, accelerations: Sequence[Ball], rounding: float) -> Reduced | None:
    """Return a scene reduced along the axes of its plane and of lines, where these leave less of it."""
    coordinates, table = found.measures.coordinates, found.measures.table
    vectors, gravity = coordinates.vectors, coordinates.gravity
    derivatives = [table.v, accelerations]
    if not all(row.constant for row in small.table.rows) and _shows_less(vectors, derivatives, gravity):
        # What starts along a line may leave it later.
        places = expansion(small.table, _LATER).places
        derivatives += [small.directions([place[k] for place in places]) for k in range(3, _LATER + 1)]
    if rounding:
        least = rounding * max((abs(float(x)) for one in derivatives for x in one), default=0.0)
        derivatives = [[ZERO if abs(float(x)) < least else x for x in one] for one in derivatives]
    plane = None
    if coordinates.dimension == 3:
        plane = plane_axes(_moving(coordinates.positions, derivatives), gravity)
    lines = [line_axes(_moving([vector], derivatives)) for vector in vectors]
    if plane is None and not any(lines):
        return None
    common, directions = plane or vertical_axes(gravity), coordinates.directions
    # What does not turn keeps its direction, which is along the first axis then.
    lines += [line_axes(_moving([direction], [table.q])) for direction in directions]
    axes = [line or common for line in lines]
    less = further(turned_to(table, [*vectors, *directions], axes), pinning=True)
    return less if len(less.table.names) < len(small.table.names) else None


def _shows_less(
    vectors: Sequence[Sequence[int]], derivatives: Sequence[Sequence[Ball]], gravity: Sequence[Ball]
) -> bool:
    """Return whether the first derivatives of a motion leave open along which lines or in which plane it goes."""
    if any(line_axes(_moving([vector], derivatives)) is not None for vector in vectors):
        return True
    return len(gravity) == 3 and not spans_plane([*_moving(vectors, derivatives), gravity])


def _moving(vectors: Sequence[Sequence[int]], changes: Sequence[Sequence[Ball]]) -> list[list[Ball]]:
    return [[change[i] for i in vector] for change in changes for vector in vectors]


def system_of(scene: Scene) -> SceneSystem:
    """Return a scene as a system that methods can run.

    Raises
    ------
    InvalidParameter
        As `modelled`.
    NotApplicable
        If nothing moves.
    """
    found = assembled(scene).scene
    with precision(BITS):
        return scene_system(modelled(found).whole)


def _piece(found: Described, table: Table, indices: list[int]) -> Piece:
    part = restricted(table, indices)
    gain, chosen = accelerations(part)
    singular = singular_row(part, chosen)
    if singular is not None:
        raise InvalidParameter(
            found.paths.get(singular.name, ("connections",)),
            f'leave the motion determined: the start is a singular place, where "{singular.name}" and the connections '
            "around it lose their hold, and several motions are possible",
            remedy="start elsewhere",
        )
    return Piece(indices, part, gain, chosen)


def _motion(piece: Piece) -> Motion:
    """Return the smallest model of a part."""
    part, gain, chosen = piece.table, piece.acceleration, piece.chosen
    if all(is_zero(x) for x in part.v) and all(is_zero(x) for x in gain):
        return Rest(part)
    swung = driven_modes(part, gain) if part.acting or any(unit == "s" for unit in part.units) else None
    if swung is not None:
        return swung
    if part.acting:
        returning = repeating(part, gain, chosen)
        if returning is not None:
            return returning
        return followed(part, gain, chosen, "forces are formulas of time, places or rates that are not linear")
    linear = all(row.constant for row in part.rows)
    if linear and not part.stiffness and not part.damping and not part.gyration:
        return Uniform(part, gain)
    if linear and not part.gyration:
        return Modes.of(part, chosen)
    rubs = any(row.drag for row in part.rows)
    free_turn = turning(part, chosen)
    if free_turn is not None:
        return free_turn
    body = None if rubs else turning_body(part)
    if body is not None:
        about = freely_turning(part, body) or EulerPoisson.about(part, body, gain)
        if about is not None:
            return about
    found: Motion | None = None
    if not rubs:
        returning = repeating(part, gain, chosen)
        closed = plane_pendulum(part, chosen) if returning is None or returning.late > LATE else None
        found = keplerian(part) or closed or returning or precessing(part, gain, chosen)
    if found is not None:
        return found
    free = piece.freedom
    why = {
        0: "the rates that are prescribed leave nothing free",
        1: "one degree of freedom that does not return soon, or is driven or damped",
    }.get(free, f"{free} degrees of freedom are coupled by quadratic terms")
    return followed(part, gain, chosen, why)


def followed(table: Table, acceleration: Sequence[Ball], chosen: Sequence[int], why: str) -> Numerical:
    """Return the motion of a part without a closed form, which is followed step by step."""
    model = Dissipative if dissipates(table) else Numerical
    return model.of(table, acceleration, chosen, why)
