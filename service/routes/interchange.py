"""POST /v1/scenes/import and /v1/scenes/export: described scenes as files of other programs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Literal

from pydantic import Field

from core.interchange.export_mjcf import export_mjcf
from core.interchange.export_modelica import export_modelica
from core.interchange.import_model import import_model
from core.interchange.left_out import LeftOutOfScene as Unwritten
from core.interchange.xml_reading import MOST_CHARACTERS
from core.multibody.language.scene import Scene
from core.systems.budget import Budget
from service.requests.described_scene import SceneDescription
from service.routing import Answer, PostRoute
from service.schemas import Envelope, Request, View, fields_of


class LeftOutOfFile(View):
    """An element of a document that the scene does not say."""

    line: int = Field(description="Of the document, from 1.")
    what: str = Field(description="The element, and its name if it has one.")
    why: str
    changes_motion: bool = Field(description="Whether the motion may be another without it.")


class LeftOutOfScene(View):
    """A part of a scene that the document does not say."""

    pointer: str = Field(description="JSON pointer into the scene.")
    what: str = Field(description="The name of the part.")
    why: str
    changes_motion: bool = Field(description="Whether the motion may be another without it.")


class ImportRequest(Request):
    """A document of another program."""

    document: str = Field(
        max_length=MOST_CHARACTERS,
        description="Text of a URDF, MJCF or SDF file, which its root element tells apart; without a document type, "
        "entities of its own and files that it includes.",
    )


class ImportAnswer(Envelope):
    """The scene that a document describes."""

    format: Literal["urdf", "mjcf", "sdf"]
    scene: dict[str, Any] = Field(description="As POST /v1/scenes takes it: gravity, bodies, connections.")
    left_out: list[LeftOutOfFile] = Field(description="What the scene does not say, in the order of the lines.")


class ExportRequest(SceneDescription):
    """A described scene, and the format of the document."""

    format: Literal["mjcf", "modelica"] = Field(
        description="mjcf: MuJoCo's XML. modelica: a model of the equations of motion, which needs no library."
    )


class ExportAnswer(Envelope):
    """A document of another program."""

    format: Literal["mjcf", "modelica"]
    document: str
    left_out: list[LeftOutOfScene] = Field(description="What the document does not say, in the order of the scene.")


EXPORTS: Mapping[str, Callable[[Scene], tuple[str, list[Unwritten]]]] = {
    "mjcf": export_mjcf,
    "modelica": export_modelica,
}


def imported(question: ImportRequest, budget: Budget) -> Answer:
    """Answer which scene a document describes."""
    found = import_model(question.document)
    listed = [fields_of(one) for one in found.left_out]
    return {"format": found.format, "scene": found.scene, "left_out": listed, "warnings": []}


def exported(question: ExportRequest, budget: Budget) -> Answer:
    """Answer which document describes a scene."""
    document, left_out = EXPORTS[question.format](question.scene())
    listed = [fields_of(one) for one in left_out]
    return {"format": question.format, "document": document, "left_out": listed, "warnings": []}


INTERCHANGE = (
    PostRoute(
        "/v1/scenes/import",
        "import_scene",
        "The scene that a URDF, MJCF or SDF file describes, and line by line what it does not say",
        "scenes",
        ImportRequest,
        ImportAnswer,
        imported,
        description="Links and bodies with their inertia, joints, damping, springs, tendons, the contacts of one "
        "geometry of a body with fixed planes, and of MJCF the configuration and velocities of the first keyframe. "
        "What a scene does not say is listed with its line; a model whose scene would have other joints is refused "
        "with the line.",
    ),
    PostRoute(
        "/v1/scenes/export",
        "export_scene",
        "A scene of your own as a file of another program, and part by part what that does not say",
        "scenes",
        ExportRequest,
        ExportAnswer,
        exported,
        description="MJCF: joints are a tree of bodies, in which MuJoCo holds them exactly; what closes loops, rods, "
        "strings and contacts are its soft constraints, as stiff as its time step allows. Velocities are those of the "
        'keyframe `start`. Modelica: the equations that `outputs: ["equations"]` answers, of the first phase of the '
        "motion, with places and forces as variables.",
    ),
)
