"""From a model that was read to the description of a scene, in the plane where it has joints of the plane alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from core.arrays import Floats
from core.interchange.draft import OF_THE_PLANE, Draft, DraftJoint
from core.interchange.frames import PARALLEL, parallel
from core.interchange.plane_scene_writing import PlaneSceneWriting
from core.interchange.scene_writing import SceneWriting, WrittenScene
from core.interchange.xml_reading import no_model

PLANES = ((2, (0, 1), 1.0), (1, (0, 2), -1.0), (0, (1, 2), 1.0))
"""Planes in which a model may move: the normal, which axes become x and y, the sign of turns about the normal."""


def scene_of(draft: Draft) -> WrittenScene:
    """Return the description of a model: `gravity`, `bodies`, `connections`, as `scene_from` reads it.

    Raises
    ------
    InvalidParameter
        For joints of the plane in a model that does not move in one, and bodies without mass that move, with the line.
    """
    special = next((joint for joint in draft.joints if joint.kind in OF_THE_PLANE), None)
    if special is None:
        return SceneWriting(draft).scene()
    plane = next((plane for plane in PLANES if _holds_in(draft, plane[0])), None)
    if plane is None:
        said = "these joints are joints of a model in a plane of coordinate axes, which this is not"
        raise no_model(special.line, said)
    return PlaneSceneWriting(draft, *plane).scene()


def _holds_in(draft: Draft, k: int) -> bool:
    """Return whether all moves in the plane across a coordinate axis."""
    normal = np.eye(3)[k]

    def within(direction: Floats) -> bool:
        return abs(float(direction @ normal)) < PARALLEL

    allowed: dict[str, Callable[[DraftJoint], bool]] = {
        "weld": lambda joint: True,
        "hinge": lambda joint: parallel(joint.axes[0], normal),
        "slide": lambda joint: within(joint.axes[0]),
        "planar": lambda joint: parallel(joint.axes[0], normal),
        "planar-particle": lambda joint: parallel(joint.axes[0], normal),
        "hinge-on-line": lambda joint: within(joint.axes[0]) and parallel(joint.axes[1], normal),
    }
    jointed = {joint.child for joint in draft.joints}
    heights = [
        float(at @ normal)
        for connection in draft.connections
        for places in connection.places.values()
        for _, at in (places if isinstance(places, list) else [places])
    ]
    return (
        all(joint.kind in allowed and allowed[joint.kind](joint) for joint in draft.joints)
        and jointed == set(draft.bodies)
        and within(draft.gravity)
        and float(np.ptp(heights or [0.0])) < PARALLEL
        and all(within(contact.normal) for contact in draft.contacts)
    )
