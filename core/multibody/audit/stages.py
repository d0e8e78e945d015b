"""The stages of a motion in which connections begin and end: in each the same connections act.

A stage is compared with the connections that act in it. Those that have begun in it take from its start what
others take from that of the scene.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from core.errors import MechanicsError
from core.multibody.answer import SceneSolution
from core.multibody.audit.bodies import RigidBody
from core.multibody.audit.definition import Definition
from core.multibody.audit.definitions import Description, description_of
from core.multibody.audit.impacts import is_sudden
from core.multibody.audit.placement import Numbers, Placement, Pose
from core.multibody.audit.samples import Columns, Part, samples_of
from core.multibody.language.scene import Scene, part_of

Sampler = Callable[[Numbers, bool], Columns]
"""From times, and whether forces are wanted, to the columns of the motion that was answered."""


@dataclass(frozen=True)
class Stage:
    """A time in which the same connections act.

    Attributes
    ----------
    description : Description
        Of the connections that act, with bodies at their places at its start.
    answer : SceneSolution
        What is answered of it; accelerations, forces and the energy of the start in the first alone.
    whole : SceneSolution
        What is answered of the whole motion.
    instant : Description
        With the connections that have ended where it begins, after impulses of the same instant: these act on what
        holds or touches then.
    begin, end : float
        From the start of the scene (s).
    """

    description: Description
    answer: SceneSolution
    whole: SceneSolution
    instant: Description
    begin: float = 0.0
    end: float = inf

    def holds(self, times: Numbers) -> Numbers:
        """Return which times are in it; those before the start of the scene are in the first."""
        found: Numbers = (times < self.end) & ((times >= self.begin) | (self.begin == 0.0))
        return found


def stages_of(scene: Scene, answer: SceneSolution, sampler: Sampler) -> Iterator[Stage]:
    """Yield the stages of a motion, of a scene in which nothing begins or ends the whole."""
    answered = answer.phases[0].states if answer.phases else None
    if not scene.changes:
        description = description_of(scene, answered=answered)
        yield Stage(description, answer, answer, description)
        return
    acting = {name for name, one in zip(scene.names(), scene.connections, strict=True) if one.starts}
    numbers = {name: number for name, (number, _) in zip(scene.names(), scene.numbered(), strict=True)}
    elsewhere = tuple(place for one in description_of(scene, answered=answered).connections for place in one.places)
    changes = [event for event in answer.events if event.kind in ("begin", "end")]
    times = sorted({event.time for event in changes})
    ends = [*times, inf]
    known: dict[str, tuple[Definition, ...]] = {}
    bodies: Mapping[str, RigidBody] | None = None
    begun: dict[int, Placement] = {}
    for begin, end in zip([0.0, *times], ends, strict=True):
        now = [event for event in changes if event.time == begin]
        acting = (acting | {event.name for event in now if event.kind == "begin"}) - {
            event.name for event in now if event.kind == "end"
        }
        present = acting | _ended_after_impulses(answer, begin)
        known = {name: own for name, own in known.items() if name in present}
        part = part_of(scene, {numbers[name] for name in present})
        found = replace(description_of(part, answered=answered, bodies=bodies, begun=begun), elsewhere=elsewhere)
        begun = {numbers[name]: begun.get(numbers[name], found.start) for name in present}
        members = {name: tuple(one for one in found.connections if one.name.split(".")[0] == name) for name in present}
        known = {**members, **known}
        if begin < end:
            after, instant = (
                replace(
                    found,
                    connections=tuple(one for name in scene.names() if name in some for one in known[name]),
                    undefined={name: what for name, what in found.undefined.items() if name in some},
                )
                for some in (acting, present)
            )
            own = _of_stage(answer, begin, end)
            # Where a motion ends in the midst of what happens at one time, nothing of it comes afterwards.
            if begin == 0.0 or own.phases:
                yield Stage(after, own, answer, instant, begin, end)
        if end < inf:
            try:
                columns = sampler(np.array([end]), False)
            except MechanicsError:
                # Where the motion is not known as well as doubles are, what follows is not compared.
                return
            start = samples_of(found, [Part(np.array([end]), columns, slice(0, 1))])
            bodies = {
                name: replace(body, start=_first(start.placement[name], end), velocity=None)
                for name, body in found.bodies.items()
            }


def _ended_after_impulses(answer: SceneSolution, time: float) -> set[str]:
    """Return the connections that end at a time behind events with impulses, as events are in order."""
    found, struck = set[str](), False
    for event in answer.events:
        if event.time == time:
            # What begins may take impulses that are not determined, and so not listed.
            struck = struck or is_sudden(event) or event.kind in ("begin", "impulse")
            if event.kind == "end" and struck:
                found.add(event.name)
    return found


def _first(pose: Pose, time: float) -> Pose:
    position, rotation, turn, _ = pose
    return Pose(
        position[0], None if rotation is None else rotation[0], None if turn is None else turn[0], np.array(time)
    )


def _of_stage(answer: SceneSolution, begin: float, end: float) -> SceneSolution:
    """Return what is answered of a stage; searches are held against the whole motion with the first."""
    phases = tuple(
        replace(phase, end=end if phase.end is None and end < inf else phase.end)
        for phase in answer.phases or ()
        if begin <= phase.start < end
    )
    # What begins the stage happens before its first sample.
    events = tuple(event for event in answer.events if event.time < end and (event.time > begin or begin == 0.0))
    found = replace(answer, phases=phases, events=events)
    if begin == 0.0:
        # What can act begins and ends, and with it what counts as potential energy.
        searched = "energy.potential"
        return replace(
            found,
            occurrences=None
            if answer.occurrences is None
            else tuple(one for one in answer.occurrences if one.quantity != searched),
            extremes=None
            if answer.extremes is None
            else tuple(one for one in answer.extremes if one.quantity != searched),
        )
    return replace(
        found, accelerations=None, forces=None, energy=None, equilibria=None, occurrences=None, extremes=None
    )
