"""What is answered about a scene.

An object that holds one value has its bound as `error`; an object with several has `errors`, by the names of its
fields. Both are in the unit of the value, and None where the value is, or where its digits are proven.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated

from core.multibody.equations_answer import SceneEquations
from core.multibody.model_answer import Assembly, SceneModel, SmallMotion
from core.multibody.undecided import Code
from core.quantities import Unit
from core.systems.trajectory import How, MotionEvent, Trajectory

Seconds = Annotated[float, Unit("s")]
Metres = Annotated[float, Unit("m")]
OwnUnit = Annotated[float, Unit("as in the field unit")]


@dataclass(frozen=True)
class AccelerationErrors:
    """Errors of accelerations, of a vector its length: linear (m/s^2) and angular (rad/s^2)."""

    linear: float | None
    angular: float | None


@dataclass(frozen=True)
class BodyAcceleration:
    """Accelerations of a body at the start.

    Attributes
    ----------
    linear : tuple of float
        Of the centre of mass (m/s^2).
    angular : float, tuple of float or None
        In the plane, a number; in space, in body axes (rad/s^2); None for particles and for tops.
    """

    linear: tuple[float, ...]
    angular: float | tuple[float, ...] | None = None
    errors: AccelerationErrors | None = None


@dataclass(frozen=True)
class ForceAnswer:
    """A force of a connection at the start.

    Attributes
    ----------
    value : float or None
        None where the scene does not determine it.
    unit : str
    determined : bool
    shared_with : tuple of str
        Connections that share what is not determined.
    error : float or None
        Of the value.
    """

    value: float | None
    unit: str
    determined: bool
    shared_with: tuple[str, ...] = ()
    error: float | None = None


@dataclass(frozen=True)
class EnergyErrors:
    """Errors of energies (J)."""

    kinetic: float | None
    potential: float | None
    total: float | None


@dataclass(frozen=True)
class Energy:
    """Energies at the start (J); the potential of gravity is zero at the origin.

    Attributes
    ----------
    conserved : bool
        Whether nothing works on the scene: no damper, motor or torque in space, and until the last time no friction
        of what slides and no impact that costs energy.
    """

    kinetic: float
    potential: float
    total: float
    conserved: bool
    errors: EnergyErrors | None = None


@dataclass(frozen=True)
class Occurrence:
    """A time at which a quantity takes a value.

    Attributes
    ----------
    quantity : str
    equals : float
    unit : str
    nth : int
        Counted from one, after the start.
    time : float
    error : float
        Of the time (s).
    how : str
        How the error of the quantity is known.
    """

    quantity: str
    equals: float
    unit: str
    nth: int
    time: float
    error: float
    how: How


@dataclass(frozen=True)
class SceneExtremes:
    """Least and largest value of a quantity.

    Attributes
    ----------
    least_time, largest_time : float
        The first of the times that cannot be distinguished.
    error : float
        Of both values.
    until : float
        End of what was searched, from the start.
    periodic : bool
        Whether that is a period, so that the extremes are those of all time.
    errors : mapping of str to float
        Of both times (s), for a constant as long as what was searched; and of the end of what was searched.
    least_places, largest_places : mapping of str to tuple of float
        Centres of mass at these times (m).
    place_errors : mapping of str to float
        Of both, by body, as the lengths of vectors (m).
    """

    quantity: str
    unit: str
    least: OwnUnit
    least_time: Seconds
    largest: OwnUnit
    largest_time: Seconds
    error: OwnUnit
    until: Seconds
    periodic: bool
    errors: Mapping[str, Seconds]
    least_places: Mapping[str, tuple[Metres, ...]] = field(default_factory=dict)
    largest_places: Mapping[str, tuple[Metres, ...]] = field(default_factory=dict)
    place_errors: Mapping[str, Metres] = field(default_factory=dict)


@dataclass(frozen=True)
class ModeShape:
    """How bodies move in a mode: Re((positions + i quarter) exp((growth_rate + i frequency) t)).

    The largest change of a position is 1, or of an angle where no centre moves.

    Attributes
    ----------
    positions, angles : mapping
        Changes of centres of mass, and in the plane of angles, for each metre (or radian) of the largest.
    positions_quarter, angles_quarter : mapping or None
        What moves a quarter of a period apart; None where all moves in phase.
    error : float
        Of all of them.
    """

    positions: Mapping[str, tuple[float, ...]]
    angles: Mapping[str, float]
    positions_quarter: Mapping[str, tuple[float, ...]] | None
    angles_quarter: Mapping[str, float] | None
    error: float


@dataclass(frozen=True)
class EquilibriumErrors:
    """Errors of positions, as the lengths of vectors (m), and of angles (rad), by body."""

    positions: Mapping[str, float]
    angles: Mapping[str, float]


@dataclass(frozen=True)
class Equilibrium:
    """A place where the scene can rest.

    Attributes
    ----------
    positions : mapping of str to tuple of float
        Centres of mass.
    angles : mapping of str to float
        In the plane, of bodies whose direction matters.
    stable : bool or None
        Whether small deviations stay small; None where the linear motion does not decide.
    modes : tuple of SmallMotion
    residual : float
        Largest force left over, relative to the forces of the scene.
    errors : EquilibriumErrors
        Of positions and angles.
    shapes : tuple of ModeShape or None
        Of the modes, in their order; None of those whose roots coincide, and of such as no column shows.
    continuum : bool
        Whether it is one of a line or surface of places of rest, of which the others are left out.
    """

    positions: Mapping[str, tuple[float, ...]]
    angles: Mapping[str, float]
    stable: bool | None
    modes: tuple[SmallMotion, ...]
    residual: float
    errors: EquilibriumErrors
    shapes: tuple[ModeShape | None, ...] = ()
    continuum: bool = False


@dataclass(frozen=True)
class MotionPhase:
    """A time in which no contact, stop or string changes its state.

    Attributes
    ----------
    end : float or None
        null for the last.
    coordinates : int
        Coordinates that remain.
    states : mapping of str to str
        By contact, stop or string: open, closed, stick, slide, slide back.
    errors : mapping of str to float or None
        Of the start and the end (s).
    """

    start: Seconds
    end: Seconds | None
    model: str
    why: str
    degrees_of_freedom: int
    coordinates: int
    states: Mapping[str, str]
    errors: Mapping[str, Annotated[float | None, Unit("s")]]


@dataclass(frozen=True)
class SceneProblem:
    """Something that mechanics does not decide, or that is not followed any further: the motion ends there.

    Attributes
    ----------
    code : str
        One of `core.multibody.undecided`.
    connections : tuple of str
        Between which it is undecided.
    candidates : tuple of mapping
        What is possible.
    decided_by : str
        Which further assumption would decide it.
    error : float
        Of the time (s).
    """

    code: Code
    explanation: str
    time: Seconds
    connections: tuple[str, ...]
    candidates: tuple[Mapping[str, str], ...]
    decided_by: str
    error: Seconds


@dataclass(frozen=True)
class RestEnd:
    """One end of the range of a number in which a scene stays at rest.

    Attributes
    ----------
    beyond : mapping of str to str, or None
        What the contacts that touch do just beyond; null where rest lasts up to the bound.
    problem : str or None
        Code of what is undecided just beyond.
    """

    value: OwnUnit
    error: OwnUnit
    beyond: Mapping[str, str] | None
    problem: str | None


@dataclass(frozen=True)
class RestRange:
    """In which range of a number a scene stays at rest.

    Attributes
    ----------
    vary : str
        JSON pointer of the number.
    unit : str or None
        In which it is written, and in which the ends of the range are; None where that is not known, as of a
        plain number of `let` that formulas use: it is in the SI unit of its use.
    written : float
        Its value in the scene.
    lower, upper : RestEnd or None
        null where the scene does not rest as it is written.
    reason : str or None
        Why they are null.
    error : float
        Of the written value as a double.
    """

    vary: str
    unit: str | None
    written: OwnUnit
    lower: RestEnd | None
    upper: RestEnd | None
    reason: str | None
    error: OwnUnit


@dataclass(frozen=True)
class SceneSolution:
    """The answer to a question about a scene; what was not requested is None."""

    model: SceneModel
    accelerations: Mapping[str, BodyAcceleration] | None
    forces: Mapping[str, ForceAnswer] | None
    energy: Energy | None
    trajectory: Trajectory | None
    period: float | None
    period_error: float | None
    equilibria: tuple[Equilibrium, ...] | None
    events: tuple[MotionEvent, ...]
    ended: MotionEvent | None
    occurrences: tuple[Occurrence, ...] | None = None
    extremes: tuple[SceneExtremes, ...] | None = None
    phases: tuple[MotionPhase, ...] | None = None
    problem: SceneProblem | None = None
    thresholds: tuple[RestRange, ...] | None = None
    assembly: Assembly | None = None
    equations: SceneEquations | None = None
