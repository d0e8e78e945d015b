"""A table in other coordinates has the same energies and forces."""

from __future__ import annotations

import numpy as np
from flint import arb
from hypothesis import given
from hypothesis import strategies as st

from core.multibody.algebra.polynomials import Poly
from core.multibody.equations.dynamics import kinetic, potential
from core.multibody.table.table import Row, Table


def drawn(seed: int, count: int) -> Table:
    random = np.random.default_rng(seed)

    def number() -> arb:
        return arb(int(random.integers(-5, 6)))

    made = Table()
    for i in range(count):
        made.coordinate(f"q{i}", "m", number())
    made.v = [number() for _ in range(count)]
    for i in range(count):
        made.add_load(i, number())
        for j in range(count):
            made.add_mass(i, j, number())
            x = number()
            made.add_stiffness(i, j, x)
            made.add_stiffness(j, i, x)
            made.add_damping(i, j, number())
            for k in range(count):
                made.add_gyration(i, j, k, number())
    return made


@given(st.integers(0, 1000))
def test_energies_forces_and_inertia_go_with_the_coordinates(seed: int) -> None:
    random = np.random.default_rng(seed + 1)
    new = drawn(seed, 2)
    slopes = random.integers(-3, 4, (3, 2))
    shift = random.integers(-3, 4, 3)
    old = drawn(seed, 3)
    expressions: list[Poly] = [
        {(): arb(int(shift[i])), **{(j,): arb(int(slopes[i, j])) for j in range(2)}} for i in range(3)
    ]
    z, w = [1, 2], [3, -1]
    old.q = [arb(int(shift[i] + slopes[i] @ z)) for i in range(3)]
    old.v = [arb(int(slopes[i] @ w)) for i in range(3)]
    new = old.changed(expressions, [0, 1])
    new.q, new.v = [arb(x) for x in z], [arb(x) for x in w]
    assert kinetic(new) == kinetic(old)
    still = old.changed(expressions, [0, 1])
    still.q = [arb(0), arb(0)]
    start = Table(old.names, old.units, stiffness=old.stiffness, load=old.load, q=[arb(int(x)) for x in shift])
    assert potential(new) - potential(still) == potential(old) - potential(start)
    forces, pulled = new.forces(), old.forces()
    gained, lost = new.inertial(new.v), old.inertial(old.v)
    for j in range(2):
        assert forces[j] == sum((int(slopes[i, j]) * pulled[i] for i in range(3)), arb(0))
        assert gained[j] == sum((int(slopes[i, j]) * lost[i] for i in range(3)), arb(0))


def test_rate_rows_go_with_the_coordinates() -> None:
    row = Row("c", None, {0: {(1,): arb(2)}, 1: {(): arb(3)}})
    # q0 = 2 z, q1 = z + 1: 2 (z + 1) 2 z' + 3 z'
    found = row.along([{(0,): arb(2)}, {(0,): arb(1), (): arb(1)}])
    assert found.rates == {0: {(0,): arb(4), (): arb(7)}}
