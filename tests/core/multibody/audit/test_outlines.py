"""The distance of a corner from an outline, against the distance from many points of it."""

from __future__ import annotations

import numpy as np
import pytest

from core.multibody.audit.definition import Touch
from core.multibody.audit.outlines import OnOutline
from core.multibody.audit.placement import Place, Pose, turned

SMOOTH = Touch(0.0, 0.0, 0.0, ())


@pytest.mark.parametrize("corners", [((-1.0, 0.0), (1.0, 0.0)), ((-1.0, -0.5), (1.0, -0.5), (0.2, 0.7))])
def test_gap_is_the_distance_from_the_nearest_point(corners: tuple[tuple[float, float], ...]) -> None:
    """Outside, the least distance from points of the outline, as far as they are close together; below zero inside."""
    ends = tuple(Place("b", corner) for corner in corners)
    one = OnOutline("c", ("a", "b"), SMOOTH, Place("a", (0.0, 0.0)), ends, (0.1, 0.05))
    random = np.random.default_rng(5)
    points = random.uniform(-2, 2, (200, 2))
    turn = np.full(200, 0.3)
    placement = {"a": Pose(points), "b": Pose(np.zeros((200, 2)), turned(turn), turn)}
    along = np.linspace(0, 1, 4001)[:, None]
    polygon = np.array(corners) @ turned(np.array(0.3)).T
    outline = np.concatenate([p + along * (q - p) for p, q in zip(polygon, np.roll(polygon, -1, axis=0), strict=True)])
    distance = np.sqrt(((points[:, None] - outline) ** 2).sum(axis=2)).min(axis=1)
    gap = one.gap(placement) + 0.15
    inside = gap < 0
    assert gap[~inside] == pytest.approx(distance[~inside], abs=1e-4)
    assert inside.any() == (len(corners) > 2)
