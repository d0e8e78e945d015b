"""The quantities of a scene that are searched, by curves that are polynomial in coordinates, rates and multipliers.

The curve whose zeros are the times at which a quantity has a value may have more zeros: the sine of an angle less the
value vanishes twice in a turn. Which of them count is decided by the value of the quantity there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Protocol

from flint import arb

from core.multibody.algebra.polynomials import ONE, Ball
from core.multibody.motion.whole import Whole
from core.multibody.search.bands import Quantity
from core.multibody.search.curves import Curve
from core.multibody.search.pieces import Pieces
from core.multibody.table.connection_effects import Force
from core.multibody.table.frames import Frame
from core.multibody.table.momenta import Terms, momenta

_NEAR_ZERO = 2.0**-20
"""Below this a component of a quaternion counts as zero where it or the first component vanishes exactly."""


class Sought(Protocol):
    """A quantity that takes values and has extremes."""

    @property
    def of_forces(self) -> bool:
        """Whether it depends on multipliers."""

    @property
    def ambiguous(self) -> bool:
        """Whether the curve may be zero where the quantity has another value."""

    @property
    def follows(self) -> Sequence[int] | None:
        """Coordinates of which it is a function; None where it may be of any."""

    def less(self, value: Ball) -> Quantity:
        """Return a curve that is zero wherever the quantity has a value."""

    def turning(self) -> Sequence[Quantity]:
        """Return a curve that is zero wherever the quantity has an extreme, and others for where it jumps."""

    def has(self, found: float, value: float) -> bool:
        """Return whether the quantity has a value where its curve is zero, given what it has there in doubles."""


@dataclass(frozen=True)
class Polynomial:
    """A quantity that is polynomial itself."""

    along: Quantity
    of_forces: bool = False
    follows: Sequence[int] | None = None
    ambiguous: bool = False

    def square(self, pieces: Pieces) -> Curve:
        """Return its square."""
        curve = self.along(pieces)
        return curve.times(curve)

    def less(self, value: Ball) -> Quantity:
        """Return the quantity less the value."""
        return partial(shifted, self.along, value)

    def turning(self) -> Sequence[Quantity]:
        """Return its derivative."""
        return [partial(_derivative, self.along)]

    def has(self, found: float, value: float) -> bool:
        """Return that it has."""
        return True


@dataclass(frozen=True)
class Length:
    """The length of a vector: its square is searched."""

    components: Sequence[Polynomial | QuaternionPart]
    of_forces: bool = False
    ambiguous: bool = True

    @property
    def follows(self) -> Sequence[int] | None:
        """Return the coordinates of its components."""
        found: list[int] = []
        for one in self.components:
            if one.follows is None:
                return None
            found.extend(one.follows)
        return found

    def less(self, value: Ball) -> Quantity:
        """Return the square less that of the value."""
        return partial(shifted, self.square, value * value)

    def turning(self) -> Sequence[Quantity]:
        """Return the derivative of the square."""
        return [partial(_derivative, self.square)]

    def has(self, found: float, value: float) -> bool:
        """Return that it has unless the value is negative."""
        return value >= 0.0

    def square(self, pieces: Pieces) -> Curve:
        """Return the square of the length."""
        total = pieces.nothing()
        for component in self.components:
            total = total.plus(ONE, component.square(pieces))
        return total


@dataclass(frozen=True)
class Angle:
    """An unwrapped angle, by its cosine and sine."""

    direction: tuple[int, int]
    of_forces: bool = False
    ambiguous: bool = True

    @property
    def follows(self) -> Sequence[int]:
        """Return both coordinates."""
        return self.direction

    def less(self, value: Ball) -> Quantity:
        """Return the sine of the angle less the value."""
        c, s = self.direction
        return partial(_linear, {s: value.cos(), c: -value.sin()})

    def turning(self) -> Sequence[Quantity]:
        """Return the angular velocity."""
        return [partial(_crossed, *self.direction)]

    def has(self, found: float, value: float) -> bool:
        """Return whether it is that angle and not one that is half a turn or more away."""
        return abs(found - value) < 0.5 * math.pi


@dataclass(frozen=True)
class QuaternionPart:
    """A component of the quaternion of an attitude whose first component is not negative: its square is linear."""

    axes: Sequence[Sequence[int]]
    number: int
    of_forces: bool = False
    ambiguous: bool = True

    @property
    def follows(self) -> Sequence[int]:
        """Return the components of the body axes."""
        return [i for axis in self.axes for i in axis]

    def less(self, value: Ball) -> Quantity:
        """Return the square less that of the value; for zero, the product with the first component."""
        if value != 0 or self.number == 0:
            return partial(shifted, self.square, value * value)
        i, j = self.number % 3, (self.number + 1) % 3
        return partial(_linear, {self.axes[i][j]: ONE, self.axes[j][i]: -ONE})

    def turning(self) -> Sequence[Quantity]:
        """Return the derivative of the square, and that of the first component: where it vanishes, others jump."""
        first = QuaternionPart(self.axes, 0)
        return [partial(_derivative, self.square), partial(_derivative, first.square)]

    def has(self, found: float, value: float) -> bool:
        """Return whether it has the sign of the value."""
        return found * value > 0.0 if value != 0.0 else abs(found) < _NEAR_ZERO

    def square(self, pieces: Pieces) -> Curve:
        """Return its square: a quarter of one and sums of the diagonal of the rotation matrix (Shepperd 1978)."""
        signs = [1 if self.number in (0, k + 1) else -1 for k in range(3)]
        total = Curve.constant(ONE / 4, pieces.shape)
        for k, sign in enumerate(signs):
            total = total.plus(sign * ONE / 4, pieces.place(self.axes[k][k]))
        return total


def sought_in(whole: Whole, determined: Sequence[bool]) -> Callable[[str], Sought | None]:
    """Return the quantities of a scene by their names, None for what is none.

    Parameters
    ----------
    determined : sequence of bool
        Which of the forces the scene determines; none of the others can be searched.
    """
    scalars: dict[str, Sought] = {}
    vectors: dict[str, Sequence[Polynomial | QuaternionPart]] = {}
    for name, frame in whole.measures.coordinates.frames.items():
        _add_body(name, frame, scalars, vectors)
    for force, known in zip(whole.measures.forces, determined, strict=True):
        if known:
            scalars[force.name] = Polynomial(partial(_force, force), of_forces=True)
    scalars["energy.kinetic"] = Polynomial(partial(_kinetic, whole))
    scalars["energy.potential"] = Polynomial(partial(_potential, whole))
    frames = whole.measures.coordinates.frames
    for name, function in momenta(whole.measures.table, frames, whole.measures.momenta).items():
        components = [Polynomial(partial(_bilinear, terms)) for terms in function.components]
        if len(components) == 1:
            scalars[name] = components[0]
        else:
            vectors[name] = components
    return partial(_named, scalars, vectors)


def _add_body(
    name: str,
    frame: Frame,
    scalars: dict[str, Sought],
    vectors: dict[str, Sequence[Polynomial | QuaternionPart]],
) -> None:
    """Add the quantities of a body."""
    vectors[f"{name}.position"], vectors[f"{name}.velocity"] = _places(frame.position), _rates(frame.position)
    if frame.turn is not None:
        (scalars[f"{name}.angle"],) = _places([frame.turn])
        (scalars[f"{name}.angular_velocity"],) = _rates([frame.turn])
    elif frame.direction is not None:
        scalars[f"{name}.angle"] = Angle(frame.direction)
        scalars[f"{name}.angular_velocity"] = Polynomial(partial(_crossed, *frame.direction), follows=frame.direction)
    elif frame.axis is not None:
        vectors[f"{name}.axis"] = _places(frame.axis[1])
    elif frame.axes is not None:
        flat = [i for axis in frame.axes for i in axis]
        vectors[f"{name}.attitude"] = [QuaternionPart(frame.axes, k) for k in range(4)]
        vectors[f"{name}.angular_velocity"] = [
            Polynomial(partial(_spin, frame.axes, k), follows=flat) for k in range(3)
        ]
    elif frame.turns is not None:
        vectors[f"{name}.angular_velocity_in_space"] = _rates(frame.turns)


def _named(
    scalars: Mapping[str, Sought], vectors: Mapping[str, Sequence[Polynomial | QuaternionPart]], name: str
) -> Sought | None:
    """Return a scalar, a component of a vector or its length."""
    if name in scalars:
        return scalars[name]
    of, _, part = name.rpartition(".")
    components = vectors.get(of, ())
    if components and part == "length":
        return Length(components, any(one.of_forces for one in components))
    order = "wxyz" if len(components) == 4 else "xyz"[: len(components)]
    return components[order.index(part)] if len(part) == 1 and part in order else None


def _places(indices: Sequence[int]) -> list[Polynomial]:
    return [Polynomial(partial(_place, i), follows=[i]) for i in indices]


def _rates(indices: Sequence[int]) -> list[Polynomial]:
    return [Polynomial(partial(_rate, i), follows=[i]) for i in indices]


def _place(i: int, pieces: Pieces) -> Curve:
    return pieces.place(i)


def _rate(i: int, pieces: Pieces) -> Curve:
    return pieces.rate(i)


def _force(force: Force, pieces: Pieces) -> Curve:
    return pieces.force(force)


def shifted(along: Quantity, value: Ball, pieces: Pieces) -> Curve:
    """Return a quantity less a value."""
    curve = along(pieces)
    return curve.plus(-ONE, Curve.constant(value, pieces.shape))


def _derivative(along: Quantity, pieces: Pieces) -> Curve:
    return along(pieces).derivative(pieces.lengths)


def _linear(factors: Mapping[int, Ball], pieces: Pieces) -> Curve:
    return pieces.of({(i,): factor for i, factor in factors.items()})


def _crossed(c: int, s: int, pieces: Pieces) -> Curve:
    """Return c ds/dt - s dc/dt."""
    forward = pieces.place(c).times(pieces.rate(s))
    return forward.plus(-ONE, pieces.place(s).times(pieces.rate(c)))


def _spin(axes: Sequence[Sequence[int]], k: int, pieces: Pieces) -> Curve:
    """Return a component of the angular velocity in body axes: the rate of the next axis along the one after it."""
    total = pieces.nothing()
    for i, j in zip(axes[(k + 1) % 3], axes[(k + 2) % 3], strict=True):
        total = total.plus(ONE, pieces.rate(i).times(pieces.place(j)))
    return total


def _bilinear(terms: Terms, pieces: Pieces) -> Curve:
    """Return a sum of products of a factor, a coordinate and a rate."""
    total = pieces.nothing()
    for factor, i, j in terms:
        term = Curve.constant(ONE, pieces.shape)
        term = term if i is None else term.times(pieces.place(i))
        term = term if j is None else term.times(pieces.rate(j))
        total = total.plus(arb(factor), term)
    return total


def _kinetic(whole: Whole, pieces: Pieces) -> Curve:
    spin = sum((frame.spin_energy for frame in whole.measures.coordinates.frames.values()), arb(0))
    total = Curve.constant(spin, pieces.shape)
    for (i, j), mass in whole.measures.table.mass.items():
        total = total.plus(mass / 2 if i == j else mass, pieces.rate(i).times(pieces.rate(j)))
    return total


def _potential(whole: Whole, pieces: Pieces) -> Curve:
    table = whole.measures.table
    total = Curve.constant(whole.measures.potential, pieces.shape)
    for i, load in table.potential_load.items():
        total = total.plus(-load, pieces.place(i))
    for (i, j), stiffness in table.stiffness.items():
        total = total.plus(stiffness / 2, pieces.place(i).times(pieces.place(j)))
    return total
