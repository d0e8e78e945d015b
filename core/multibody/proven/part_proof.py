"""What is proven of an independent part of a scene, at the present precision."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from typing import Any

from flint import ctx

from core.balls import Undetermined, precision
from core.digits.adaptive_precision import working_bits
from core.digits.decimals import decimal, floor_below, place_of
from core.errors import NotApplicable
from core.multibody.algebra.directions import polar_angle, scalar_product
from core.multibody.algebra.polynomials import BITS, ZERO, Ball, evaluated, is_zero
from core.multibody.answer import Energy
from core.multibody.equations.dynamics import forces_at_start, multipliers_at_start
from core.multibody.language.scene import Scene
from core.multibody.model_answer import PartModel, SceneModel, SmallMotion
from core.multibody.motion.attitudes import angular_velocity, quaternion
from core.multibody.motion.modelling import Modelled, Piece, modelled
from core.multibody.motion.motion import BallState, Motion
from core.multibody.motion.pendulum import plane_pendulum
from core.multibody.proven.proven_series import ProvenSeries, Vector
from core.multibody.search.first_of_motion import Expansions
from core.multibody.start import noticed_of, scene_model, slack_strings
from core.multibody.table.frames import Frame
from core.multibody.trajectory.events import End, end_of, first_event, runs_of
from core.notices import Notice
from core.systems.trajectory import MotionEvent


@dataclass(frozen=True)
class ProvenColumn:
    """One quantity at every time, as decimal strings or lists of them."""

    values: list[Any]
    unit: str


@dataclass(frozen=True)
class ProvenAnswer:
    """The answer, its numbers as decimal strings; what was not requested is None.

    Attributes
    ----------
    rows : list of int or None
        Which of the times the motion reaches.
    columns : mapping of str to ProvenColumn, or None
    ended : str or None
        `HORIZON`, or the event that ends the motion before the last time.
    """

    model: SceneModel
    accelerations: Mapping[str, Any] | None
    forces: Mapping[str, Any] | None
    energy: Energy | None
    rows: list[int] | None
    columns: Mapping[str, ProvenColumn] | None
    ended: str | None
    warnings: tuple[Notice, ...]


class PartProof:
    """What is proven of a part at the present precision."""

    def __init__(self, scene: Scene, digits: int, first_bits: int) -> None:
        self.digits, self.first_bits = digits, first_bits
        with precision(max(BITS, ctx.prec)):
            self.found = _in_closed_forms(modelled(scene))
            self.multipliers = multipliers_at_start(self.found.described.measures, self.found.whole.acceleration)
            self.forces = forces_at_start(self.found.described.measures, self.multipliers)
        parts = zip(self.found.pieces, self.found.whole.parts, strict=True)
        if any(piece.table.acting and motion.how != "closed form" for piece, (_, motion) in parts):
            raise NotApplicable(
                "digits are not proven yet where forces are formulas without a closed form",
                path=("connections",),
                remedy="ask POST /v1/scenes, whose errors are measured against pairs of doubles",
            )
        _require_exact(self.found)
        slack = slack_strings(self.found, self.forces)
        if slack:
            raise NotApplicable(
                f"{', '.join(slack)} would have to push at the start: strings that are slack are answered in doubles",
                path=("connections",),
                remedy="ask POST /v1/scenes, or leave out the string",
            )

    def model(self) -> SceneModel:
        """Return the model, its figures as numerals."""
        found = self.found
        model = scene_model(found, noticed_of(found, self.forces, self.multipliers), self.multipliers)
        return _in_numerals(model, found, self.number)

    def number(self, ball: Ball) -> Any:
        """Return a number as a numeral of so many digits."""
        return "0" if is_zero(ball) else decimal(ball, self.digits)

    @property
    def watched(self) -> list[End]:
        """What may end the motion."""
        whole = self.found.whole
        limits = whole.limits
        return [
            end_of(whole, limit)
            for limit in limits
            if limit.force is None or self.forces[limit.force].value is not None
        ]

    def reached(self, times: Sequence[Fraction]) -> tuple[list[int], list[MotionEvent]]:
        """Return the rows of the times before what ends the motion, which is looked for as in doubles, and that."""
        rows, events = list(range(len(times))), []
        with precision(BITS):
            for end in {max(float(max(times)), 0.0), min(float(min(times)), 0.0)} - {0.0}:
                event = first_event(self.found.whole, self.watched, end, self._expansions)
                if event is not None:
                    events.append(event)
                    # Within the error of its time nothing is said to be before it.
                    bound = Fraction(event.time) - Fraction(event.error) * (1 if end > 0.0 else -1)
                    rows = [k for k in rows if (times[k] <= bound if end > 0.0 else times[k] >= bound)]
        return rows, events

    def _expansions(self) -> Expansions:
        return Expansions.of(runs_of(self.found.whole, self.found.whole))

    def columns(self, times: Sequence[Ball]) -> dict[str, ProvenColumn]:
        """Return what the bodies do, at times before what ends the motion."""
        whole, frames = self.found.whole, self.found.described.measures.coordinates.frames
        count = len(whole.reduced.table.names)
        states = [
            _states(piece, motion, self._directions(piece), times)
            for piece, (_, motion) in zip(self.found.pieces, whole.parts, strict=True)
        ]
        columns: dict[str, ProvenColumn] = {}
        for k in range(len(times)):
            z, w = [ZERO] * count, [ZERO] * count
            for piece, found in zip(self.found.pieces, states, strict=True):
                for i, x, y in zip(piece.indices, found[k].q, found[k].v, strict=True):
                    z[i], w[i] = x, y
            q = [evaluated(poly, z) for poly in whole.reduced.expressions]
            v = [sum((x * w[key[0]] for key, x in poly.items() if key), ZERO) for poly in whole.reduced.expressions]
            for name, frame in frames.items():
                followed = (
                    (piece, found[k])
                    for piece, found in zip(self.found.pieces, states, strict=True)
                    if self._follows(piece, frame)
                )
                for column, unit, value in self._of_body(name, frame, q, v, next(followed, None)):
                    columns.setdefault(f"{name}.{column}", ProvenColumn([], unit)).values.append(value)
        return columns

    def _follows(self, piece: Piece, frame: Frame) -> bool:
        seen = {key[0] for i in frame.direction or () for key in self.found.whole.reduced.expressions[i] if key}
        return bool(seen & set(piece.indices))

    def _directions(self, piece: Piece) -> list[Any]:
        """Return the components of directions that follow a part, in its own coordinates."""
        number = {i: k for k, i in enumerate(piece.indices)}
        expressions = self.found.whole.reduced.expressions
        return [
            {(number[key[0]],) if key else (): x for key, x in expressions[i].items()}
            for frame in self.found.described.measures.coordinates.frames.values()
            if frame.direction is not None and self._follows(piece, frame)
            for i in frame.direction
        ]

    def _of_body(
        self, name: str, frame: Frame, q: Vector, v: Vector, followed: tuple[Piece, BallState] | None
    ) -> list[tuple[str, str, Any]]:
        found: list[tuple[str, str, Any]] = [
            ("position", "m", self._vector([q[i] for i in frame.position])),
            ("velocity", "m/s", self._vector([v[i] for i in frame.position])),
        ]
        if frame.turn is not None:
            found.append(("angle", "rad", self._vector([q[frame.turn]])[0]))
            found.append(("angular_velocity", "rad/s", self._vector([v[frame.turn]])[0]))
        elif frame.direction is not None:
            c, s = frame.direction
            found.append(("angle", "rad", self._vector([self._angle(name, frame, q, followed)])[0]))
            found.append(("angular_velocity", "rad/s", self._vector([q[c] * v[s] - q[s] * v[c]])[0]))
        elif frame.axis is not None:
            found.append(("axis", "1", self._vector([q[i] for i in frame.axis[1]])))
        elif frame.axes is not None:
            e, rate = ([[x[i] for i in axis] for axis in frame.axes] for x in (q, v))
            found.append(("attitude", "1", self._vector(quaternion(e))))
            found.append(("angular_velocity", "rad/s", self._vector(angular_velocity(e, rate))))
        elif frame.turns is not None:
            found.append(("angular_velocity_in_space", "rad/s", self._vector([v[i] for i in frame.turns])))
        return found

    def _angle(self, name: str, frame: Frame, q: Vector, followed: tuple[Piece, BallState] | None) -> Ball:
        """Return an unwrapped angle: that at the start, and what was turned since, of a series in every step."""
        assert frame.direction is not None
        total = self.found.described.measures.coordinates.start_angle(name)
        if followed is None:
            return total
        (piece, state), expressions = followed, self.found.whole.reduced.expressions
        if state.turned is not None:
            return total + self.found.whole.sense(frame.direction) * state.turned
        places = []
        for own in state.path:
            z = dict(zip(piece.indices, own, strict=True))
            places.append([evaluated(expressions[i], z) for i in frame.direction])
        places.append([q[i] for i in frame.direction])
        for (c, s), (x, y) in pairwise(places):
            total = total + polar_angle(c * x + s * y, c * y - s * x)
        return total

    def _vector(self, components: Sequence[Ball]) -> list[str]:
        size = scalar_product(components, components).sqrt()
        if not size > 0:
            if size.is_zero():
                return ["0"] * len(components)
            if working_bits() < 2 * self.first_bits:
                raise Undetermined
            # Nothing but zero, as far as twice the digits tell.
            return [f"0e{place_of(size.abs_upper()) + 1}"] * len(components)
        return [decimal(x, self.digits, floor_below(size, self.digits)) for x in components]


def _require_exact(found: Modelled) -> None:
    """Raise `NotApplicable` for a start that meets the connections only to rounding, or where they are redundant."""
    if found.moved or found.fitted:
        what = ", ".join([*found.moved, *found.fitted])
        raise NotApplicable(
            f"{what} would hold only after rounding: the digits would be those of another scene",
            path=("connections",),
            remedy='write positions and velocities exactly, as formulas where needed: "sqrt(3)/2", {"degrees": 30}',
        )
    if found.whole.dropped:
        raise NotApplicable(
            "connections depend on one another at the start, and nothing proves that they do later",
            path=("connections",),
            remedy="leave out connections that follow from others",
        )


def _in_closed_forms(found: Modelled) -> Modelled:
    """Return models of which a pendulum, in doubles one period of a series, is a closed form."""
    parts = [
        (indices, plane_pendulum(piece.table, piece.chosen) or motion)
        for piece, (indices, motion) in zip(found.pieces, found.whole.parts, strict=True)
    ]
    return replace(found, whole=replace(found.whole, parts=parts))


def _in_numerals(model: SceneModel, found: Modelled, number: Callable[[Ball], Any]) -> SceneModel:
    """Return the model with the modes of linear parts as numerals, and without figures that are found in pairs."""
    apart = []
    for part, (_, motion) in zip(model.apart, found.whole.parts, strict=True):
        modes = tuple(SmallMotion(number(mode.frequency), number(mode.growth)) for mode in motion.modes)
        returns = found.whole.returns_after(motion) if motion.how == "closed form" else None
        period = None if returns is None else number(returns)
        apart.append(PartModel(part.name, part.why, part.degrees_of_freedom, part.coordinates, period, None, modes))
    return SceneModel(**{**vars(model), "apart": tuple(apart)})


def _states(piece: Piece, motion: Motion, directions: Sequence[Any], times: Sequence[Ball]) -> Sequence[BallState]:
    """Return the states of a part: in closed form where there is one, otherwise by its series."""
    # Which branch of a closed form holds is decided with the bits of the set-up at least.
    with precision(max(BITS, ctx.prec)):
        known = motion.in_balls(times)
    return ProvenSeries(piece.table, piece.chosen, directions).states(times) if known is None else known
