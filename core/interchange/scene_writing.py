"""From a model that was read to the description of a scene of space."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from core.arrays import Floats
from core.errors import Path
from core.interchange.draft import Draft, DraftBody, DraftConnection, DraftContact, DraftJoint, Ended
from core.interchange.left_out import LeftOutOfFile
from core.interchange.xml_reading import no_model, shortened
from core.multibody.language.numerals import LONGEST_NAME
from core.multibody.language.written import GROUND

DIGITS = 15
"""Significant digits of numbers that were turned or added in doubles: what these know."""


def _of_directions(one: Mapping[str, Any]) -> bool:
    """Return whether a connection needs the directions of the bodies that it names."""
    return one["kind"] in ("weld", "torsion-spring") or one.get("measure") == "turn"


def clean(values: Floats, size: float | None = None) -> list[float]:
    """Return numbers with the digits that doubles know after turns and sums, zero where nothing is left."""
    largest = float(np.abs(values).max(initial=0.0)) if size is None else size
    return [0.0 if abs(x) <= largest * 10.0**-DIGITS else float(f"{x:.{DIGITS}g}") for x in map(float, values)]


@dataclass(frozen=True)
class WrittenScene:
    """A scene and where it is from.

    Attributes
    ----------
    description : dict
        As `scene_from` reads it.
    lines : mapping of path to int
        Lines of the document by the paths of bodies and connections.
    """

    description: dict[str, Any]
    lines: Mapping[Path, int]


class SceneWriting:
    """Writes a scene of space.

    Parameters
    ----------
    draft : Draft
        Of which `left_out` grows by what a scene cannot say.
    """

    def __init__(self, draft: Draft) -> None:
        self.draft = draft
        self.names: dict[str, str] = {}
        self.taken = {GROUND}
        self.bodies: dict[str, dict[str, Any]] = {}
        self.turnless: list[DraftJoint] = []
        self.size = max((float(np.abs(body.frame.origin).max()) for body in draft.bodies.values()), default=0.0)

    def scene(self) -> WrittenScene:
        """Return the description with the lines of its parts."""
        lines = dict[Path, int]()
        carried = [name for name in self.draft.bodies if self.draft.carrier(name) == name]
        for name in carried:
            body = self.draft.bodies[name]
            if not body.massive:
                remedy = "give it a mass, or fix it to a body that has one"
                raise no_model(body.line, f"{shortened(name)} moves and has no mass", remedy)
            self.names[name] = self.named(name, "body")
            self.bodies[self.names[name]] = self.body(body)
            lines["bodies", self.names[name]] = body.line
        connections: list[dict[str, Any]] = []
        parts = [
            *((joint.line, self.joint(joint)) for joint in self.draft.joints if joint.child in self.names),
            *((one.line, [self.connection(one)]) for one in self.draft.connections),
            *((one.line, [self.contact(one)]) for one in self.draft.contacts),
        ]
        for line, made in parts:
            lines |= {("connections", len(connections) + k): line for k in range(len(made))}
            connections += made
        whole = [end for one in connections if _of_directions(one) for end in (one["a"], one["b"])]
        for joint in self.turnless:
            self.without_turn(joint, whole)
        scene = {"gravity": self.vector(self.draft.gravity, 0.0), "bodies": self.bodies}
        return WrittenScene(scene | ({"connections": connections} if connections else {}), lines)

    def named(self, given: str, kind: str) -> str:
        """Return a name that a scene may have, and that nothing else has."""
        plain = re.sub("[^A-Za-z0-9_-]+", "-", given)[: LONGEST_NAME - 5].strip("-")
        plain = plain if re.match("[A-Za-z]", plain) else f"{kind}-{plain}".strip("-")
        found, k = plain, 2
        while found in self.taken:
            found, k = f"{plain}-{k}", k + 1
        self.taken.add(found)
        return found

    def body(self, body: DraftBody) -> dict[str, Any]:
        """Return a body; its axes are those of its frame."""
        written: dict[str, Any] = {"mass": body.mass, "at": self.vector(body.frame.point(body.centre))}
        if body.tensor.any():
            written |= self.inertia(body)
        if self.draft.moves:
            arm = body.frame.direction(body.centre)
            turned = np.cross(body.angular_velocity, arm)
            # What is left of terms that cancel is no velocity.
            size = float(np.linalg.norm(body.velocity) + np.linalg.norm(turned))
            size += float(np.linalg.norm(body.angular_velocity)) * (self.size + float(np.linalg.norm(arm)))
            written["velocity"] = self.vector(body.velocity + turned, size)
            if body.tensor.any():
                written["angular_velocity"] = self.turning(body)
        if body.shape is not None:
            written["shape"] = self.shape(body)
        return written

    def shape(self, body: DraftBody) -> dict[str, Any]:
        """Return what touches of a body."""
        assert body.shape is not None, "asked of bodies that touch"
        return body.shape

    def inertia(self, body: DraftBody) -> dict[str, Any]:
        """Return the inertia of a body and its attitude."""
        rows = [clean(row, float(np.abs(body.tensor).max())) for row in body.tensor]
        diagonal = not (body.tensor - np.diag(np.diag(body.tensor))).any()
        found: dict[str, Any] = {"moments": [rows[i][i] for i in range(3)]} if diagonal else {"tensor": rows}
        if not np.array_equal(body.frame.rotation, np.eye(3)):
            found["axes"] = [clean(axis, 1.0) for axis in body.frame.rotation.T]
        return found

    def turning(self, body: DraftBody) -> Any:
        """Return the angular velocity of a body as a scene has it."""
        return clean(body.frame.rotation.T @ body.angular_velocity)

    def vector(self, values: Floats, size: float | None = None) -> list[float]:
        """Return a vector of space; `size` is that of what it is a difference of."""
        return clean(values, max(self.size if size is None else size, float(np.abs(values).max())))

    def direction(self, values: Floats, body: str | None = None) -> list[float]:
        """Return a direction, along the axes of a body if it is one's."""
        rotation = np.eye(3) if body is None else self.draft.bodies[body].frame.rotation
        return clean(rotation.T @ values, 1.0)

    def place(self, place: Ended, called: str) -> Any:
        """Return a place of a body, which is entered there, or of the ground."""
        name, at = self.draft.carrier(place[0]), place[1]
        if name is None:
            return self.vector(at)
        body, own = self.draft.bodies[name], self.bodies[self.names[name]]
        inside = self.inside(body, at)
        if not np.any(np.abs(inside) > 10.0**-DIGITS * max(self.size, float(np.abs(at).max()))):
            return self.names[name]
        places = own.setdefault("places", {})
        spot = clean(inside, max(self.size, float(np.abs(inside).max())))
        spot_name, k = called[: LONGEST_NAME - 5], 2
        while places.get(spot_name, spot) != spot:
            spot_name, k = f"{called[: LONGEST_NAME - 5]}-{k}", k + 1
        places[spot_name] = spot
        return f"{self.names[name]}.{spot_name}"

    def inside(self, body: DraftBody, at: Floats) -> Floats:
        """Return the coordinates of a point from the centre of mass, along the axes of the body."""
        return body.frame.inside(at) - body.centre

    def whole(self, name: str | None) -> str:
        """Return the name of a body for what is between bodies, or that of the ground."""
        carrier = self.draft.carrier(name)
        return GROUND if carrier is None else self.names[carrier]

    def joint(self, joint: DraftJoint) -> list[dict[str, Any]]:
        """Return the connections of a joint."""
        if min(joint.damping, joint.stiffness) < 0.0:
            raise no_model(joint.line, f"{shortened(joint.name)} has a negative damping or stiffness")
        name = self.named(joint.name, "joint")
        a = self.place((joint.child, joint.at), name)
        b = self.place((joint.parent, joint.at), name)
        ends: dict[str, Any] = {"name": name, "a": a, "b": b}
        parent = self.draft.carrier(joint.parent)
        found = self.held(joint, ends, parent)
        if joint.kind in ("hinge", "hinge-on-line") and joint.damping:
            turn = {"a": self.whole(joint.child), "b": self.whole(joint.parent)}
            found.append({"kind": "damper", **turn, "measure": "turn", "coefficient": joint.damping})
        if joint.kind in ("hinge", "hinge-on-line") and joint.stiffness:
            found += self.torsion(joint)
        if joint.kind == "slide" and (joint.damping or joint.stiffness):
            found += self.along(joint, parent)
        return found

    def held(self, joint: DraftJoint, ends: dict[str, Any], parent: str | None) -> list[dict[str, Any]]:
        """Return what a joint holds; `ends` are its name and places."""
        axes = [self.direction(axis) for axis in joint.axes]
        on = {"name": ends["name"], "place": ends["a"]}
        match joint.kind:
            case "weld":
                return [{"kind": "weld", **ends}]
            case "hinge":
                return [{"kind": "pin", **ends, "axis": axes[0]}]
            case "slide":
                return [{"kind": "slider", **ends, "direction": self.direction(joint.axes[0], parent)}]
            case "ball":
                return [{"kind": "ball-joint", **ends}]
            case "cylindrical":
                return [{"kind": "cylindrical", **ends, "axis": axes[0]}]
            case "universal":
                # The first axis of the file is fixed in the parent, which is `b` here.
                return [{"kind": "universal", **ends, "axes": axes[::-1]}]
            case "on-line":
                along = self.direction(joint.axes[0], parent)
                return [{"kind": "track", **on, "on": {"at": ends["b"], "direction": along}}]
            case "on-plane":
                across = self.direction(joint.axes[0], parent)
                return [{"kind": "track", **on, "on": {"at": ends["b"], "normal": across}}]
            case "planar-particle":
                on["place"] = self.names[joint.child]
                across = self.direction(joint.axes[0], parent)
                track = {"kind": "track", **on, "on": {"at": self.bodies[on["place"]]["at"], "normal": across}}
                self.turnless.append(joint)
                return [track]
        self.turnless.append(joint)
        return []

    def without_turn(self, joint: DraftJoint, whole: Collection[object]) -> None:
        """Make a body that does not turn a particle, once all is known that is at its places or of its direction."""
        name = self.names[joint.child]
        body = self.bodies[name]
        carries = any(other.parent == joint.child for other in self.draft.joints)
        if carries or name in whole or "places" in body or "shape" in body:
            self.draft.left_out.append(
                LeftOutOfFile(joint.line, joint.name, "nothing holds its direction here: it may turn")
            )
            return
        for field in ("moments", "tensor", "inertia", "axes", "angle", "angular_velocity"):
            body.pop(field, None)

    def torsion(self, joint: DraftJoint) -> list[dict[str, Any]]:
        """Return the spring of the turn of a hinge, which is zero at the start."""
        ends = {"a": self.whole(joint.child), "b": self.whole(joint.parent)}
        return [{"kind": "torsion-spring", **ends, "stiffness": joint.stiffness, "rest_angle": joint.rest}]

    def along(self, joint: DraftJoint, parent: str | None) -> list[dict[str, Any]]:
        """Return the force of a spring and a damper along a slide on the ground."""
        if parent is not None:
            why = "there is no spring or damper along a slider between two bodies"
            self.draft.left_out.append(LeftOutOfFile(joint.line, joint.name, why))
            return []
        axis, at = self.direction(joint.axes[0]), self.vector(joint.at)
        names = "xyz"[: len(axis)]
        way = " + ".join(f"({n!r})*({x} - ({p!r}))" for n, x, p in zip(axis, names, at, strict=True) if n)
        rate = " + ".join(f"({n!r})*v{x}" for n, x in zip(axis, names, strict=True) if n)
        pull = f"-({joint.stiffness!r})*({way} - ({joint.rest!r})) - ({joint.damping!r})*({rate})"
        place = self.place((joint.child, joint.at), joint.name)
        return [{"kind": "force", "place": place, "force": [f"({n!r})*({pull})" if n else 0 for n in axis]}]

    def connection(self, one: DraftConnection) -> dict[str, Any]:
        """Return a connection between places."""
        name = self.named(one.name, one.fields["kind"])
        ends: dict[str, Any] = {}
        for field, places in one.places.items():
            listed = isinstance(places, list)
            found = [self.place(place, name) for place in (places if isinstance(places, list) else [places])]
            ends[field] = found if listed else found[0]
        return {"name": name, **ends, **one.fields}

    def contact(self, one: DraftContact) -> dict[str, Any]:
        """Return the contact of a body that has a shape with a fixed plane."""
        return {
            "kind": "contact",
            "name": self.named(f"{one.body}-on-plane", "contact"),
            "place": self.names[one.body],
            "on": {"at": self.vector(one.at), "normal": self.direction(one.normal)},
            "friction": one.friction,
        }
