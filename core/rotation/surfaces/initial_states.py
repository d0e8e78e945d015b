"""Random initial states of one energy, with uniformly distributed directions on the scaled sphere."""

from __future__ import annotations

import numpy as np

from core.arrays import Floats
from core.bodies.mass_properties import MassProperties
from core.errors import BudgetExceeded, InvalidParameter
from core.rotation.surfaces.energy_surface import EnergyEllipsoid
from core.work import spend

MOST = 1_000_000


def initial_states(body: MassProperties, energy: float, count: int, seed: int) -> Floats:
    """Return angular velocities of one energy, shape (count, 3), in body axes (rad/s).

    Directions are uniform on the unit sphere, then each principal component is scaled by the semi-axis sqrt(2E/I_i) of
    the energy ellipsoid. The states are uniform on the sphere, not in the area of the ellipsoid. The generator is
    numpy's PCG64 seeded with `seed`, from which three normal numbers per direction are drawn. Equal requests give equal
    states within one version of numpy.

    Parameters
    ----------
    body : MassProperties
    energy : float
        Kinetic energy of every state (J).
    count : int
        Number of states.
    seed : int
        At least 0.

    Raises
    ------
    InvalidParameter
        If count or seed is out of range.
    BudgetExceeded
        For more than a million states.
    """
    if count < 1:
        raise InvalidParameter("count", "be at least 1")
    if count > MOST:
        raise BudgetExceeded("states", count, MOST, path=("count",), remedy="ask for fewer states")
    if seed < 0:
        raise InvalidParameter("seed", "be at least 0")
    spend(count)
    surface = EnergyEllipsoid.of(body, energy)
    directions = np.random.Generator(np.random.PCG64(seed)).normal(size=(count, 3))
    directions /= np.sqrt((directions * directions).sum(axis=1))[:, None]
    return surface.points(directions)
