"""What every named scene declares about its answers: the kind of number, outputs, energies, events, examples."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from typing import Annotated, Any, Generic, TypeVar, get_type_hints

from core.quantities import Unit

MOTION = ("events", "ended", "trajectory")
"""Outputs that need the motion, in every scene."""

N = TypeVar("N")
"""Kind of number in which an answer is written: doubles, or decimal strings."""
Pair = tuple[N, N]
Errors = Mapping[str, Annotated[float | list[float | None] | None, Unit("as in the field of that name")]]
"""Bounds of the errors of figures by their names, one for each entry of a pair; None where the figure is."""


@dataclass(frozen=True)
class SceneEvent(Generic[N]):
    """Something that happens at an instant.

    Attributes
    ----------
    kind : str
        What happens; an event that ends the motion is also named by `ended`.
    time : number
        Measured from the given state.
    error : float or None
        Bound of the error of the time; left out where every digit is proven.
    """

    kind: str
    time: Annotated[N, Unit("s")] | None
    error: Annotated[float, Unit("s")] | None = None


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
    errors : mapping or None
        Bounds of the errors; left out where every digit is proven.
    """

    kinetic: Annotated[N, Unit("J")] | None
    potential: Annotated[N, Unit("J")] | None
    total: Annotated[N, Unit("J")] | None
    errors: Errors | None = None


@dataclass(frozen=True)
class SceneExample:
    """A question about a scene: its parameters, `times` and `outputs`, and what it shows."""

    summary: str
    question: Mapping[str, Any]


def outputs_of(figures: type) -> tuple[str, ...]:
    """Return the names of everything that can be requested of a scene with such figures."""
    return (*(entry.name for entry in fields(figures)), *MOTION)


def marks_of(hint: Any) -> tuple[Any, ...]:
    """Return the marks of an annotation, at any depth."""
    inner = tuple(mark for part in getattr(hint, "__args__", ()) for mark in marks_of(part))
    return (*getattr(hint, "__metadata__", ()), *inner)


def measured_names(figures: Any) -> frozenset[str]:
    """Return the names of the numbers with units in a dataclass, and in those that its fields hold."""
    origin = getattr(figures, "__origin__", figures)
    if not is_dataclass(origin):
        return frozenset().union(*map(measured_names, getattr(figures, "__args__", ())))
    found: set[str] = set()
    for name, hint in get_type_hints(origin, include_extras=True).items():
        found |= {name} if any(isinstance(mark, Unit) for mark in marks_of(hint)) else measured_names(hint)
    return frozenset(found - {"error", "errors"})
