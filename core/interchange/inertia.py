"""Tensors of inertia by the names that their components have in files."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from core.arrays import Floats

COMPONENTS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
"""Moments and products, in the order of MJCF's `fullinertia`."""

MOMENTS = COMPONENTS[:3]


def inertia_tensor(component: Callable[[str], float]) -> Floats:
    """Return the tensor of the components that a function states (kg m^2)."""
    xx, yy, zz, xy, xz, yz = map(component, COMPONENTS)
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
