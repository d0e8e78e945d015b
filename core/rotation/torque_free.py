"""The free rigid body as a system: Euler's equations in body axes, their conserved quantities, their closed form."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.bodies.mass_properties import MassProperties
from core.bodies.pinned import pinned_notices
from core.bodies.sensitivities import tensor_sensitivities
from core.compiled import kernel
from core.errors import AccuracyUnreachable
from core.notices import Notice
from core.rotation.discrete_mechanics import moser_veselov
from core.rotation.equal_moments import NEARLY_EQUAL
from core.rotation.free_rotation import FreeRotation
from core.rotation.stability.classification import unstable_axis
from core.systems.question import MotionQuestion
from core.systems.state_motion import state_motion
from core.systems.system import PART_FLOW, VECTOR_FIELD, Model, Range, Splitting, Structure
from core.systems.trajectory import Trajectory

PARTS = 3

_PIECE = 512
"""Samples whose energies are formed at a time."""


@kernel(VECTOR_FIELD)
def _euler_principal(
    time: float, state: NDArray[np.float64], parameters: NDArray[np.float64], derivative: NDArray[np.float64]
) -> None:
    """I1 w1' = (I2 - I3) w2 w3 and cyclic; the parameters begin with the three moments."""
    a, b, c = parameters[0], parameters[1], parameters[2]
    x, y, z = state[0], state[1], state[2]
    derivative[0] = (b - c) / a * y * z
    derivative[1] = (c - a) / b * z * x
    derivative[2] = (a - b) / c * x * y


@kernel(VECTOR_FIELD)
def _euler_tensor(
    time: float, state: NDArray[np.float64], parameters: NDArray[np.float64], derivative: NDArray[np.float64]
) -> None:
    """I w' = (I w) x w; the parameters are three moments, nine axes, the tensor and its inverse, row by row."""
    x, y, z = state[0], state[1], state[2]
    p = parameters
    mx = p[12] * x + p[13] * y + p[14] * z
    my = p[15] * x + p[16] * y + p[17] * z
    mz = p[18] * x + p[19] * y + p[20] * z
    tx, ty, tz = my * z - mz * y, mz * x - mx * z, mx * y - my * x
    derivative[0] = p[21] * tx + p[22] * ty + p[23] * tz
    derivative[1] = p[24] * tx + p[25] * ty + p[26] * tz
    derivative[2] = p[27] * tx + p[28] * ty + p[29] * tz


@kernel(PART_FLOW)
def _turn_momentum(part: int, duration: float, state: NDArray[np.float64], parameters: NDArray[np.float64]) -> None:
    """Flow of the energy M_k^2/2I_k alone: the angular momentum turns about the principal axis k at a constant rate."""
    w = np.empty(3)
    for k in range(3):
        w[k] = parameters[3 + k] * state[0] + parameters[6 + k] * state[1] + parameters[9 + k] * state[2]
    i, j = (part + 1) % 3, (part + 2) % 3
    angle = w[part] * duration
    s, c = math.sin(angle), math.cos(angle)
    mi, mj = parameters[i] * w[i], parameters[j] * w[j]
    w[i], w[j] = (c * mi + s * mj) / parameters[i], (c * mj - s * mi) / parameters[j]
    for k in range(3):
        state[k] = parameters[3 + 3 * k] * w[0] + parameters[4 + 3 * k] * w[1] + parameters[5 + 3 * k] * w[2]


@kernel()
def _energy_and_momentum(
    a: float,
    b: float,
    c: float,
    unit: float,
    p: NDArray[np.float64],
    q: NDArray[np.float64],
    r: NDArray[np.float64],
    energy: NDArray[np.float64],
    square: NDArray[np.float64],
) -> None:
    """Fill in 2 E and L^2 of rotations with components p, q, r, times a unit, along the axes of moments a, b, c."""
    for n in range(p.size):
        x, y, z = unit * p[n], unit * q[n], unit * r[n]
        mx, my, mz = a * x, b * y, c * z
        energy[n] = x * mx + y * my + z * mz
        square[n] = mx * mx + my * my + mz * mz


