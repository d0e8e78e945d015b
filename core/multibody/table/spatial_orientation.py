"""Orientations in space as coordinates: three unit vectors, the axis of a top with its spin, or the turns of a ball."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import arb, arb_mat

from core.errors import InvalidParameter, Path
from core.multibody.algebra.directions import cross
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, LinearForm, combined, constant, coordinate, dot, is_zero
from core.multibody.language.body import SceneBody
from core.multibody.language.inertia import symmetry_axes, three_vectors
from core.multibody.language.numerals import Numerals
from core.multibody.table.frames import Frame, Given
from core.multibody.table.table import Row, Table

_POLAR_STEPS = 6
"""From the 1e-6 that axes may be off, errors are squared to below 2^-280 in five steps."""


class SpatialOrientation:
    """Adds the coordinates of orientations in space to a table: three unit vectors, an axis, or turns alone.

    Parameters
    ----------
    table : Table
    numerals : Numerals
    given : list of Given
        To which the rates are added that the client states.
    rounded : list of str
        To which the bodies are added whose axes were given rounded.
    """

    def __init__(self, table: Table, numerals: Numerals, given: list[Given], rounded: list[str]) -> None:
        self.table, self.numerals, self.given, self.rounded = table, numerals, given, rounded

    def orient(self, frame: Frame, body: SceneBody, tensor: Any, seen: set[str]) -> None:
        """Add the coordinates of a body's orientation, and the angular velocity that the client gave.

        Raises
        ------
        InvalidParameter
            For a particle with an orientation, and for axes that are no right-handed unit vectors.
        """
        path, numerals, table, name = ("bodies", frame.name), self.numerals, self.table, frame.name
        if tensor is None:
            for entry in ("axes", "angular_velocity"):
                if getattr(body, entry) is not None:
                    raise InvalidParameter((*path, entry), "be left out of a particle", remedy="give its moments")
            return
        given = [[int(i == j) for j in range(3)] for i in range(3)] if body.axes is None else body.axes
        axes: Sequence[Sequence[Ball]] = [
            numerals.vector(row, (*path, "axes", i), 3) for i, row in enumerate(three_vectors(given, (*path, "axes")))
        ]
        _check_axes(axes, (*path, "axes"))
        exact = orthonormal(axes)
        if exact is not axes:
            self.rounded.append(name)
            axes = exact
        omega = None
        if body.angular_velocity is not None:
            vector: Any = body.angular_velocity
            omega = numerals.vector(vector, (*path, "angular_velocity"), 3)
        spots = [frame.places[spot] for spot in seen if spot in frame.places]
        if "turn" in seen and "orientation" not in seen and not spots and len(symmetry_axes(tensor)) == 3:
            self._ball(frame, axes, tensor, omega)
            return
        for k in symmetry_axes(tensor) if not seen & {"orientation", "turn"} else ():
            if all(is_zero(xi[i]) for xi in spots for i in range(3) if i != k):
                self._top(frame, k, axes, tensor, omega)
                return
        # Unit vectors move as particles do whose masses are the integrals of products of body coordinates.
        half = (tensor[0][0] + tensor[1][1] + tensor[2][2]) / 2
        frame.axes = [
            [table.coordinate(f"{name}.axis{a + 1}.{'xyz'[i]}", "1", axes[a][i]) for i in range(3)] for a in range(3)
        ]
        frame.orients = True
        for a in range(3):
            for b in range(a, 3):
                weight = (half if a == b else ZERO) - tensor[a][b]
                if not is_zero(weight):
                    for i in range(3):
                        table.add_mass(frame.axes[a][i], frame.axes[b][i], weight)
                first = [coordinate(i) for i in frame.axes[a]]
                second = [coordinate(i) for i in frame.axes[b]]
                table.rows.append(
                    Row.held(name, combined((ONE, dot(first, second)), (-ONE, constant(ONE if a == b else ZERO))))
                )
        if omega is not None:
            space = [sum((omega[a] * axes[a][i] for a in range(3)), ZERO) for i in range(3)]
            for a in range(3):
                rate = cross(space, axes[a])
                for i in range(3):
                    self.given.append(Given({frame.axes[a][i]: ONE}, rate[i], (*path, "angular_velocity")))
        if "turn" in seen:
            self._turns(frame)

    def _turns(self, frame: Frame) -> None:
        """Add the coordinates whose rates are the angular velocity in space, half the sum of e x e'."""
        table, name = self.table, frame.name
        assert frame.axes is not None
        frame.turns = tuple(table.coordinate(f"{name}.turn.{x}", "rad", ZERO) for x in "xyz")
        for i, turn in enumerate(frame.turns):
            j, k = (i + 1) % 3, (i + 2) % 3
            rates: LinearForm = {turn: constant(ONE)}
            for axis in frame.axes:
                rates[axis[k]] = {(axis[j],): -ONE / 2}
                rates[axis[j]] = {(axis[k],): ONE / 2}
            table.rows.append(Row(name, None, rates))

    def _ball(self, frame: Frame, axes: Any, tensor: Any, omega: Any) -> None:
        """Describe a ball with equal moments by its angular velocity in space alone: I w' is the torque."""
        table, name = self.table, frame.name
        frame.turns = tuple(table.coordinate(f"{name}.turn.{x}", "rad", ZERO) for x in "xyz")
        frame.start_axes, frame.orients = axes, True
        for i, turn in enumerate(frame.turns):
            if not is_zero(tensor[0][0]):
                table.add_mass(turn, turn, tensor[0][0])
            if omega is not None:
                value = sum((omega[a] * axes[a][i] for a in range(3)), ZERO)
                self.given.append(Given({turn: ONE}, value, ("bodies", name, "angular_velocity", i)))

    def _top(self, frame: Frame, k: int, axes: Any, tensor: Any, omega: Any) -> None:
        """Describe a symmetric top by its axis n: I n'' = ... + p n x n', with p = I_3 omega_3 conserved."""
        table, name = self.table, frame.name
        n = [table.coordinate(f"{name}.axis.{'xyz'[i]}", "1", axes[k][i]) for i in range(3)]
        frame.axis, frame.orients = (k, n), True
        transverse = tensor[(k + 1) % 3][(k + 1) % 3]
        for i in n:
            if not is_zero(transverse):
                table.add_mass(i, i, transverse)
        table.rows.append(Row.held(name, {(n[0], n[0]): ONE, (n[1], n[1]): ONE, (n[2], n[2]): ONE, (): -ONE}))
        if omega is None:
            return
        p = tensor[k][k] * omega[k]
        frame.spin_momentum, frame.spin_energy = p, p * omega[k] / 2
        if not is_zero(p):
            for i in range(3):
                j, m = (i + 1) % 3, (i + 2) % 3
                table.add_gyration(n[i], n[j], n[m], p)
                table.add_gyration(n[i], n[m], n[j], -p)
        space = [sum((omega[a] * axes[a][i] for a in range(3)), ZERO) for i in range(3)]
        for i, value in enumerate(cross(space, axes[k])):
            self.given.append(Given({n[i]: ONE}, value, ("bodies", name, "angular_velocity")))


