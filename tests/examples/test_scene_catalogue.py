"""The catalogue of described scenes: complete, as documented, and the same when a scene is described otherwise."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from core.multibody.language.reading import scene_from
from core.multibody.solve import DEFAULT_OUTPUTS, solve_scene
from service.routes.scene_catalogue import scene_catalogue

ROOT = Path(__file__).parents[2]
SCENES = scene_catalogue()
PLANE = [name for name, one in SCENES.items() if len(next(iter(one.question["bodies"].values()))["at"]) != 3]

MASSES = (
    "mass",
    "inertia",
    "moments",
    "tensor",
    "stiffness",
    "coefficient",
    "strength",
    "force",
    "impulse",
    "torque",
    "law",
    "density",
)
MIRRORED = {"left": "right", "right": "left"}


def test_every_file_is_in_the_catalogue():
    files = {file.stem for file in (ROOT / "examples" / "scenes").glob("*.json")}
    assert files == set(SCENES)
    assert len(SCENES) >= 40


def test_the_table_of_the_documentation_is_the_catalogue():
    lines = (ROOT / "docs" / "physics" / "scene-catalogue.md").read_text().splitlines()
    table = [line for line in lines if "](../../examples/scenes/" in line]
    # All have a thumbnail but the one that has no motion.
    assert table == [
        f"| {'' if one.model == 'undecided' else f'![](../pictures/scenes/{name}.svg)'} "
        f"| [{name}](../../examples/scenes/{name}.json) | {one.summary} | {one.model} | {one.reference} |"
        for name, one in SCENES.items()
    ]


def solved(question: Any, *, factor: float = 1.0) -> Any:
    """Return the answer about a scene at its times."""
    scene = {key: value for key, value in question.items() if key not in ("times", "outputs")}
    times = factor * np.linspace(question["times"]["start"], question["times"]["stop"], question["times"]["count"])
    return solve_scene(scene_from(scene), times, DEFAULT_OUTPUTS)


def of_heavier(occasion: Any) -> Any:
    """Return an occasion of the same scene with four times the mass: a tension is four times as large."""
    when = occasion.get("when", {}) if isinstance(occasion, dict) else {}
    if not when.get("quantity", "").endswith(".tension"):
        return occasion
    return {"when": when | {"equals": times_four(when["equals"])}}


def times_four(value: Any) -> Any:
    return [times_four(entry) for entry in value] if isinstance(value, list) else f"4*({value})"


@pytest.mark.parametrize("name", SCENES)
def test_its_model_is_found_and_four_times_the_mass_under_other_names_moves_alike(name):
    question = json.loads(json.dumps(SCENES[name].question))
    first = solved(question)
    assert first.model.name == SCENES[name].model

    def renamed(value: Any) -> Any:
        """Put "z-" before the names of bodies."""
        if isinstance(value, dict):
            return {renamed(key): renamed(entry) for key, entry in value.items()}
        if isinstance(value, list):
            return [renamed(entry) for entry in value]
        known = isinstance(value, str) and value.partition(".")[0] in question["bodies"]
        return f"z-{value}" if known else value

    other = question | {"bodies": {}, "connections": []}
    for body, fields in reversed(question["bodies"].items()):
        heavier = {key: times_four(value) if key in MASSES else value for key, value in fields.items()}
        other["bodies"][f"z-{body}"] = heavier
    for i, fields in enumerate(question.get("connections", [])):
        stiffer = {key: times_four(value) if key in MASSES else renamed(value) for key, value in fields.items()}
        if "constant" in fields:
            # Attraction grows with the square of the masses.
            stiffer["constant"] = f"({fields['constant']})/4"
        stiffer |= {key: of_heavier(stiffer[key]) for key in ("from", "until") if key in stiffer}
        other["connections"].append({"name": f"{fields['kind']}-{i + 1}"} | stiffer)
    second = solved(other)
    assert second.model.name == first.model.name
    for column, values in first.trajectory.columns.items():
        alike = second.trajectory.columns[f"z-{column}"]
        away = (alike.values - values.values).reshape(len(values.values), -1)
        assert np.linalg.norm(away, axis=1).max() <= values.error + alike.error
    for force, value in first.forces.items():
        if not value.determined:
            assert not second.forces[force].determined
            continue
        assert second.forces[force].value == pytest.approx(4 * value.value, rel=1e-14, abs=1e-13)


def negative(value: Any) -> Any:
    """Return an angle or a number with the other sign."""
    return {"degrees": negative(value["degrees"])} if isinstance(value, dict) else f"-({value})"


def reflected(vector: Any) -> Any:
    if isinstance(vector, dict):
        r, angle = vector["polar"]
        half = {"degrees": 180 - angle["degrees"]} if isinstance(angle, dict) else f"pi - ({angle})"
        return {"polar": [r, half]}
    return [negative(vector[0]), vector[1]]


def mirrored(question: Any) -> Any:
    """Return a scene of the plane as a mirror shows it: left is right, and what turned to the left turns to the right.

    A body's first axis keeps its side, so that its angle is the negative one and its places have the other first entry.
    """
    bodies: dict[str, Any] = {}
    for name, fields in question["bodies"].items():
        body = dict(fields)
        for key in ("at", "velocity"):
            if key in body:
                body[key] = reflected(body[key])
        for key in ("angle", "angular_velocity"):
            if key in body:
                body[key] = negative(body[key])
        body["places"] = {place: reflected(vector) for place, vector in fields.get("places", {}).items()}
        bodies[name] = body
    connections = []
    for fields in question.get("connections", []):
        found: dict[str, Any] = {}
        for key, value in fields.items():
            if key in ("a", "b", "place", "force", "impulse") and not isinstance(value, str):
                found[key] = reflected(value)
            elif key in ("rate", "rest_angle", "slope", "torque"):
                found[key] = negative(value)
            elif key in ("at_least", "at_most"):
                found["at_most" if key == "at_least" else "at_least"] = negative(value)
            elif key == "through":
                found[key] = [entry if isinstance(entry, str) else reflected(entry) for entry in value]
            elif key == "on":
                at = value["at"] if isinstance(value["at"], str) else reflected(value["at"])
                found[key] = value | {"at": at} | ({"slope": negative(value["slope"])} if "slope" in value else {})
            elif key == "sides":
                found[key] = {
                    drum: [MIRRORED.get(side, side) for side in ([sides] if isinstance(sides, str) else sides)]
                    for drum, sides in value.items()
                }
            else:
                found[key] = value
        connections.append(found)
    gravity = {"gravity": reflected(question["gravity"])} if "gravity" in question else {}
    return question | gravity | {"bodies": bodies, "connections": connections}


@pytest.mark.parametrize("name", PLANE)
def test_its_mirror_image_moves_as_its_mirror_image(name):
    question = json.loads(json.dumps(SCENES[name].question))
    first, second = solved(question), solved(mirrored(question))
    assert second.model.name == first.model.name
    for column, values in first.trajectory.columns.items():
        sign = np.array([-1.0, 1.0]) if values.values.ndim == 2 else -1.0
        alike = second.trajectory.columns[column]
        away = (alike.values - sign * values.values).reshape(len(values.values), -1)
        assert np.linalg.norm(away, axis=1).max() <= values.error + alike.error