@kernel()
def _widen(values: NDArray[np.float64], least: NDArray[np.float64], largest: NDArray[np.float64]) -> None:
    """Let the range of every place take in one more value."""
    for n in range(values.size):
        value = values[n]
        least[n] = value if value < least[n] else least[n]
        largest[n] = value if value > largest[n] else largest[n]


@kernel()
def _ranges(
    moments: NDArray[np.float64], start: NDArray[np.float64], states: NDArray[np.float64], unit: float
) -> tuple[float, float, float, float, float, float]:
    """Return E at the start with the least and largest of all samples, and the same of L, in the unit's units.

    Samples are taken a piece at a time, and every place in a piece has a range of its own: so the processor works on
    several at once and in its nearest memory, without any change of the order in which anything is rounded.
    """
    a, b, c = moments[0], moments[1], moments[2]
    energy, square = np.empty(_PIECE), np.empty(_PIECE)
    e_least, e_largest = np.full(_PIECE, np.inf), np.full(_PIECE, -np.inf)
    m_least, m_largest = np.full(_PIECE, np.inf), np.full(_PIECE, -np.inf)
    odd = np.zeros(_PIECE)
    for begin in range(0, states.shape[1], _PIECE):
        end = min(begin + _PIECE, states.shape[1])
        _energy_and_momentum(
            a, b, c, unit, states[0, begin:end], states[1, begin:end], states[2, begin:end], energy, square
        )
        _widen(energy[: end - begin], e_least, e_largest)
        _widen(square[: end - begin], m_least, m_largest)
        for n in range(end - begin):
            # 0, or NaN where either is not finite.
            odd[n] += (energy[n] - energy[n]) + (square[n] - square[n])
    _energy_and_momentum(a, b, c, unit, start[0], start[1], start[2], energy, square)
    spoilt = odd.sum()
    return (
        0.5 * energy[0], 0.5 * e_least.min() + spoilt, 0.5 * e_largest.max() + spoilt,
        math.sqrt(square[0]), math.sqrt(m_least.min()) + spoilt, math.sqrt(m_largest.max()) + spoilt,
    )  # fmt: skip


def inherited_notices(body: MassProperties) -> tuple[Notice, ...]:
    """Return what an answer about the motion of a body has to say of the body itself; paths lead from the question."""
    if not body.warnings and body.about != "origin":
        return ()
    return tuple(notice.inside("body") for notice in (*body.warnings, *pinned_notices(body)))


