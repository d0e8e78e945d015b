"""From a model that was read to the description of a scene in a plane of coordinate axes."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.arrays import Floats
from core.interchange.draft import Draft, DraftBody, DraftJoint
from core.interchange.scene_writing import SceneWriting, clean
from core.interchange.xml_reading import no_model, shortened


class PlaneSceneWriting(SceneWriting):
    """Writes a scene of a plane of coordinate axes."""

    def __init__(self, draft: Draft, normal: int, axes: tuple[int, int], sign: float) -> None:
        super().__init__(draft)
        self.normal, self.axes, self.sign = normal, list(axes), sign

    def _angle(self, name: str) -> float:
        """Return the angle of the first axis of a body that lies in the plane."""
        x, y = self.draft.bodies[name].frame.rotation[self.axes, self.axes[0]]
        return float(np.arctan2(y, x)) if np.hypot(x, y) > 0.5 else 0.0

    def inertia(self, body: DraftBody) -> dict[str, Any]:
        """See `SceneWriting.inertia`."""
        moment = float((body.frame.rotation @ body.tensor @ body.frame.rotation.T)[self.normal, self.normal])
        angle = self._angle(body.name)
        return {"inertia": moment} | ({"angle": angle} if angle else {})

    def turning(self, body: DraftBody) -> Any:
        """See `SceneWriting.turning`."""
        return float(self.sign * body.angular_velocity[self.normal])

    def vector(self, values: Floats, size: float | None = None) -> list[float]:
        """See `SceneWriting.vector`."""
        return super().vector(values[self.axes], size)

    def _turned(self, values: Floats, name: str) -> Floats:
        c, s = np.cos(self._angle(name)), np.sin(self._angle(name))
        x, y = values[self.axes]
        return np.array([c * x + s * y, c * y - s * x])

    def direction(self, values: Floats, body: str | None = None) -> list[float]:
        """See `SceneWriting.direction`."""
        return clean(values[self.axes] if body is None else self._turned(values, body), 1.0)

    def inside(self, body: DraftBody, at: Floats) -> Floats:
        """See `SceneWriting.inside`."""
        return self._turned(at - body.frame.point(body.centre), body.name)

    def held(self, joint: DraftJoint, ends: dict[str, Any], parent: str | None) -> list[dict[str, Any]]:
        """See `SceneWriting.held`."""
        match joint.kind:
            case "hinge":
                return [{"kind": "pin", **ends}]
            case "planar":
                return []
            case "planar-particle":
                self.turnless.append(joint)
                return []
            case "hinge-on-line":
                x, y = self.direction(joint.axes[0], parent)
                slope = {"degrees": 90} if x == 0.0 else float(np.arctan2(y, x))
                on = {"at": ends["b"], "slope": slope}
                return [{"kind": "track", "name": ends["name"], "place": ends["a"], "on": on}]
        return super().held(joint, ends, parent)

    def torsion(self, joint: DraftJoint) -> list[dict[str, Any]]:
        """See `SceneWriting.torsion`; in the plane angles are those of the bodies."""
        turn = self._angle(joint.child) - (0.0 if joint.parent is None else self._angle(joint.parent))
        sign = self.sign * float(np.sign(joint.axes[-1][self.normal]))
        spring = {"kind": "torsion-spring", "a": self.whole(joint.child), "b": self.whole(joint.parent)}
        return [{**spring, "stiffness": joint.stiffness, "rest_angle": turn + sign * joint.rest}]

    def shape(self, body: DraftBody) -> dict[str, Any]:
        """See `SceneWriting.shape`."""
        if body.shape is None or body.shape["kind"] != "ball":
            raise no_model(body.line, f"{shortened(body.name)} must be a ball to touch something in a plane")
        return {"kind": "disc", "radius": body.shape["radius"]}
