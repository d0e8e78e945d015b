"""Rates in windows: what a polynomial through the samples does not resolve is not concluded from."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import Chebyshev

from core.multibody.audit.definitions import description_of
from core.multibody.audit.failure import Ledger
from core.multibody.audit.newton import Freedoms
from core.multibody.audit.placement import Pose, Twist, moved, turned
from core.multibody.audit.samples import Samples
from core.multibody.audit.windows import NODES, check_windows, nodes
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import read

HALF = 1.0 / 32.0


def failures(spin: Chebyshev, shift: float = 0.0) -> Ledger:
    """Return what is found of a body whose angle is the integral of a spin, which is given over a window."""
    scene = read({"bodies": {"body": {"mass": 1, "inertia": 1, "at": [1, 1]}}, "connections": []})
    description, times = description_of(scene), nodes(0.0, HALF)
    places, zero = times / HALF, np.zeros((NODES, 2))
    angle = HALF * spin.integ()(places) + shift * places
    placement = {"body": Pose(zero + 1.0, turned(angle), angle, times)}
    motion = {"body": Twist(zero, spin(places))}
    samples = Samples(times, placement, motion, {}, {"body": np.zeros((NODES, 4))}, {})
    ledger = Ledger()
    check_windows(ledger, description, Freedoms(description), samples, moved(placement, motion), [HALF], 1.0)
    return ledger


@pytest.mark.parametrize("tail", [[0.0], [6.8e-4, -1.8e-4, 3e-4]])
def test_an_angle_is_resolved_no_better_than_its_spin(tail: list[float]) -> None:
    """The coefficients of the integral decay by one power faster than those of what is integrated."""
    assert failures(Chebyshev([5.6, 1.76, 0.18, 0.016, 6e-4, *tail])).worst is None


def test_a_spin_that_is_not_the_rate_of_its_angle_is_found() -> None:
    found = failures(Chebyshev([5.6, 1.76, 0.018, 1.6e-4]), shift=1e-6).worst
    assert found is not None
    assert found.law == "rate of place is spin"


def test_nothing_is_concluded_where_a_formula_has_a_corner() -> None:
    """Drag by v |v| where a body has just turned back: the answer is right, and was withheld for a window beside it."""
    scene = {
        "gravity": [0, -10],
        "bodies": {"p": {"mass": 0.33, "at": ["0.98*0.96", "-0.98*0.28"]}},
        "connections": [
            {"kind": "spring", "a": "p", "b": [0, 0], "stiffness": 20, "rest_length": 1.59},
            {"kind": "damper", "a": "p", "b": [0, 0], "coefficient": 2},
            {"kind": "contact", "place": "p", "on": {"at": [0, "-0.98*0.28-0.3"]}},
            {"kind": "force", "place": "p", "force": ["-0.2*speed*vx", "-0.2*speed*vy"]},
        ],
    }
    times = [0.0, 0.3100004196166992, 0.8000001907348633, 1.0, 0.37, 0.71]
    assert solve_scene(read(scene), times, accuracy=1e-6).trajectory is not None
