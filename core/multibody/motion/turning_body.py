"""A part that is one rigid body turning about a point: what of it the equations of Euler and Poisson need.

Of a body that is free, or held at one point, nine coordinates remain, the components of its axes e_k in space. Then
M couples e_a and e_b by P_ab, the integral of x_a x_b dm about the point, and gravity is a load c_k G on each e_k:

    J w' = J w x w + c x Gamma,    Gamma_k = G . e_k,    e_1' = w_3 e_2 - w_2 e_3, ...,    J = tr P - P.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import arb_mat

from core.multibody.algebra.directions import scalar_product
from core.multibody.algebra.polynomials import ZERO, Ball, entry, is_zero
from core.multibody.motion.attitudes import angular_velocity
from core.multibody.table.table import Table

Vector = list[Ball]


@dataclass(frozen=True)
class TurningBody:
    """A rigid body about a point.

    Attributes
    ----------
    tensor : three lists of three balls
        J, in body axes about the point.
    arm : list of balls or None
        c, in body axes; None where no torque acts.
    pull : list of balls
        G, in space.
    axes : three lists of three balls
        e_k at the start, in space.
    angular_velocity : list of balls
        In body axes at the start.
    """

    tensor: list[Vector]
    arm: Vector | None
    pull: Vector
    axes: list[Vector]
    angular_velocity: Vector


def turning_body(table: Table) -> TurningBody | None:
    """Return the body of a part, whose coordinates are the components of three axes in turn; None of another part."""
    if len(table.names) != 9 or len(table.rows) != 6 or table.stiffness or table.damping or table.gyration:
        return None
    if any(unit != "1" for unit in table.units) or not _orthonormal(table):
        return None
    products = [[entry(table.mass, (3 * min(a, b), 3 * max(a, b))) for b in range(3)] for a in range(3)]
    for (i, j), value in table.mass.items():
        if i % 3 != j % 3 or not is_zero(value - products[i // 3][j // 3]):
            return None
    if any(
        not is_zero(products[a][b]) and (3 * a + i, 3 * b + i) not in table.mass
        for i in range(3)
        for a in range(3)
        for b in range(a, 3)
    ):
        return None
    loads = [[entry(table.load, 3 * k + i) for i in range(3)] for k in range(3)]
    found = _rank_one(loads)
    if found is None:
        return None
    arm, pull = found
    trace = products[0][0] + products[1][1] + products[2][2]
    tensor = [[(trace if a == b else ZERO) - products[a][b] for b in range(3)] for a in range(3)]
    e = [table.q[3 * k : 3 * k + 3] for k in range(3)]
    rates = [table.v[3 * k : 3 * k + 3] for k in range(3)]
    omega = [ZERO if is_zero(x) else x for x in angular_velocity(e, rates)]
    return TurningBody(tensor, arm if table.load else None, pull, e, omega)


def inverse_of(tensor: Sequence[Vector]) -> list[Vector] | None:
    """Return the inverse of a tensor, None where it has none, as that of matter along a line."""
    try:
        found = arb_mat([list(row) for row in tensor]).inv()
    except ZeroDivisionError:
        return None
    return [[found[a, b] for b in range(3)] for a in range(3)]


def _orthonormal(table: Table) -> bool:
    """Return whether the measures are multiples of e_a . e_b - delta_ab, one for each pair."""
    seen = set()
    for row in table.rows:
        measure = row.measure
        if measure is None:
            return False
        keys = [key for key in measure if key]
        if any(len(key) != 2 or key[0] % 3 != key[1] % 3 for key in keys) or len(keys) != 3:
            return False
        lead = measure[keys[0]]
        a, b = keys[0][0] // 3, keys[0][1] // 3
        if any((i // 3, j // 3) != (a, b) or not is_zero(measure[i, j] - lead) for i, j in keys):
            return False
        if not is_zero(entry(measure, ()) + (lead if a == b else ZERO)):
            return False
        seen.add((a, b))
    return len(seen) == 6


def _rank_one(loads: Sequence[Vector]) -> tuple[Vector, Vector] | None:
    """Return c and G with loads[k][i] = c_k G_i, G of length one or zero."""
    k, i = max(((k, i) for k in range(3) for i in range(3)), key=lambda at: abs(float(loads[at[0]][at[1]])))
    lead = loads[k][i]
    if is_zero(lead):
        return [ZERO] * 3, [ZERO] * 3
    pull = [x / lead for x in loads[k]]
    arm = [row[i] for row in loads]
    if not all(is_zero(loads[a][b] - arm[a] * pull[b]) for a in range(3) for b in range(3)):
        return None
    return arm, [ZERO if is_zero(x) else x for x in pull]


def cross_matrix(vector: Sequence[Ball]) -> list[Vector]:
    """Return the matrix of vector x."""
    x, y, z = vector
    return [[ZERO, -z, y], [z, ZERO, -x], [-y, x, ZERO]]


def product_of(first: Sequence[Vector], second: Sequence[Vector]) -> list[Vector]:
    """Return the product of two matrices."""
    return [[scalar_product(row, [other[b] for other in second]) for b in range(3)] for row in first]
