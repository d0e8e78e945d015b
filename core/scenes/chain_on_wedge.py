"""A heavy chain with a mass at each end, over the apex of a smooth wedge."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any, ClassVar, Generic, Literal

from core.balls import raised
from core.errors import InvalidParameter
from core.quantities import Acceleration, Length, LengthOrZero, Quantity, Slope, Unit, Velocity, check
from core.scenes.chain_motion import ChainMotion, Slide
from core.scenes.enclosure import ZERO, Ball, exact, exact_pair, sign
from core.scenes.figures import MechanicalEnergy, N, SceneExample, outputs_of
from core.scenes.motion import NamedSceneMotion
from core.scenes.named_scene import NamedScene
from core.systems.system import Model

EndMass = Annotated[float, Quantity("kg", at_least=0)]
LinearDensity = Annotated[float, Quantity("kg m^-1", at_least=0)]


@dataclass(frozen=True)
class LiftOff(Generic[N]):
    """Whether the chain leaves the apex.

    Attributes
    ----------
    occurs : bool
        Whether it does, in the motion from the given state.
    time : number or None
        When; null if it does not.
    error : float or None
        Bound of the error of the time; left out where every digit is proven.
    """

    occurs: bool
    time: Annotated[N, Unit("s")] | None
    error: Annotated[float, Unit("s")] | None = None


@dataclass(frozen=True)
class ChainFigures(Generic[N]):
    """What a chain on a wedge answers.

    Attributes
    ----------
    acceleration : number
        Of mass 1 down its face, in the given state.
    apex_tension : number
        Tension of the chain at the apex, in the given state.
    growth_rate : number
        Rate at which a displacement from equilibrium grows; zero for a massless string.
    equilibrium : number or None
        Length of chain on face 1 in equilibrium; null where there is none.
    energy : energies
        Of the given state, heights from the apex.
    lift_off : LiftOff
        Whether and when the chain leaves the apex.
    """

    acceleration: Annotated[N, Unit("m s^-2")] | None
    apex_tension: Annotated[N, Unit("N")] | None
    growth_rate: Annotated[N, Unit("s^-1")] | None
    equilibrium: Annotated[N, Unit("m")] | None
    energy: MechanicalEnergy[N]
    lift_off: LiftOff[N]


@dataclass(frozen=True)
class ChainSamples(Generic[N]):
    """Samples of a chain's motion: one entry for each time.

    Attributes
    ----------
    time : array
        Measured from the given state, up to the end of the motion.
    position : array
        Length of chain on face 1.
    velocity : array
        Of mass 1 down its face.
    apex_tension : array
        Tension at the apex; left out where doubles are too coarse for it.
    """

    time: Annotated[list[N], Unit("s")]
    position: Annotated[list[N], Unit("m")]
    velocity: Annotated[list[N], Unit("m s^-1")]
    apex_tension: Annotated[list[N], Unit("N")] | None = None


@dataclass(frozen=True)
class ChainOnWedge(NamedScene):
    """An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end.

    Attributes
    ----------
    masses : tuple of float
        At the ends; zero for a bare end (kg).
    slopes : tuple of float
        Angles of the faces below the horizontal (rad).
    gravity : float
        Acceleration of free fall (m/s^2).
    length : float
        Of the whole chain (m).
    linear_density : float
        Zero for a massless string, Atwood's machine (kg/m).
    position : float
        Length of chain on face 1, where mass 1 is (m).
    velocity : float
        Of mass 1 down its face (m/s).
    """

    masses: tuple[EndMass, EndMass]
    slopes: tuple[Slope, Slope]
    gravity: Acceleration
    length: Length
    linear_density: LinearDensity
    position: LengthOrZero
    velocity: Velocity = 0.0
    kind: Literal["chain-on-wedge"] = "chain-on-wedge"

    figures_type: ClassVar[type] = ChainFigures
    samples_type: ClassVar[type] = ChainSamples
    outputs: ClassVar[tuple[str, ...]] = outputs_of(ChainFigures)
    of_motion: ClassVar[tuple[str, ...]] = ("lift_off",)
    examples: ClassVar[Mapping[str, SceneExample]] = {
        "motion": SceneExample(
            "a heavy chain that slides over the apex",
            {
                "masses": [1.0, 1.2],
                "slopes": [0.6, 0.8],
                "gravity": 9.81,
                "length": 2.0,
                "linear_density": 0.5,
                "position": 1.0,
                "velocity": 0.0,
                "times": {"start": 0.0, "stop": 0.5, "count": 11},
            },
        )
    }

    def __post_init__(self) -> None:
        check(self)
        if self.position > self.length:
            raise InvalidParameter("position", f"be at most the length {float(self.length):g} m of the chain")
        if not any((*self.masses, self.linear_density)):
            raise InvalidParameter("masses", "not all be 0 where the chain has no mass either")

    def figures(self) -> Mapping[str, Callable[[], Any]]:
        """Return acceleration, tension and energy of the given state, and the constants of the motion."""
        return {
            "acceleration": lambda: self._slide.acceleration,
            "apex_tension": lambda: self._slide.tension(self._slide.position),
            "growth_rate": lambda: self._slide.rate,
            "equilibrium": lambda: self._slide.equilibrium,
            "energy": self._energy,
        }

    def motion(self, horizon: float) -> ChainMotion:
        """Return the motion until the chain runs out or lifts off the apex."""
        return ChainMotion(self._slide)

    def motion_figures(self, motion: NamedSceneMotion) -> Mapping[str, Callable[[], Any]]:
        """Return whether and when the chain lifts off."""
        assert isinstance(motion, ChainMotion)

        def lift_off() -> Mapping[str, Any]:
            lifts = motion.end is not None and motion.end.kind == "lift-off"
            return {"occurs": lifts, "time": motion.end.time if lifts and motion.end else None}

        return {"lift_off": lift_off}

    def static_model(self) -> Model:
        """Return the model of a question about one instant."""
        return Model("heavy chain on a wedge", "one instant", "no motion was requested", 0)

    @cached_property
    def _slide(self) -> Slide:
        g, (a, b) = exact(self.gravity), exact_pair(self.slopes)
        return Slide(
            exact_pair(self.masses),
            (g * a.sin(), g * b.sin()),
            exact(self.length),
            exact(self.linear_density),
            exact(self.position),
            exact(self.velocity),
        )

    def _energy(self) -> Mapping[str, Ball]:
        """Return the energies of the given state, heights from the apex."""
        slide, (m1, m2), (a, b) = self._slide, self._slide.masses, self._slide.slope_accelerations
        x, y = slide.position, slide.length - slide.position
        kinetic = slide.mass * raised(slide.velocity, 2) / 2
        potential = -(m1 + slide.density * x / 2) * a * x - (m2 + slide.density * y / 2) * b * y
        return {
            "kinetic": kinetic if sign(kinetic) else ZERO,
            "potential": potential,
            "total": kinetic + potential,
        }
