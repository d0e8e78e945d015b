"""A heavy rod that slides inside a smooth cylindrical hole, both ends on the wall."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Annotated, Any, ClassVar, Generic, Literal

from core.balls import precision, raised
from core.errors import InvalidParameter
from core.quantities import RADIANS, Acceleration, AngularRate, InertiaFactor, Length, Mass, Quantity, Unit, check
from core.scenes.enclosure import BITS, Ball, Balls, angle_of, exact
from core.scenes.figures import Errors, MechanicalEnergy, N, Pair, SceneExample, outputs_of
from core.scenes.motion import NamedSceneMotion
from core.scenes.named_scene import NamedScene
from core.scenes.pendulum import Pendulum
from core.scenes.rod_motion import Rod, RodMotion, contact_limits
from core.systems.system import Model

HalfTurn = Annotated[float, Quantity("rad", at_least=-math.pi, at_most=math.pi)]

_GIVEN: Mapping[str, Any] = {"hole_radius": 1.0, "length": 1.0, "mass": 1.0, "gravity": 9.81}
RIM_ROUNDING = 2.0**-50
"""Part of the rim's angle within which an angle means the rim, which no double hits."""


@dataclass(frozen=True)
class Contact(Generic[N]):
    """Contact of the rod's ends with the wall.

    Attributes
    ----------
    kept : bool
        Whether both ends stay on the wall.
    limit_angle : number
        Largest angle from which a rod released at rest stays in contact.
    full_turn_rate : number
        Least rate at the bottom with which the rod goes round a whole cylinder in contact.
    errors : mapping or None
        Bounds of the errors; left out where every digit is proven.
    """

    kept: bool
    limit_angle: Annotated[N, Unit("rad")] | None
    full_turn_rate: Annotated[N, Unit("rad s^-1")] | None
    errors: Errors | None = None


@dataclass(frozen=True)
class RodFigures(Generic[N]):
    """What a rod in a hole answers.

    Attributes
    ----------
    angular_velocity_at_horizontal : number or None
        Magnitude when the rod is horizontal at the bottom; null if it does not get there.
    equivalent_length : number
        Length of the simple pendulum that swings alike.
    period : number or None
        Of the motion; null if it ends or never repeats.
    release_angle : number
        Angle at t = 0.
    forces_at_release : pair of numbers
        Of the wall on the ends A and B at t = 0, towards the axis.
    energy : energies
        Of the given state, heights from the axis.
    contact : Contact
        Whether both ends stay on the wall, and the limits of doing so.
    """

    angular_velocity_at_horizontal: Annotated[N, Unit("rad s^-1")] | None
    equivalent_length: Annotated[N, Unit("m")] | None
    period: Annotated[N, Unit("s")] | None
    release_angle: Annotated[N, Unit("rad")] | None
    forces_at_release: Annotated[Pair[N | None], Unit("N")]
    energy: MechanicalEnergy[N]
    contact: Contact[N]


@dataclass(frozen=True)
class RodSamples(Generic[N]):
    """Samples of a rod's motion: one entry for each time.

    Attributes
    ----------
    time : array
        Measured from the given state, up to the end of the motion.
    angle : array
        From the downward vertical, positive if end B is higher.
    angular_velocity : array
        Positive if end B rises.
    forces : array of pairs
        Of the wall on the ends A and B, towards the axis; left out where doubles are too coarse for them.
    """

    time: Annotated[list[N], Unit("s")]
    angle: Annotated[list[N], Unit("rad")]
    angular_velocity: Annotated[list[N], Unit("rad s^-1")]
    forces: Annotated[list[Pair[N]], Unit("N")] | None = None


