"""Motions of free rotation keep their equations between the samples, and their period; spoilt ones do not."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from core.arrays import Floats
from core.errors import SelfCheckFailed
from core.rotation.attitude.free_attitude import FreeAttitude
from core.rotation.motion_check import check_motion
from core.rotation.torque_free import TorqueFree
from tests.core.rotation.test_self_check import drawn

Change = Callable[[dict[str, Any]], None]


def motion(seed: int) -> list[dict[str, Any]]:
    random = np.random.default_rng(seed)
    found = []
    for _ in range(20):
        body, start, attitude = drawn(random)
        system = TorqueFree(body, start)
        exact = system.closed_form()
        free = FreeAttitude(exact, attitude / np.linalg.norm(attitude))
        norm = exact.largest_norm
        found.append(
            {
                "tensor": system.tensor,
                "start": start,
                "time": 3.7 / float(np.abs(start).max()),
                "rates": (exact.sample, lambda at, exact=exact, norm=norm: exact.error(at) * norm),
                "attitudes": (free.sample, free.error),
                "period": exact.period,
            }
        )
    return found


def _timed(which: str, factor: float) -> Change:
    def change(one: dict[str, Any]) -> None:
        own, known = one[which]
        one[which] = (lambda at: own(factor * at), known)

    return change


def _values(which: str, change: Callable[[Floats], Floats]) -> Change:
    def changed(one: dict[str, Any]) -> None:
        own, known = one[which]
        one[which] = (lambda at: change(own(at)), known)

    return changed


def _period(factor: float) -> Change:
    def change(one: dict[str, Any]) -> None:
        one["period"] = None if one["period"] is None else factor * one["period"]

    return change


SPOILT: dict[str, Change] = {
    "the angular velocity changes too fast": _timed("rates", 1.0 + 1e-4),
    "the angular velocity changes backwards": _timed("rates", -1.0),
    "the angular velocity is too large": _values("rates", lambda w: 1.0001 * w),
    "the attitude turns too fast": _timed("attitudes", 1.0 + 1e-4),
    "the attitude turns backwards": _timed("attitudes", -1.0),
    "the attitude is the inverse one": _values("attitudes", lambda q: q * np.array([1.0, -1.0, -1.0, -1.0])),
    "nothing turns": _values("attitudes", lambda q: 0.0 * q + q[:1]),
    "the period is twice as long": _period(2.0),
    "the period is half as long": _period(0.5),
    "the period is off by a millionth": _period(1.0 + 1e-6),
}


@pytest.mark.parametrize("seed", range(8))
def test_right_motions_pass(seed: int) -> None:
    for one in motion(seed):
        check_motion(**one)


@pytest.mark.parametrize("kind", SPOILT)
def test_wrong_motions_are_refused(kind: str) -> None:
    for one in motion(11):
        SPOILT[kind](one)
        with pytest.raises(SelfCheckFailed):
            check_motion(**one)
