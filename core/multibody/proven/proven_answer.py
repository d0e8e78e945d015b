"""A described scene to many digits: its start, and its motion where a closed form or a proven series reaches.

The set-up of a scene is in balls anyway; here its precision follows the digits. Parts whose model has a closed form
are evaluated by it (`Motion.in_balls`), every other part by `proven_series`. As in the set-up, what at least 320 bits
do not tell from zero counts as zero.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np
from flint import ctx

from core.balls import precision
from core.digits.adaptive_precision import bits_for, check_digits, until_determined
from core.digits.exact_inputs import enclosed
from core.errors import InvalidParameter, NotApplicable
from core.multibody.algebra.polynomials import BITS, ZERO, Ball
from core.multibody.answer import Energy
from core.multibody.assembly.assembled_scene import assembled
from core.multibody.audit.failure import require
from core.multibody.language.faults_of_parts import FaultsOfParts
from core.multibody.language.independent_parts import independent_parts
from core.multibody.language.scene import Scene
from core.multibody.parts.joined_model import joined_model
from core.multibody.proven.audited_digits import audited_digits
from core.multibody.proven.part_proof import PartProof, ProvenAnswer, ProvenColumn
from core.multibody.start import NumberKind, accelerations_of, energy_of, forces_of_start
from core.notices import Notice
from core.systems.trajectory import HORIZON

PROVEN_OUTPUTS = ("accelerations", "forces", "energy", "trajectory")
"""What is answered to many digits."""
LATEST = 10**300
"""Latest time (s): the end of a motion is looked for in doubles, whose range ends at 1.8e308."""

_BITS_OF_A_SECOND = 30
"""What a second of motion in several coordinates loses, about; at the first precision so many are added."""
_MOST_ADDED = 300
"""Bits that are added at most at the first precision; what loses more is found out by computing."""


def proven_answer(
    scene: Scene,
    digits: int,
    times: Sequence[Fraction] = (),
    outputs: Sequence[str] | None = None,
    *,
    audited: bool = True,
) -> ProvenAnswer:
    """Answer a question about a scene with so many significant digits.

    Parameters
    ----------
    audited : bool
        Whether the answer is held against the description before it is given.

    Raises
    ------
    InvalidParameter
        For a scene that cannot be.
    NotApplicable
        For contacts, and what begins, ends or strikes; for positions or velocities that meet the connections only to
        rounding; for connections that depend on one another.
    BudgetExceeded
        For a motion that is longer than can be proven.
    SelfCheckFailed
        Where the answer that was found does not keep the laws of mechanics: see `core.multibody.audit`.
    """
    check_digits(digits, 8 * len(scene.bodies) * max(1, len(times)))
    if scene.changes:
        raise NotApplicable(
            "connections that begin or end, and blows, are answered with the digits of doubles",
            path=("connections",),
            remedy="ask POST /v1/scenes",
        )
    if scene.one_sided:
        raise NotApplicable(
            "contacts are decided with the digits of their own set-up, and no more are proven",
            path=("connections",),
            remedy="ask POST /v1/scenes, or hold what touches by a connection of another kind",
        )
    if outputs is not None and "trajectory" in outputs and not times:
        raise InvalidParameter("times", "be given where trajectory is requested")
    scene = assembled(scene).scene
    outputs = PROVEN_OUTPUTS if outputs is None else outputs
    check_instants(times)
    farthest = max((abs(float(t)) for t in times), default=0.0)
    bits = bits_for(digits) + int(min(_MOST_ADDED, _BITS_OF_A_SECOND * farthest))
    parts = independent_parts(scene)

    def found() -> ProvenAnswer:
        proofs = _proofs(parts, digits, bits)
        answer = _answer(proofs, times, outputs)
        if audited:
            moving = partial(_columns, proofs)
            verdict = audited_digits(scene, answer, moving, np.array([float(time) for time in times]))
            require(verdict.failure)
            answer = replace(answer, model=answer.model.with_noticed(verdict.noticed))
        return answer

    return until_determined(found, bits)


def check_instants(times: Sequence[Fraction]) -> None:
    """Raise `InvalidParameter` for a time that no double is near: the end of a motion is looked for in doubles."""
    if any(abs(time) > LATEST for time in times):
        raise InvalidParameter("times", "be between -1e300 and 1e300 s", remedy="describe the scene in other units")


def _proofs(parts: Sequence[Scene], digits: int, first_bits: int) -> list[PartProof]:
    """Return what is proven of every part, or raise the faults of all of them."""
    found, faults = [], FaultsOfParts()
    for part in parts:
        with faults.part():
            found.append(PartProof(part, digits, first_bits))
    faults.raised()
    return found


def _answer(parts: Sequence[PartProof], times: Sequence[Fraction], outputs: Sequence[str]) -> ProvenAnswer:
    """Return the answer about a scene from what is proven of its independent parts."""
    numbers = NumberKind(parts[0].number, None)
    with precision(max(BITS, ctx.prec)):
        model = joined_model([part.model() for part in parts])
        accelerations: dict[str, Any] = {}
        forces: dict[str, Any] = {}
        for part in parts:
            accelerations |= accelerations_of(part.found.described, part.found.whole.acceleration, numbers)
            forces |= forces_of_start(part.found.described, part.forces, numbers)
        energies = [energy_of(part.found.described, NumberKind(lambda ball: ball, None)) for part in parts]
        kinetic, potential, total = (
            parts[0].number(sum((getattr(one, name) for one in energies), ZERO))
            for name in ("kinetic", "potential", "total")
        )
        energy = Energy(kinetic, potential, total, all(one.conserved for one in energies))
    rows, ended = None, None
    columns: Mapping[str, ProvenColumn] | None = None
    if times:
        reached = [part.reached(times) for part in parts]
        rows = [k for k in range(len(times)) if all(k in own for own, _ in reached)]
        events = [event for _, events in reached for event in events if event.time >= 0.0]
        ended = min(events, key=lambda event: event.time).kind if events else HORIZON
        if "trajectory" in outputs:
            columns = _columns(parts, [enclosed(times[row]) for row in rows])
    what = "that strings stay taut, chains on their pegs and lengths positive up to the last time"
    notice = Notice("end-not-proven", f"{what} is found in doubles, and not proven", ("times",))
    return ProvenAnswer(
        model,
        accelerations if "accelerations" in outputs else None,
        forces if "forces" in outputs else None,
        energy if "energy" in outputs else None,
        rows,
        columns,
        ended,
        (notice,) if times and any(part.watched for part in parts) else (),
    )


def _columns(parts: Sequence[PartProof], times: Sequence[Ball]) -> dict[str, ProvenColumn]:
    """Return the columns of all parts, at times before what ends their motion."""
    return {name: column for part in parts for name, column in part.columns(times).items()}
