"""The catalogue of described scenes: the questions of examples/scenes, with what each shows and is compared with."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

INSTALLED = Path(__file__).parent / "scene_examples"
"""Where a wheel has the folder examples/scenes."""

CHECKOUT = Path(__file__).parents[2] / "examples" / "scenes"


@dataclass(frozen=True)
class CatalogueScene:
    """One scene of the catalogue.

    Attributes
    ----------
    title, topic : str
        As a gallery names it, and under what.
    asks : str
        The question that its motion answers.
    summary : str
        What it shows.
    model : str
        Name of the model that is found.
    reference : str
        What the tests compare it with.
    question : mapping
        As it is sent to ``POST /v1/scenes``.
    """

    title: str
    topic: str
    asks: str
    summary: str
    model: str
    reference: str
    question: Mapping[str, Any]


@cache
def scene_catalogue() -> Mapping[str, CatalogueScene]:
    """Return every described scene by name, in the order of the catalogue."""
    folder = INSTALLED if INSTALLED.is_dir() else CHECKOUT
    entries = tomllib.loads(folder.joinpath("catalogue.toml").read_text(encoding="utf-8"))
    return {
        name: CatalogueScene(**entry, question=json.loads(folder.joinpath(f"{name}.json").read_text(encoding="utf-8")))
        for name, entry in entries.items()
    }
