"""What two unwinding shafts answer: figures, phases, and the columns of their motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Generic, Literal

from core.quantities import Unit
from core.scenes.figures import Errors, MechanicalEnergy, N, Pair


@dataclass(frozen=True)
class ShaftPhase(Generic[N]):
    """A time in which the accelerations are constant but for jerks.

    Attributes
    ----------
    kind : {"taut", "slack", "stick"}
        State of the string, or both shafts sticking.
    start, end : number
        Measured from the given state; the end is null if nothing ends the phase.
    impulse : number or None
        Of its jerks along the string; null for infinitely many that do not accumulate.
    jerks : int or None
        How many, the one that began it included; null for infinitely many.
    dissipated : number
        Energy that its jerks cost.
    errors : mapping or None
        Bounds of the errors; left out where every digit is proven.
    """

    kind: Literal["taut", "slack", "stick"]
    start: Annotated[N, Unit("s")] | None
    end: Annotated[N, Unit("s")] | None
    impulse: Annotated[N, Unit("N s")] | None
    jerks: int | None
    dissipated: Annotated[N, Unit("J")] | None
    errors: Errors | None = None


@dataclass(frozen=True)
class ShaftFigures(Generic[N]):
    """What two unwinding shafts answer; forces and accelerations are those right after t = 0.

    Attributes
    ----------
    tension : number or None
        Of the string; null where nothing determines it.
    tension_range : pair of numbers or None
        Least and largest tension that sticking shafts admit; null where the tension is determined.
    accelerations : pair of numbers
        Of the shafts down their slopes.
    angular_accelerations : pair of numbers or None
        Of the shafts, positive if the string unwinds; null where nothing determines them.
    string_acceleration : number or None
        Of the string towards shaft 1; null while it is slack.
    reduced_masses : pair of numbers
        Mass with which each shaft resists the tension.
    normal_forces : pair of numbers
        Of the slopes on the shafts.
    friction_forces : pair of numbers or None
        Of the slopes on the shafts, up the slope; null without friction.
    energy : energies
        Of the given state, heights from the apex.
    phases : list of ShaftPhase
        Of the motion, in order.
    """

    tension: Annotated[N, Unit("N")] | None
    tension_range: Annotated[Pair[N | None], Unit("N")] | None
    accelerations: Annotated[Pair[N | None], Unit("m s^-2")]
    angular_accelerations: Annotated[Pair[N | None], Unit("rad s^-2")] | None
    string_acceleration: Annotated[N, Unit("m s^-2")] | None
    reduced_masses: Annotated[Pair[N | None], Unit("kg")]
    normal_forces: Annotated[Pair[N | None], Unit("N")]
    friction_forces: Annotated[Pair[N | None], Unit("N")] | None
    energy: MechanicalEnergy[N]
    phases: list[ShaftPhase[N]]


@dataclass(frozen=True)
class ShaftSamples(Generic[N]):
    """Samples of the shafts' motion: one entry for each time.

    Attributes
    ----------
    time : array
        Measured from the given state, up to the end of the motion.
    positions : array of pairs
        Distances from the apex, down the slopes.
    velocities : array of pairs
        Down the slopes.
    spins : array of pairs
        Rates of rotation, positive if the string unwinds.
    unwound : array of pairs
        Length of string unwound from each shaft since t = 0.
    tension : array
        Of the string; left out where nothing determines it.
    """

    time: Annotated[list[N], Unit("s")]
    positions: Annotated[list[Pair[N]], Unit("m")]
    velocities: Annotated[list[Pair[N]], Unit("m s^-1")]
    spins: Annotated[list[Pair[N]], Unit("rad s^-1")]
    unwound: Annotated[list[Pair[N]], Unit("m")]
    tension: Annotated[list[N], Unit("N")] | None = None