@dataclass(frozen=True, eq=False)
class TorqueFree:
    """A body that turns freely, its state the angular velocity in body axes (rad/s).

    Attributes
    ----------
    body : MassProperties
    angular_velocity : ndarray, shape (3,)
        At t = 0, in body axes.
    """

    body: MassProperties
    angular_velocity: Floats

    def __post_init__(self) -> None:
        # A body that cannot turn so is refused here, not when it is first asked for.
        self.closed_form()

    @property
    def initial_state(self) -> Floats:
        """Angular velocity at t = 0, shape (3,)."""
        return self.angular_velocity

    @cached_property
    def tensor(self) -> Floats:
        """Tensor of inertia in body axes about the point of rotation, times a power of two that brings it near one."""
        if self.body.about == "origin" and self.body.inertia_about_origin is not None:
            inertia = self.body.inertia_about_origin
        else:
            inertia = self.body.inertia
        scaled: Floats = np.ldexp(inertia, -self._exponent)
        return scaled

    @property
    def _exponent(self) -> int:
        return math.frexp(float(self.body.principal_of_motion.moments[2]))[1]

    @cached_property
    def _diagonal(self) -> bool:
        return bool(self.tensor[0, 1] == self.tensor[0, 2] == self.tensor[1, 2] == 0.0)

    @cached_property
    def parameters(self) -> Floats:
        """Three moments, nine components of the axes and, unless the tensor is diagonal, tensor and inverse."""
        if self._diagonal:
            return np.concatenate([np.diag(self.tensor), np.eye(3).ravel()])
        principal = self.body.principal_of_motion
        moments = np.ldexp(principal.moments, -self._exponent)
        inverse = (principal.axes / moments) @ principal.axes.T
        return np.concatenate([moments, principal.axes.ravel(), self.tensor.ravel(), inverse.ravel()])

    @property
    def equation(self) -> Any:
        """Euler's equations, component by component where the tensor is diagonal."""
        return _euler_principal if self._diagonal else _euler_tensor

    @property
    def structure(self) -> Structure:
        """The energy as a sum of three, one for each principal axis; discrete mechanics; a quadratic equation."""
        return Structure(Splitting(PARTS, _turn_momentum), moser_veselov, degree=2)

    @property
    def model(self) -> Model:
        """The model as an integrator sees it."""
        return Model("torque-free rigid body", "Euler's equations", "an integrator was requested", 3)

    def closed_form(self) -> FreeRotation:
        """Return the exact solution."""
        return self._exact

    @cached_property
    def _exact(self) -> FreeRotation:
        # Principal moments that were given as such are their own numbers; that spares their tensors.
        described = self.body.mass is not None or not self._diagonal
        sensitivities = partial(tensor_sensitivities, self.body) if described else None
        return FreeRotation(self.body.principal_of_motion, self.angular_velocity, sensitivities)

    @property
    def state_column(self) -> tuple[str, str]:
        """Name and unit of the state."""
        return "angular_velocity", "rad/s"

    def trajectory(self, question: MotionQuestion) -> Trajectory:
        """Return samples of the angular velocity; see `core.systems.question.System`."""
        return state_motion(self, question)

    def ranges(self, states: Floats) -> Mapping[str, Range]:
        """Return the ranges of energy and |L|, both times a power of two that brings them near one."""
        largest = float(np.abs(self.angular_velocity).max())
        unit = math.ldexp(1.0, max(-1000, min(1000, -math.frexp(largest)[1])))
        start, along = self.angular_velocity[:, None], states.T
        if self._diagonal:
            moments = np.diagonal(self.tensor).copy()
        else:
            # Along principal axes no term is negative, and a small moment is not lost in the tensor's components.
            principal = self.body.principal_of_motion
            moments = np.ldexp(principal.moments, -self._exponent)
            start, along = principal.axes.T @ start, principal.axes.T @ along
        found = _ranges(moments, np.ascontiguousarray(start), np.ascontiguousarray(along), unit)
        return {"energy": Range(*found[:3]), "angular_momentum": Range(*found[3:])}

    @property
    def energy(self) -> float | None:
        """Kinetic energy (J); None where it leaves the range of normal doubles."""
        return self._in_range(lambda i, w: 0.5 * float((i * w * w).sum()), 2)

    @property
    def angular_momentum(self) -> float | None:
        """Magnitude of the angular momentum (kg m^2/s); None where it leaves the range of normal doubles."""
        return self._in_range(lambda i, w: math.hypot(*(i * w).tolist()), 1)

    def _in_range(self, figure: Any, power: int) -> float | None:
        resolved = self._exact.resolved
        largest = float(np.max(np.abs(resolved.angular_velocity)))
        if largest == 0.0:
            return 0.0
        rate = math.frexp(largest)[1]
        moments = np.ldexp(resolved.moments, -self._exponent)
        mantissa, exponent = math.frexp(figure(moments, np.ldexp(resolved.angular_velocity, -rate)))
        exponent += self._exponent + power * rate
        return math.ldexp(mantissa, exponent) if -1021 <= exponent <= 1024 else None

    @property
    def moment_notices(self) -> tuple[Notice, ...]:
        """What is to be said where the difference of two nearly equal moments decides the motion."""
        try:
            hangs = self._exact.hangs_on_nearly_equal_moments
        except AccuracyUnreachable:
            hangs = self.body.principal_of_motion.nearly_equal
        return (NEARLY_EQUAL,) if hangs else ()

    @property
    def stability_notices(self) -> tuple[Notice, ...]:
        """The warning about a steady spin that is unstable."""
        try:
            why = self._exact.instability
        except AccuracyUnreachable:
            return ()
        return () if why is None else (unstable_axis(why),)

    @property
    def warnings(self) -> tuple[Notice, ...]:
        """What an answer about this motion has to say beside its figures; paths lead from the question."""
        notices = [*inherited_notices(self.body), *self.moment_notices, *self.stability_notices]
        for name, value in (("energy", self.energy), ("angular_momentum", self.angular_momentum)):
            if value is None:
                notices.append(Notice("out-of-range", f"{name} leaves the range of double precision and is null"))
        return tuple(notices)
