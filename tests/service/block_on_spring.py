"""A named scene that is not in the catalogue: all that it takes is this file, and a place in a list."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any, ClassVar, Generic, Literal

import numpy as np

from core.arrays import Floats
from core.quantities import Length, Mass, Quantity, Unit, Velocity, check
from core.scenes.enclosure import Ball, exact
from core.scenes.equation import AcceleratedCoordinate, SceneEquation
from core.scenes.figures import MechanicalEnergy, N, SceneExample, outputs_of
from core.scenes.motion import UnbrokenMotion
from core.scenes.named_scene import NamedScene
from core.systems.system import Model
from service.routes import questions
from service.routes.scenes import members
from service.routing import PostRoute

Stiffness = Annotated[float, Quantity("N m^-1", above=0)]


@dataclass(frozen=True)
class SpringFigures(Generic[N]):
    """What a block on a spring answers.

    Attributes
    ----------
    period : number
        Of the oscillation.
    energy : energies
        Of the given state.
    """

    period: Annotated[N, Unit("s")] | None
    energy: MechanicalEnergy[N]


@dataclass(frozen=True)
class SpringSamples(Generic[N]):
    """Samples of the block: one entry for each time.

    Attributes
    ----------
    time : array
        Measured from the given state.
    position : array
        From where the spring is relaxed.
    velocity : array
        Of the block.
    """

    time: Annotated[list[N], Unit("s")]
    position: Annotated[list[N], Unit("m")]
    velocity: Annotated[list[N], Unit("m s^-1")]


class Oscillation(UnbrokenMotion):
    """x = x0 cos wt + (v0/w) sin wt."""

    model = Model("block on a spring", "harmonic", "the force is proportional to the distance", 1)

    def __init__(self, rate: Ball, position: Ball, velocity: Ball) -> None:
        super().__init__(None, lambda: None)
        self.rate, self.position, self.velocity = rate, position, velocity

    def at(self, time: Ball) -> Mapping[str, Any]:
        sine, cosine = (self.rate * time).sin_cos()
        return {
            "position": self.position * cosine + self.velocity / self.rate * sine,
            "velocity": self.velocity * cosine - self.position * self.rate * sine,
        }

    def equation(self) -> SceneEquation:
        position = AcceleratedCoordinate(self.position, self.velocity, slope=-(self.rate**2))
        return SceneEquation((position,), self.model)

    def states(self, columns: Mapping[str, Floats]) -> Floats:
        return np.stack((columns["position"], columns["velocity"]), axis=1)

    def observed(self, states: Floats) -> Mapping[str, Floats]:
        return {"position": states[:, 0], "velocity": states[:, 1]}


@dataclass(frozen=True)
class BlockOnSpring(NamedScene):
    """A block on a level, smooth table, held by a spring.

    Attributes
    ----------
    mass : float
        Of the block (kg).
    stiffness : float
        Of the spring (N/m).
    position : float
        From where the spring is relaxed (m).
    velocity : float
        At t = 0 (m/s).
    """

    mass: Mass
    stiffness: Stiffness
    position: Length
    velocity: Velocity = 0.0
    kind: Literal["block-on-spring"] = "block-on-spring"

    figures_type: ClassVar[type] = SpringFigures
    samples_type: ClassVar[type] = SpringSamples
    outputs: ClassVar[tuple[str, ...]] = outputs_of(SpringFigures)
    examples: ClassVar[Mapping[str, SceneExample]] = {
        "motion": SceneExample(
            "one oscillation",
            {"mass": 2.0, "stiffness": 8.0, "position": 0.1, "times": {"start": 0.0, "stop": 3.0, "count": 7}},
        )
    }

    def __post_init__(self) -> None:
        check(self)

    @cached_property
    def _rate(self) -> Ball:
        return (exact(self.stiffness) / exact(self.mass)).sqrt()

    def figures(self) -> Mapping[str, Callable[[], Any]]:
        return {"period": lambda: 2 * self._rate.pi() / self._rate, "energy": self._energy}

    def motion(self, horizon: float) -> Oscillation:
        return Oscillation(self._rate, exact(self.position), exact(self.velocity))

    def static_model(self) -> Model:
        return Model("block on a spring", "one instant", "no motion was requested", 0)

    def _energy(self) -> Mapping[str, Ball]:
        kinetic = exact(self.mass) * exact(self.velocity) ** 2 / 2
        potential = exact(self.stiffness) * exact(self.position) ** 2 / 2
        return {"kinetic": kinetic, "potential": potential, "total": kinetic + potential}


def table() -> tuple[PostRoute, ...]:
    """Return the route table of a service that has this scene too."""
    return questions((*members(), BlockOnSpring))
