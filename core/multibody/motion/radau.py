"""The coefficients of the Radau IIA methods of any number of stages, for equations of the second order.

The accelerations of a step are a polynomial through their values at the nodes; rates and places are its integrals. The
last node is the end of the step, so that what decays fast is at the end what the equations say there (L-stability).

References
----------
E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer 1996, sections IV.5 and IV.8.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from flint import arb_mat, fmpz_poly

from core.arrays import Complexes, Floats
from core.balls import precision
from core.multibody.algebra.polynomials import Ball
from core.multibody.equations.packed import pair

COEFFICIENT_BITS = 400
"""Precision of the coefficients: the inverse of a Vandermonde matrix of 24 nodes loses a hundred bits."""


class Radau(NamedTuple):
    """A method of s stages; the last axis of arrays of numbers is (value, tail).

    Attributes
    ----------
    nodes : (s, 2)
        Shares of the step, the last one 1.
    rates, places : (s, s, 2)
        Integrals, up to each node, of the polynomial that is one at a node and zero at the others; and of these.
    powers : (s, s, 2)
        Coefficients of the places: power k + 2 of the share of the step, for the acceleration at each node.
    values : (s, s)
        Coefficients of that polynomial: of power k, for each node.
    last : (2, s, 2)
        The last Legendre coefficients of accelerations, from their values at the nodes.
    eigenvalues : (p,)
        Of `rates`, one of every conjugate pair.
    to_modes, from_modes : (p, s) and (s, p)
        Components in its eigenvectors, and back: the real parts of sums over the pairs.
    """

    nodes: Floats
    rates: Floats
    places: Floats
    powers: Floats
    values: Floats
    last: Floats
    eigenvalues: Complexes
    to_modes: Complexes
    from_modes: Complexes


@lru_cache(maxsize=8)
def radau(stages: int) -> Radau:
    """Return the method of some stages."""
    with precision(COEFFICIENT_BITS):
        nodes = _nodes(stages)
        lagrange = arb_mat([[c**k for k in range(stages)] for c in nodes]).inv()
        sums = arb_mat([[c ** (k + 1) / (k + 1) for k in range(stages)] for c in nodes])
        rates = sums * lagrange
        places = rates * rates
        powers = arb_mat([[lagrange[k, j] / ((k + 1) * (k + 2)) for j in range(stages)] for k in range(stages)])
        last = arb_mat([[(2 * c - 1).legendre_p(k) for k in range(stages)] for c in nodes]).inv()
        values = np.array([[float(lagrange[k, j].mid()) for j in range(stages)] for k in range(stages)])
        ends = _pairs(last)[-2:]
        found = _pairs(arb_mat([[c] for c in nodes]))[:, 0], _pairs(rates), _pairs(places), _pairs(powers)
    eigenvalues, vectors = np.linalg.eig(found[1][..., 0])
    inverse = np.linalg.inv(vectors)
    kept = np.flatnonzero(eigenvalues.imag >= 0.0)
    twice = np.where(eigenvalues[kept].imag > 0.0, 2.0, 1.0)
    modes = [
        np.ascontiguousarray(x, np.complex128) for x in (eigenvalues[kept], inverse[kept], vectors[:, kept] * twice)
    ]
    return Radau(*found, values, ends, *modes)


def _nodes(stages: int) -> list[Ball]:
    """Return the zeros of the derivative s - 1 of x^(s-1) (x - 1)^s."""
    x = fmpz_poly([0, 1])
    found = x ** (stages - 1) * (x - 1) ** stages
    for _ in range(stages - 1):
        found = found.derivative()
    primitive = found / found.content()
    # The annotation of the library leaves out the multiplicities.
    roots: list[Any] = primitive.complex_roots()
    return sorted((root.real for root, _ in roots), key=lambda c: float(c.mid()))


def _pairs(matrix: arb_mat) -> Floats:
    return np.array([[pair(matrix[i, j], 0) for j in range(matrix.ncols())] for i in range(matrix.nrows())])
