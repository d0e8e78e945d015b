"""The force that holds a bead aside on a parabola between springs, against its potential in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from core.multibody.statics.held_aside import force_keeps_sign
from core.multibody.statics.static_equations import StaticArrays

CURVATURE, STIFFNESS = 1.5, 2.0


def bead(soft: float) -> StaticArrays:
    """Return a bead on y = c x^2/2 with V = k x^2/2 + y + s y^2/2, where k + c = soft.

    Along x, V' = soft x + s c^2 x^3/2.
    """
    return StaticArrays(
        load=np.array([0.0, -1.0]),
        stiffness=np.diag([soft - CURVATURE, STIFFNESS]),
        lines=np.array([[0.0, 1.0]]),
        slopes=np.array([-CURVATURE]),
        slope_at=np.array([[0, 0, 0]]),
        offset=np.zeros(1),
        tie_rows=np.empty(0, np.int64),
        tie_forms=np.empty((0, 3, 3)),
        tie_starts=np.empty((0, 2)),
        tie_factors=np.empty(0),
        weights=np.ones(2),
        touched=np.ones((1, 2), dtype=bool),
    )


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("soft", [0.01, -0.01, 1e-6, -1e-6])
def test_sign_changes_at_the_next_place_of_rest(soft: float, way: float) -> None:
    start, along = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0])
    beside = np.sqrt(2.0 * abs(soft) / (STIFFNESS * CURVATURE**2))
    near, far = beside * np.exp2(np.arange(-8.0, 0.0) / 2.0), beside * np.exp2(np.arange(-8.0, 9.0) / 2.0 + 0.1)
    assert force_keeps_sign(bead(soft), start, along, way * near)
    assert force_keeps_sign(bead(soft), start, along, way * far) == (soft > 0.0)


def test_force_below_rounding_is_not_known() -> None:
    start, along = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0])
    assert not force_keeps_sign(bead(1e-14), start, along, np.array([1e-6, 2e-6]))
