"""What every named scene declares about its answers: the kind of number, outputs, energies, events, examples."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Annotated, Any, Generic, TypeVar

from core.quantities import Unit

MOTION = ("events", "ended", "trajectory")
"""Outputs that need the motion, in every scene."""

N = TypeVar("N")
"""Kind of number in which an answer is written: doubles, or decimal strings."""
Pair = tuple[N, N]


@dataclass(frozen=True)
class SceneEvent(Generic[N]):
    """Something that happens at an instant.

    Attributes
    ----------
    kind : str
        What happens; an event that ends the motion is also named by `ended`.
    time : number
        Measured from the given state.
    """

    kind: str
    time: Annotated[N, Unit("s")] | None


@dataclass(frozen=True)
class MechanicalEnergy(Generic[N]):
    """Energy of the given state.

    Attributes
    ----------
    kinetic : number
        Of translation and rotation.
    potential : number
        Zero at the height that the scene measures heights from.
    total : number
        Their sum.
    """

    kinetic: Annotated[N, Unit("J")] | None
    potential: Annotated[N, Unit("J")] | None
    total: Annotated[N, Unit("J")] | None


@dataclass(frozen=True)
class SceneExample:
    """A question about a scene: its parameters, `times` and `outputs`, and what it shows."""

    summary: str
    question: Mapping[str, Any]


def outputs_of(figures: type) -> tuple[str, ...]:
    """Return the names of everything that can be requested of a scene with such figures."""
    return (*(entry.name for entry in fields(figures)), *MOTION)
