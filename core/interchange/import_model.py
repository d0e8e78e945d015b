"""A file of another program read as a scene."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from core.balls import precision
from core.errors import InvalidParameter
from core.interchange.draft import Draft
from core.interchange.left_out import LeftOutOfFile
from core.interchange.mjcf import read_mjcf
from core.interchange.scene_of_draft import scene_of
from core.interchange.scene_writing import WrittenScene
from core.interchange.sdf import read_sdf
from core.interchange.urdf import read_urdf
from core.interchange.xml_reading import DOCUMENT, Element, no_model, read_xml, shortened
from core.multibody.algebra.polynomials import BITS
from core.multibody.language.reading import scene_from
from core.multibody.table.description import described

Format = Literal["urdf", "mjcf", "sdf"]
"""Formats that are read."""

READERS: Mapping[str, tuple[Format, Callable[[Element], Draft]]] = {
    "robot": ("urdf", read_urdf),
    "mujoco": ("mjcf", read_mjcf),
    "sdf": ("sdf", read_sdf),
}
"""By the name of the root element, which tells the formats apart."""


@dataclass(frozen=True)
class ImportedModel:
    """A scene that was read.

    Attributes
    ----------
    format : str
    scene : dict
        Its description, as `POST /v1/scenes` takes it.
    left_out : list of LeftOutOfFile
        In the order of the lines.
    """

    format: Format
    scene: dict[str, Any]
    left_out: list[LeftOutOfFile]


def import_model(text: str) -> ImportedModel:
    """Return the scene that a document in URDF, MJCF or SDF describes.

    Raises
    ------
    InvalidParameter
        For what is no XML, another format, or a model of which the scene would be another one, with the line.
    """
    root = read_xml(text)
    if root.name not in READERS:
        raise InvalidParameter(
            DOCUMENT,
            f"be URDF (<robot>), MJCF (<mujoco>) or SDF (<sdf>), not {shortened(root.name)}",
            remedy="xacro files are expanded to URDF first" if "xacro" in root.name else None,
        )
    name, reader = READERS[root.name]
    draft = reader(root)
    if not draft.bodies:
        raise InvalidParameter(DOCUMENT, f"have a body that moves; line {root.line}: <{root.name}> has none")
    written = scene_of(draft)
    _require_scene(written, root)
    return ImportedModel(name, written.description, sorted(draft.left_out, key=lambda one: one.line))


def _require_scene(written: WrittenScene, root: Element) -> None:
    """Refuse a scene that cannot be here, where its file is at hand."""
    try:
        scene = scene_from(written.description)
        with precision(BITS):
            described(scene, one_sided=True, sketch=True)
    except InvalidParameter as wrong:
        first, *further = (
            no_model(written.lines.get(one.path[:2], root.line), f"in its scene {one.detail}", one.remedy)
            for one in (wrong, *wrong.further)
        )
        first.further = tuple(further)
        raise first from wrong