def orthonormal(axes: Sequence[Sequence[Ball]]) -> Sequence[Sequence[Ball]]:
    """Return the unit vectors at right angles to one another that are nearest to three vectors, these if they are such.

    What connects two bodies takes its numbers from their axes, and several of them agree only if these are exact. By
    Newton's method for the polar decomposition, X (3 - X^T X)/2 (N. J. Higham, "Functions of Matrices", section 8.3).
    """
    one = arb_mat(3, 3, [int(i == j) for i in range(3) for j in range(3)])
    matrix = arb_mat([list(axis) for axis in axes])
    if all(is_zero(x) for x in (matrix * matrix.transpose() - one).entries()):
        return axes
    for _ in range(_POLAR_STEPS):
        matrix = (matrix * (3 * one - matrix.transpose() * matrix) / 2).mid()
    # Quadratic convergence: what is left is the rounding of the last step.
    return [[arb(x, 2.0**-280) for x in axis] for axis in matrix.tolist()]


def _check_axes(axes: Any, path: Path) -> None:
    tolerance = arb("1e-6")
    for a in range(3):
        for b in range(a + 1):
            product = sum((x * y for x, y in zip(axes[a], axes[b], strict=True)), ZERO)
            if not abs(product - (1 if a == b else 0)) < tolerance:
                raise InvalidParameter(path, "be unit vectors at right angles to one another")
    handed = sum((x * y for x, y in zip(axes[0], cross(axes[1], axes[2]), strict=True)), ZERO)
    if handed < 0:
        raise InvalidParameter(path, "be right-handed")