@dataclass(frozen=True)
class RodInHole(NamedScene):
    """A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall.

    Angles are those of the line from the axis to the rod's centre, from the downward vertical; positive has end B
    higher.

    Attributes
    ----------
    hole_radius : float
        Radius of the hole (m).
    length : float
        Of the rod, less than the diameter of the hole (m).
    mass : float
        Of the rod (kg).
    gravity : float
        Acceleration of free fall (m/s^2).
    angle : float, optional
        At t = 0. By default end A is at the left rim, which is a negative angle (rad).
    angular_velocity : float
        At t = 0, positive if end B rises (rad/s).
    inertia_factor : float
        Moment about the centre over mass times length squared: 1/12 for a uniform rod, 1/4 with all mass at the ends.
    hole : {"half-cylinder", "cylinder"}
        Whether the wall ends at a rim at the height of the axis, or goes all the way round.
    """

    hole_radius: Length
    length: Length
    mass: Mass
    gravity: Acceleration
    angle: HalfTurn | None = None
    angular_velocity: AngularRate = 0.0
    inertia_factor: InertiaFactor = 1 / 12
    hole: Literal["half-cylinder", "cylinder"] = "half-cylinder"
    kind: Literal["rod-in-hole"] = "rod-in-hole"

    figures_type: ClassVar[type] = RodFigures
    samples_type: ClassVar[type] = RodSamples
    outputs: ClassVar[tuple[str, ...]] = outputs_of(RodFigures)
    of_motion: ClassVar[tuple[str, ...]] = ("angular_velocity_at_horizontal", "period", "contact")
    functions: ClassVar[Literal["elementary", "elliptic"]] = "elliptic"
    exact_defaults: ClassVar[Mapping[str, Fraction]] = {"inertia_factor": Fraction(1, 12)}
    examples: ClassVar[Mapping[str, SceneExample]] = {
        "horizontal": SceneExample(
            "how fast the rod turns when it is horizontal",
            {**_GIVEN, "outputs": ["angular_velocity_at_horizontal", "period", "contact"]},
        ),
        "motion": SceneExample(
            "one swing with the forces of the wall", {**_GIVEN, "times": {"start": 0.0, "stop": 2.0, "count": 21}}
        ),
    }
    # A rod that comes to rest upright, and never arrives.
    warming: ClassVar[tuple[Mapping[str, Any], ...]] = (
        {
            "hole_radius": 5.0,
            "length": 6.0,
            "mass": 1.0,
            "gravity": 25.0,
            "inertia_factor": 0.25,
            "hole": "cylinder",
            "angle": 0.0,
            "angular_velocity": 4.0,
            "times": [1.0],
        },
    )

    def __post_init__(self) -> None:
        check(self)
        if self.hole not in ("half-cylinder", "cylinder"):
            raise InvalidParameter("hole", "be 'half-cylinder' or 'cylinder'")
        if self.length >= 2 * self.hole_radius:
            raise InvalidParameter("length", f"be less than the diameter {float(2 * self.hole_radius):g} m of the hole")
        if self.angle is not None and self.hole == "half-cylinder":
            with precision(BITS):
                rim = self._rim_angle
                if abs(exact(self.angle)) > rim * (1 + exact(RIM_ROUNDING)):
                    raise InvalidParameter(
                        "angle",
                        f"lie within {float(rim):.17g} rad of the vertical, where an end reaches the rim",
                        remedy=f"let the hole be a whole cylinder; {RADIANS}",
                    )

    def figures(self) -> Mapping[str, Callable[[], Any]]:
        """Return the figures of the given state."""
        return {
            "equivalent_length": lambda: self._rod.inertia / self._rod.depth,
            "release_angle": self._release_angle,
            "forces_at_release": lambda: self._rod.forces(*self._whole, exact(self.angular_velocity)),
            "energy": self._energy,
        }

    def motion(self, horizon: float) -> RodMotion:
        """Return the motion until an end passes the rim or leaves the wall."""
        return RodMotion(self._rod, self._pendulum, self._rim if self.hole == "half-cylinder" else None)

    def motion_figures(self, motion: NamedSceneMotion) -> Mapping[str, Callable[[], Any]]:
        """Return the rate at the horizontal, the period and the contact with the wall."""
        assert isinstance(motion, RodMotion)
        return {
            "angular_velocity_at_horizontal": motion.rate_at_horizontal,
            "period": lambda: motion.pendulum.period if motion.end is None else None,
            "contact": lambda: self._contact(motion),
        }

    def static_model(self) -> Model:
        """Return the model of a question about one instant."""
        return Model("rod in a cylindrical hole", "one instant", "no motion was requested", 0)

    @cached_property
    def _rod(self) -> Rod:
        radius, length = exact(self.hole_radius), exact(self.length)
        depth = ((2 * radius - length) * (2 * radius + length)).sqrt() / 2
        return Rod(radius, length, exact(self.mass), exact(self.gravity), exact(self.inertia_factor), depth)

    @property
    def _rim(self) -> Balls:
        """Sine and cosine of half the angle at which an end is at the rim: the cosine of the whole is l/2a."""
        diameter, length = 2 * exact(self.hole_radius), exact(self.length)
        return ((diameter - length) / (2 * diameter)).sqrt(), ((diameter + length) / (2 * diameter)).sqrt()

    @property
    def _rim_angle(self) -> Ball:
        s, c = self._rim
        return 2 * angle_of(s, c)

    @cached_property
    def _half(self) -> Balls:
        """Sine and cosine of half the given angle."""
        s, c = self._rim
        if self.angle is None:
            return -s, c
        if self._at_rim:
            return (s if self.angle > 0 else -s), c
        half = exact(self.angle) / 2
        return half.sin(), half.cos()

    @property
    def _at_rim(self) -> bool:
        rim = self._rim_angle
        return self.angle is None or bool(abs(abs(exact(self.angle)) - rim) <= rim * exact(RIM_ROUNDING))

    @property
    def _whole(self) -> Balls:
        """Sine and cosine of the given angle; at the rim k/a and l/2a, without the cancellation of short rods."""
        if self._at_rim:
            way = 1 if self.angle is not None and self.angle > 0 else -1
            return way * self._rod.depth / self._rod.radius, self._rod.length / (2 * self._rod.radius)
        angle = exact(self.angle or 0.0)
        return angle.sin(), angle.cos()

    @cached_property
    def _pendulum(self) -> Pendulum:
        return Pendulum(self._rod.frequency, *self._half, exact(self.angular_velocity))

    def _release_angle(self) -> Ball:
        return -self._rim_angle if self.angle is None else exact(self.angle)

    def _energy(self) -> Mapping[str, Ball]:
        """Return the energies of the given state, heights from the axis."""
        rod = self._rod
        kinetic = rod.mass * rod.inertia * raised(exact(self.angular_velocity), 2) / 2
        potential = -rod.mass * rod.gravity * rod.depth * self._whole[1]
        return {"kinetic": kinetic, "potential": potential, "total": kinetic + potential}

    def _contact(self, motion: RodMotion) -> Mapping[str, Any]:
        """Return whether both ends stay on the wall, and the limits of doing so.

        `limit_angle` is the largest angle from which a rod released at rest keeps contact, `full_turn_rate` the least
        rate at the bottom with which it goes round a whole cylinder without losing it.
        """
        limit, rate = contact_limits(self._rod)
        kept = motion.end is None or not motion.end.kind.endswith("leaves-wall")
        return {"kept": kept, "limit_angle": limit, "full_turn_rate": rate}
