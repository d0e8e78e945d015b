"""Moduli and Jacobian elliptic functions from a parameter in doubles, by the kernels that motions are made of."""

from __future__ import annotations

import numpy as np

from core.arrays import Floats
from core.double_double import dd_div, dd_sqrt, two_sum
from core.elliptic.functions import jacobi_at, separatrix_at, split_phase
from core.elliptic.lattice import lattice


def moduli(m: float, m1: float) -> tuple[float, float, float, float]:
    """Return k and k' as pairs; the smaller of m and m1 = 1 - m is exact and the other its complement."""
    least, rest = dd_sqrt(min(m, m1), 0.0), dd_sqrt(*two_sum(1.0, -min(m, m1)))
    return (*rest, *least) if m1 < m else (*least, *rest)


def jacobi(u: Floats, m: float, m1: float) -> Floats:
    """Return sn, cn and dn of arguments, shape (3, n)."""
    if m1 == 0.0:
        return np.array([(tanh, sech, sech) for tanh, sech in (separatrix_at(x, 0.0) for x in u)]).T
    lat = lattice(*moduli(m, m1))
    rate = dd_div(1.0, 0.0, lat.K, lat.K_tail)
    return np.array([jacobi_at(lat, *split_phase(*rate, x, 0.0, 0.0)) for x in u]).T
