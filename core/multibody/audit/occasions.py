"""Whether connections began and ended, and blows fell, at the times that a description gives for that."""

from __future__ import annotations

import numpy as np

from core.multibody.answer import SceneSolution
from core.multibody.audit.bodies import Reader
from core.multibody.audit.failure import Ledger
from core.multibody.language.occasions import named_by
from core.multibody.language.scene import Scene

HAPPENS = {"from": "begin", "until": "end", "at": "impulse"}
"""The event at the occasion of each field."""


def check_occasions(ledger: Ledger, scene: Scene, answer: SceneSolution, latest: float) -> None:
    """Compare what began, ended and struck with the times of the description: each once, at its time.

    What has not begun at the time of its end ends as soon as it begins. Occasions that are no times are not compared,
    but nothing begins, ends or strikes without one, or twice.

    Parameters
    ----------
    scene : Scene
        As the client wrote it.
    answer : SceneSolution
    latest : float
        Last time of the question (s).
    """
    reader = Reader(scene)
    for name, (i, connection) in zip(scene.names(), scene.numbered(), strict=True):
        written, begun = connection.occasions(), 0.0 if connection.starts else None
        for field, what in HAPPENS.items():
            own = [event for event in answer.events if (event.kind, event.name) == (what, name)]
            occasion = written.get(field)
            fewest, most = 0, int(occasion is not None)
            if occasion is not None and not any(named_by(occasion)) and not (what == "end" and begun is None):
                due = max(reader.number(occasion, ("connections", i, field)), begun if what == "end" and begun else 0.0)
                # What ends a motion may come before anything else that happens at the same time.
                fewest = int(due <= latest if answer.ended is None else due < answer.ended.time)
                for event in own:
                    known = np.array([ledger.rounding * due + event.error])
                    ledger.compare(f"time of its {what}", name, np.array([due]), np.array([event.time - due]), known)
            if what == "begin" and own:
                begun = own[0].time
            off = max(fewest - len(own), len(own) - most, 0)
            ledger.compare(f"number of events {what}", name, np.array([latest]), np.array([float(off)]), 0.0)
