"""Many precessions at once have the bits of each alone, and leave to that what they do not answer."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.bodies.measured import PrincipalMoments
from core.errors import InvalidParameter, MechanicsError
from core.rotation.precession.many import precessions
from core.rotation.precession.precession import FIGURES, precession

COUNT = 1500


def bodies_and_starts() -> tuple[Any, Any]:
    """Return moments and angular velocities of every kind: any order, symmetric, impossible, steady, extreme."""
    chance = np.random.default_rng(20)
    moments, spins = chance.uniform(1.0, 2.0, (COUNT, 3)), chance.normal(size=(COUNT, 3))
    moments[:100, 1] = moments[:100, 0]
    moments[100:200, 2] = moments[100:200, 1]
    moments[200:220] = 2.0
    moments[220:240, 0] = 9.0
    moments[240:250, 1] = 0.0
    moments[250:300] *= 1e-200
    moments[300:350, 0] = moments[300:350, 1] * (1.0 + 2.0**-51)
    spins[350:370, 0] = 0.0
    spins[370:390, :2] = 0.0
    spins[390:400] = 0.0
    spins[400:450] *= 1e150
    # Near the separatrix: A (B - A) w_A^2 = C (C - B) w_C^2 for these.
    moments[450:500] = (1.0, 2.0, 3.0)
    spins[450:500] = (3.0**0.5, 1.0, 1.0)
    spins[500:550, 0] = -0.0
    moments[550:600] = chance.choice([1.0, 1.0 + 2.0**-30, 1.5], (50, 3))
    spins[600:605, 1] = np.inf
    moments[605:610, 1] = np.nan
    return moments, spins


MOMENTS, SPINS = bodies_and_starts()
FOUND = precessions(MOMENTS, SPINS)


def row(found: Any) -> bytes:
    """Return the figures of one precession as bytes, every NaN the same."""
    tilt = found.middle_axis_tilt or (None, None)
    entries = [*(getattr(found, name) for name in FIGURES), *tilt, found.tumbles, *found.axis]
    return np.array([np.nan if entry is None else entry for entry in entries]).tobytes()


def test_every_motion_that_is_answered_has_the_bits_of_a_single_one() -> None:
    table = np.column_stack([FOUND.figures, FOUND.tilt, FOUND.tumbles, FOUND.axis])
    table[np.isnan(table)] = np.nan
    for n in np.flatnonzero(FOUND.answered).tolist():
        alone = precession(PrincipalMoments(tuple(MOMENTS[n].tolist())).mass_properties(), tuple(SPINS[n].tolist()))
        assert table[n].tobytes() == row(alone), n
        assert {notice.code for notice in alone.warnings} == ({"unphysical-inertia"} if FOUND.unphysical[n] else set())


def test_what_is_refused_alone_is_not_answered() -> None:
    refused = 0
    for n in range(COUNT):
        try:
            precession(PrincipalMoments(tuple(MOMENTS[n].tolist())).mass_properties(), tuple(SPINS[n].tolist()))
        except MechanicsError:
            refused += 1
            assert not FOUND.answered[n]
    assert refused >= 10


def test_ordinary_motions_are_answered() -> None:
    # The rest is so near the separatrix that only exact arithmetic tells the sides apart.
    assert FOUND.answered[610:].mean() > 0.95
    assert FOUND.answered[:200].mean() > 0.9
    assert FOUND.unphysical[220:240].all()


def test_arrays_of_other_shapes_are_refused() -> None:
    with pytest.raises(InvalidParameter, match="moments"):
        precessions(MOMENTS[:, :2], SPINS)
    with pytest.raises(InvalidParameter, match="angular_velocities"):
        precessions(MOMENTS, SPINS[:5])
