"""Two shafts on the faces of a wedge, unwinding from the two ends of one string over its apex."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Annotated, Any, ClassVar, Literal

from core.balls import raised
from core.errors import InvalidParameter, NotApplicable
from core.notices import Notice
from core.quantities import (
    Acceleration,
    AngularRate,
    InertiaFactor,
    Length,
    LengthOrZero,
    Mass,
    Quantity,
    Slope,
    Velocity,
    check,
)
from core.scenes.bounces import as_answered
from core.scenes.enclosure import ZERO, Ball, exact, exact_pair, sign
from core.scenes.figures import SceneExample, outputs_of
from core.scenes.friction import Friction, with_friction
from core.scenes.motion import NamedSceneMotion
from core.scenes.named_scene import NamedScene
from core.scenes.shaft_figures import ShaftFigures, ShaftSamples
from core.scenes.string_phases import Law, Limit, follow, settled
from core.scenes.string_samples import ShaftMotion
from core.scenes.string_state import Constants, Drive, State, frictionless
from core.systems.system import Model

_GIVEN: Mapping[str, Any] = {"masses": [2.0, 1.0], "radii": [0.1, 0.2], "slopes": [0.5, 0.9], "gravity": 9.81}
Restitution = Annotated[float, Quantity("1", at_least=0, at_most=1)]


@dataclass(frozen=True)
class UnwindingShafts(NamedScene):
    """Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound.

    Attributes
    ----------
    masses : tuple of float
        Of the shafts (kg).
    radii : tuple of float
        Of the shafts, at which the string is wound (m).
    slopes : tuple of float
        Angles of the faces below the horizontal (rad).
    gravity : float
        Acceleration of free fall (m/s^2).
    inertia_factors : tuple of float
        Moment about the axis over mass times radius squared: 1/2 solid, 1 a thin tube.
    positions : tuple of float, optional
        Distances of the shafts from the apex, down their slopes; needed for a motion (m).
    velocities : tuple of float
        Down the slopes (m/s).
    spins : tuple of float
        Rates of rotation, positive if the string unwinds (rad/s).
    wound : tuple of float, optional
        Lengths of string still on the shafts; without it the string has no end (m).
    slope_lengths : tuple of float, optional
        Without it the slopes have no end (m).
    restitution : float
        Of a jerk along the string: 0 leaves it taut.
    friction : Friction, optional
        Without it the slopes are smooth.
    """

    masses: tuple[Mass, Mass]
    radii: tuple[Length, Length]
    slopes: tuple[Slope, Slope]
    gravity: Acceleration
    inertia_factors: tuple[InertiaFactor, InertiaFactor] = (0.5, 0.5)
    positions: tuple[LengthOrZero, LengthOrZero] | None = None
    velocities: tuple[Velocity, Velocity] = (0.0, 0.0)
    spins: tuple[AngularRate, AngularRate] = (0.0, 0.0)
    wound: tuple[LengthOrZero, LengthOrZero] | None = None
    slope_lengths: tuple[Length, Length] | None = None
    restitution: Restitution = 0.0
    friction: Friction | None = None
    kind: Literal["unwinding-shafts"] = "unwinding-shafts"

    figures_type: ClassVar[type] = ShaftFigures
    samples_type: ClassVar[type] = ShaftSamples
    outputs: ClassVar[tuple[str, ...]] = outputs_of(ShaftFigures)
    of_motion: ClassVar[tuple[str, ...]] = ("phases",)
    examples: ClassVar[Mapping[str, SceneExample]] = {
        "tension": SceneExample(
            "the tension and accelerations of two solid shafts",
            {**_GIVEN, "outputs": ["tension", "accelerations", "angular_accelerations"]},
        ),
        "motion": SceneExample(
            "the motion until the string of one shaft has unwound",
            {**_GIVEN, "positions": [1.0, 1.5], "wound": [0.5, 0.8], "times": {"start": 0.0, "stop": 2.0, "count": 21}},
        ),
    }

    def __post_init__(self) -> None:
        check(self)
        for i in (0, 1):
            if self.friction is not None and self.inertia_factors[i] == 0:
                raise InvalidParameter(
                    ("inertia_factors", i),
                    "be greater than 0 where there is friction",
                    remedy="a shaft without inertia about its axis cannot resist friction: leave friction out",
                )
            at, length = self.positions, self.slope_lengths
            if at is not None and length is not None and at[i] > length[i]:
                raise InvalidParameter(("positions", i), f"be at most the length {float(length[i]):g} m of its slope")

    def figures(self) -> Mapping[str, Callable[[], Any]]:
        """Return forces and accelerations right after t = 0 (after the jerk, if the string is jerked then)."""
        return {
            "tension": lambda: self._drive.tension,
            "tension_range": lambda: self._drive.tension_range,
            "accelerations": lambda: self._drive.positions,
            "angular_accelerations": self._angular_accelerations,
            "string_acceleration": self._string_acceleration,
            "reduced_masses": lambda: self._constants.effective,
            "normal_forces": lambda: self._constants.normal_forces,
            "friction_forces": lambda: None if self.friction is None else self._drive.friction,
            "energy": self._energy,
        }

    @property
    def has_motion(self) -> bool:
        """Whether positions are given and the spins determined."""
        return self.positions is not None and any(self.inertia_factors)

    def motion(self, horizon: float) -> ShaftMotion:
        """Return the motion from the given state to the event that ends it, or past the horizon (s)."""
        if self.positions is None:
            raise InvalidParameter("positions", "be given when a motion is requested")
        if not self._constants.determinate:
            raise NotApplicable(
                "with two shafts without inertia nothing fixes how fast each of them spins",
                path=("inertia_factors",),
                remedy="give one of the shafts an inertia factor above 0",
            )
        phases = follow(
            self._constants,
            self._given,
            restitution=self.restitution,
            limits=self._limits(),
            law=self._law,
            slip=self.friction is not None,
            horizon=horizon,
        )
        largest = {
            "positions": max(self.positions),
            "velocities": max(map(abs, self.velocities)),
            "spins": max(map(abs, self.spins)),
        }
        return ShaftMotion(phases, self.radii, largest, float(self._unresolved))

    def motion_figures(self, motion: NamedSceneMotion) -> Mapping[str, Callable[[], Any]]:
        """Return the phases: kind, start, end, and the impulse, number and cost of their jerks."""
        assert isinstance(motion, ShaftMotion)
        return {
            "phases": lambda: [
                {
                    "kind": phase.drive.kind,
                    "start": phase.start.time,
                    "end": phase.ends,
                    "impulse": phase.impulse,
                    "jerks": as_answered(phase.jerks),
                    "dissipated": phase.dissipated,
                }
                for phase in motion.phases.phases
            ]
        }

    def inexact(self, motion: Any) -> NotApplicable | None:
        """Return the fault of velocities that fit a taut string only to rounding, and of jerks too weak to be seen."""
        slips = [
            Fraction(v) - Fraction(r) * Fraction(w)
            for v, r, w in zip(self.velocities, self.radii, self.spins, strict=True)
        ]
        pairs = [(sum(slips), self._given.opening)]
        if self.friction is not None:
            pairs += list(zip(slips, self._given.slips, strict=True))
        if sign(motion.phases.cut) > 0 or any(exactly != 0 and sign(ball) == 0 for exactly, ball in pairs):
            return NotApplicable(
                "velocities and spins agree with a taut string only to rounding, or jerks become too weak to be told "
                "apart",
                path=("digits",),
                remedy='give velocities and spins that agree exactly, if need be as decimal strings ("0.1")',
            )
        return None

    def static_model(self) -> Model:
        """Return the model of a question about one instant."""
        return Model("two unwinding shafts on one string", "one instant", "no motion was requested", 0)

    def notices(self, wanted: frozenset[str]) -> tuple[Notice, ...]:
        """Return what is not determined."""
        found = []
        if "angular_accelerations" in wanted and not self._constants.determinate:
            found.append(
                Notice(
                    "indeterminate",
                    "with two shafts without inertia nothing fixes how fast each of them spins up",
                )
            )
        if "tension" in wanted and self._drive.tension is None:
            found.append(Notice("indeterminate", "both shafts stick: only tension plus friction is fixed"))
        return tuple(found)

    @cached_property
    def _constants(self) -> Constants:
        g = exact(self.gravity)
        m1, m2 = exact_pair(self.masses)
        a, b = exact_pair(self.slopes)
        return Constants(
            (m1, m2),
            exact_pair(self.radii),
            exact_pair(self.inertia_factors),
            (g * a.sin(), g * b.sin()),
            (m1 * g * a.cos(), m2 * g * b.cos()),
        )

    @cached_property
    def _differences(self) -> tuple[tuple[Ball, Ball], tuple[Ball, Ball]]:
        """Slip of each line of contact, and the size of its terms."""
        (v1, v2), (w1, w2), (r1, r2) = exact_pair(self.velocities), exact_pair(self.spins), exact_pair(self.radii)
        return (v1 - r1 * w1, v2 - r2 * w2), (abs(v1) + abs(r1 * w1), abs(v2) + abs(r2 * w2))

    @cached_property
    def _given(self) -> State:
        (u1, u2), (n1, n2) = self._differences
        opening = settled(-u1 - u2, n1 + n2)
        slips = (settled(u1, n1), settled(u2, n2)) if self.friction is not None else (u1, u2)
        (w1, w2), (r1, r2) = exact_pair(self.spins), exact_pair(self.radii)
        positions = exact_pair(self.positions or (0.0, 0.0))
        return State(
            ZERO, positions, exact_pair(self.velocities), (ZERO, ZERO), (r1 * w1, r2 * w2), ZERO, opening, slips
        )

    @property
    def _unresolved(self) -> Ball:
        """What was taken as zero though it is not."""
        (u1, u2), _ = self._differences
        lost = abs(u1 + u2) if sign(self._given.opening) == 0 else ZERO
        for u, kept in zip((u1, u2), self._given.slips, strict=True):
            lost = lost + (abs(u) if sign(kept) == 0 else ZERO)
        return lost

    @property
    def _law(self) -> Law:
        if self.friction is None:
            return frictionless
        friction = self.friction
        return lambda constants, state: with_friction(friction, constants, state)

    @cached_property
    def _drive(self) -> Drive:
        state = self._given
        if sign(state.opening) < 0 and self._constants.determinate:
            state = state.after_impulse(self._constants, -state.opening, exact(self.restitution))
        if not self._constants.determinate:
            # No inertia takes part in the pull on the string, so there is none; how the string moves stays open.
            return Drive("taut", ZERO, self._constants.slope_accelerations, (ZERO, ZERO))
        return self._law(self._constants, state)

    def _angular_accelerations(self) -> tuple[Ball, Ball] | None:
        if not self._constants.determinate:
            return None
        (b1, b2), (r1, r2) = self._drive.unwound, self._constants.radii
        return b1 / r1, b2 / r2

    def _string_acceleration(self) -> Ball | None:
        """Return the acceleration of the string towards shaft 1, None while it is slack."""
        if self._drive.kind == "slack" or not self._constants.determinate:
            return None
        return self._drive.slips[0]

    def _energy(self) -> Mapping[str, Ball]:
        """Return the energies of the given state, heights from the apex."""
        kinetic, potential = ZERO, ZERO
        state, positions = self._given, exact_pair(self.positions or (0.0, 0.0))
        for i in (0, 1):
            mass, factor = self._constants.masses[i], self._constants.factors[i]
            kinetic = kinetic + mass * (raised(state.velocities[i], 2) + factor * raised(state.rates[i], 2)) / 2
            potential = potential - mass * self._constants.slope_accelerations[i] * positions[i]
        return {"kinetic": kinetic, "potential": potential, "total": kinetic + potential}

    def _limits(self) -> tuple[Limit, ...]:
        limits = []
        for i in (0, 1):
            limits.append(Limit(f"shaft-{i + 1}-at-apex", i, "positions", 1, ZERO))
            if self.wound is not None:
                limits.append(Limit(f"string-{i + 1}-unwound", i, "unwound", -1, exact(self.wound[i])))
            if self.slope_lengths is not None:
                limits.append(Limit(f"shaft-{i + 1}-at-slope-end", i, "positions", -1, exact(self.slope_lengths[i])))
        return tuple(limits)
