"""One scene, answered by the product and by the plain engine, and where the two differ.

Answers that are the same to 1e-9 of the size of every figure agree. How far others may be apart is measured, not
chosen: the plain engine runs once more, with larger steps from a start that is moved by 1e-10 (all given velocities and
gravity, so that what is symmetric stays so). What differs between its two runs, ten times, is added to the tolerance.
Where they have other events, the motion is compared up to the first of them that differs.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from core.errors import MechanicsError
from core.multibody.answer import SceneSolution
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene
from tests.oracles.plain_engine.mechanism import NotSupported
from tests.oracles.plain_engine.motion import Event, Motion, follow
from tests.oracles.plain_engine.readouts import columns_of

MOVED = 1e-10
TIGHT, LOOSE = 1e-12, 1e-10
GROWN = 10.0
"""Factor on what the two runs of the plain engine differ by."""
RESOLVED = 1e-9
"""Share of the size of a figure within which two answers are one."""
LEAST = 1e-3
"""Size of a figure (SI units) below which it is nothing beside the scenes that are compared."""
IMPACTS = ("touch", "taut", "stop")
LISTED = 12
"""Impacts of one contact in a row that an answer lists before its bounces come to rest."""

Json = dict[str, Any]


@dataclass(frozen=True)
class Difference:
    """Something that the two answers say differently.

    Attributes
    ----------
    what : str
        The class: "refused", "event", "end", "place", "rate" or "force".
    detail : str
    right, answered : object
        What the plain engine says, and the product.
    """

    what: str
    detail: str
    right: object
    answered: object


@dataclass
class Verdict:
    """What came of one scene.

    Attributes
    ----------
    not_supported : str
        Why the plain engine has no answer; "" if it has one.
    """

    not_supported: str = ""
    differences: list[Difference] = field(default_factory=list)
    compared: int = 0


def compared(scene: Json, times: Sequence[float]) -> Verdict:
    """Return where the product and the plain engine differ about a scene."""
    verdict = Verdict()
    try:
        first = follow(scene_from(scene), times, tolerance=TIGHT)
    except NotSupported as reason:
        verdict.not_supported = str(reason)
        return verdict
    try:
        solution = solve_scene(scene_from(scene), times, ("trajectory", "forces-in-time"))
    except MechanicsError as fault:
        verdict.differences.append(Difference("refused", reason_of(fault, scene), _events_shown(first), str(fault)))
        return verdict
    _compare(verdict, solution, first, first, times)
    if verdict.differences:
        verdict = Verdict()
        try:
            moved = follow(scene_from(scene), times, tolerance=LOOSE, faster=1 + MOVED, heavier=1 + MOVED)
        except NotSupported as reason:
            return Verdict(str(reason))
        _compare(verdict, solution, first, moved, times)
    return verdict


def reason_of(fault: Exception, scene: Json) -> str:
    """Return a refusal without its numbers and the names of the scene."""
    names = {*scene["bodies"], *(one.get("name", "") for one in scene["connections"])}
    words = re.sub(r'"[^"]*"', "#", str(getattr(fault, "detail", None) or fault)).replace(",", "").split()
    kept = ["#" if word in names or re.search(r"\d", word) else word for word in words]
    return f"{type(fault).__name__}: {re.sub('(# )+#', '#', ' '.join(kept))}"[:160]


def _events_shown(motion: Motion) -> list[str]:
    shown = [f"{event.kind} {event.name} {event.time:.12g}" for event in motion.events[:8]]
    return shown + ([] if motion.ended is None else [f"ends: {motion.ended.kind} {motion.ended.time:.12g}"])


@dataclass(frozen=True)
class _Timed:
    kind: str
    name: str
    time: float
    tolerance: float


def _compare(verdict: Verdict, solution: SceneSolution, first: Motion, moved: Motion, times: Sequence[float]) -> None:
    plain, until = _known(first, moved, max(times))
    # The plain engine integrates across the pieces of formulas, whose changes are no events of its motion, and names of
    # what touches at an impact those alone that take an impulse.
    struck = [event.time for event in solution.events if event.impulses]
    answered = [
        (event.kind, event.name, event.time, event.error)
        for event in solution.events
        if event.kind != "switch" and not (event.kind in IMPACTS and not event.impulses and event.time in struck)
    ]
    ended = None if solution.problem is None else (solution.problem.code, solution.problem.time)
    if ended is None and solution.ended is not None and solution.ended.kind in ("singular", "end-of-chain", "lift-off"):
        ended = (solution.ended.kind, solution.ended.time)
    if ended is not None:
        answered = [one for one in answered if (one[0], one[2]) != ended]
    fault = _first_event(plain, answered, min(until, ended[1] if ended else np.inf), first)
    if fault is not None:
        verdict.differences.append(fault)
        return
    verdict.compared += len(plain)
    if ended is not None and ended[1] < until:
        right = first.ended
        apart = 0.0 if right is None or moved.ended is None else GROWN * abs(right.time - moved.ended.time)
        close = right is not None and abs(right.time - ended[1]) <= max(1e-7, 1e-6 * ended[1], apart)
        # What falls into a centre, or bodies that attract one another, come too close for the product to say where.
        pulled = right is not None and right.name in {one.name for one in first.mechanism.definitions if one.lawful}
        kinds = {ended[0], "singular"} if pulled and ended[0] == "lost-event" else {ended[0]}
        if right is None or not close or right.kind not in kinds:
            shown = "goes on" if right is None else f"{right.kind} {right.time:.12g}"
            verdict.differences.append(Difference("end", ended[0], shown, f"{ended[0]} {ended[1]:.12g}"))
            return
    elif first.ended is not None and first.ended.time < until * (1 - 1e-9):
        detail = first.ended.kind
        verdict.differences.append(
            Difference("end", f"goes on past {detail}", f"{detail} {first.ended.time:.12g}", "goes on")
        )
        return
    verdict.compared += first.ended is not None
    _samples(verdict, solution, first, moved, until)


def _known(first: Motion, moved: Motion, end: float) -> tuple[list[_Timed], float]:
    """Return the events with the tolerance of their times, and up to which time they are known."""
    found = []
    for k, one in enumerate(first.events):
        if k >= len(moved.events) or (moved.events[k].kind, moved.events[k].name) != (one.kind, one.name):
            return found, one.time * (1 - 1e-9)
        apart = abs(moved.events[k].time - one.time)
        found.append(_Timed(one.kind, one.name, one.time, GROWN * apart + one.error + RESOLVED * max(one.time, 0.01)))
    if len(moved.events) > len(first.events):
        return found, moved.events[len(first.events)].time * (1 - 1e-9)
    ends = [None if motion.ended is None else motion.ended.kind for motion in (first, moved)]
    if ends[0] != ends[1]:
        return found, min(motion.ended.time for motion in (first, moved) if motion.ended is not None) * (1 - 1e-9)
    return found, end


def _first_event(
    plain: list[_Timed], answered: list[tuple[str, str, float, float]], until: float, motion: Motion
) -> Difference | None:
    """Return the first event that one has and the other has not, up to a time."""
    left = list(answered)
    for one in plain:
        if one.time > until - one.tolerance:
            break
        same = [x for x in left if x[:2] == (one.kind, one.name) and abs(x[2] - one.time) <= one.tolerance + x[3]]
        if same:
            left.remove(same[0])
            continue
        # Bounces that accumulate are listed up to a number of them only.
        if one.kind in IMPACTS and _accumulates(one, answered):
            continue
        near = min((x for x in left if x[:2] == (one.kind, one.name)), key=lambda x: abs(x[2] - one.time), default=None)
        shown = "none" if near is None else f"{near[2]:.15g}"
        return Difference("event", f"{one.kind}", f"{one.kind} {one.name} {one.time:.12g} ({one.tolerance:.0e})", shown)
    known = max((one.tolerance for one in plain), default=1e-9)
    for kind, name, time, error in left:
        if 0.0 <= time < until - known - error and not any(_settles(x, name, time) for x in motion.events):
            return Difference("event", f"extra {kind}", "none", f"{kind} {name} {time:.12g}")
    return None


def _accumulates(one: _Timed, answered: list[tuple[str, str, float, float]]) -> bool:
    before = [x for x in answered if x[1] == one.name and x[0] == one.kind and x[2] < one.time]
    settles = any(x[0] == "settle" and x[1] == one.name and x[2] >= one.time - one.tolerance for x in answered)
    return settles and len(before) >= 3


def _settles(event: Event, name: str, time: float) -> bool:
    # The plain engine ends bounces early, and says their limit to a tenth of the time that they still take.
    return event.kind == "settle" and event.name == name and abs(event.time - time) < max(1e-4, 11 * event.error)


def _samples(verdict: Verdict, solution: SceneSolution, first: Motion, moved: Motion, until: float) -> None:
    trajectory = solution.trajectory
    assert trajectory is not None
    # At an event figures have two values, and at the last of the times it may be an event of one answer alone.
    events = [event.time for event in (*first.events, *solution.events)]
    mechanism = first.mechanism
    weights = mechanism.coordinates.weights(mechanism.coordinates.start(), mechanism.gravity)
    for k, time in enumerate(trajectory.time):
        t = float(time)
        if t > until or t not in first.states or t not in moved.states or any(abs(t - x) < 1e-6 for x in events):
            continue
        figures, other = (columns_of(mechanism, x.states[t]) for x in (first, moved))
        for name, value in figures.items():
            column = trajectory.columns.get(name)
            if column is None:
                continue
            shown = np.asarray(column.values[k], dtype=float)
            if name.endswith("attitude") and shown @ value < 0.0:
                shown = -shown
            size = max(float(np.max(np.abs(value))), _size(figures, name), LEAST)
            allowed = GROWN * float(np.max(np.abs(value - other[name]))) + RESOLVED * size + float(column.error)
            verdict.compared += 1
            if not float(np.max(np.abs(shown - value))) <= allowed:
                what = "place" if name.rsplit(".", 1)[1] in ("position", "angle", "attitude") else "rate"
                verdict.differences.append(
                    Difference(what, name.rsplit(".", 1)[1], [t, name, value.tolist(), allowed], shown.tolist())
                )
                return
        forces, others = first.forces[t], moved.forces[t]
        largest = max([abs(x) for x in forces.values()] + [float(np.abs(weights).max(initial=0.0))])
        for name, force in forces.items():
            column = trajectory.columns.get(name)
            if column is None or name not in others:
                continue
            shown = np.asarray(column.values[k], dtype=float)
            verdict.compared += 1
            allowed = GROWN * abs(force - others[name]) + 1e-8 * max(largest, LEAST) + float(column.error)
            if not abs(float(shown) - force) <= allowed:
                verdict.differences.append(
                    Difference("force", name.rsplit(".", 1)[1], [t, name, force, allowed], float(shown))
                )
                return


def _size(figures: Mapping[str, Any], name: str) -> float:
    suffix = name.rsplit(".", 1)[1]
    return max(float(np.max(np.abs(value))) for key, value in figures.items() if key.endswith(suffix)) or 1.0
