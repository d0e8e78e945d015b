"""The worked examples of the language, as a client writes them, and what tests read of an answer."""

from __future__ import annotations

import json
from typing import Any

from core.multibody.answer import SceneSolution
from core.multibody.language.reading import scene_from
from core.multibody.language.scene import Scene

MASSIVE_PULLEY = """{"gravity":[0,-9.81],"bodies":{"a":{"mass":1,"at":[-0.1,-1]},"b":{"mass":2,"at":[0.1,-1]},
"wheel":{"mass":0.5,"radius":0.1,"inertia":0.0025,"at":[0,0]}},"connections":[{"kind":"pin","a":"wheel","b":[0,0]},
{"kind":"string","name":"s","through":["a","wheel","b"],"sides":{"wheel":["left","right"]}}]}"""

YO_YO = """{"gravity":[0,-9.81],"bodies":{"yo-yo":{"mass":0.1,"radius":0.01,"inertia":4e-5,"at":[0.01,-0.5]}},
"connections":[{"kind":"string","name":"s","through":[[0,0],"yo-yo"],"sides":{"yo-yo":"left"}}]}"""

TWO_RODS = """{"gravity":[0,-9.81],"bodies":{"one":{"mass":1,"inertia":0.0833,"at":[0.5,0],
"places":{"top":[-0.5,0],"end":[0.5,0]}},"two":{"mass":1,"inertia":0.0833,"at":[1,0.5],"angle":{"degrees":90},
"places":{"top":[-0.5,0]}}},"connections":[{"kind":"pin","a":"one.top","b":[0,0]},
{"kind":"pin","a":"two.top","b":"one.end"}]}"""

BEAD_ON_HOOP = """{"gravity":[0,-9.81],"bodies":{"bead":{"mass":0.1,"at":[0.6,-0.8]}},"connections":[
{"kind":"rod","a":"bead","b":[0,0]},{"kind":"spinning-frame","rate":4}]}"""

LAGRANGE_TOP = """{"gravity":[0,0,-9.81],"bodies":{"top":{"mass":1,"moments":[0.01,0.01,0.004],"at":[0.12,0,0.16],
"axes":[[0.8,0,-0.6],[0,1,0],[0.6,0,0.8]],"angular_velocity":[0,0,200],"places":{"tip":[0,0,-0.2]}}},
"connections":[{"kind":"pin","a":"top.tip","b":[0,0,0]}]}"""


def read(text: str | dict[str, Any]) -> Scene:
    """Return the scene of a text of JSON, or of what it stands for."""
    return scene_from(json.loads(text) if isinstance(text, str) else text)


def points(
    lengths: tuple[Any, ...], angles: tuple[Any, ...], masses: tuple[Any, ...], gravity: Any = 9.81, rates: Any = None
) -> dict[str, Any]:
    """Return a plane pendulum of points: angles from the downward vertical, counter-clockwise."""
    bodies: dict[str, Any] = {}
    connections: list[dict[str, Any]] = []
    x, y, u, v, before = "0", "0", "0", "0", [0, 0]
    let = {}
    for i, (length, angle, mass) in enumerate(zip(lengths, angles, masses, strict=True)):
        let[f"x{i}"] = f"{x} + {length}*sin({angle})"
        let[f"y{i}"] = f"{y} - {length}*cos({angle})"
        x, y = f"x{i}", f"y{i}"
        body: dict[str, Any] = {"mass": mass, "at": [x, y]}
        if rates is not None:
            let[f"u{i}"] = f"{u} + {length}*cos({angle})*({rates[i]})"
            let[f"v{i}"] = f"{v} + {length}*sin({angle})*({rates[i]})"
            u, v = f"u{i}", f"v{i}"
            body["velocity"] = [u, v]
        bodies[f"p{i}"] = body
        connections.append({"kind": "rod", "name": f"r{i}", "a": f"p{i}", "b": before})
        before = f"p{i}"  # type: ignore[assignment]
    return {"gravity": [0, f"-{gravity}"], "let": let, "bodies": bodies, "connections": connections}


def column(answer: SceneSolution, name: str) -> Any:
    assert answer.trajectory is not None
    return answer.trajectory.columns[name]


def force(answer: SceneSolution, name: str) -> float:
    assert answer.forces is not None
    value = answer.forces[name].value
    assert value is not None
    return value


def linear(answer: SceneSolution, body: str) -> tuple[float, ...]:
    assert answer.accelerations is not None
    return answer.accelerations[body].linear
