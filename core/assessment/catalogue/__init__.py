"""The catalogue of recognised mistakes; the tags are stable, and each entry is one line of one of the modules."""

from __future__ import annotations

from core.assessment.catalogue.bodies import OF_BODIES
from core.assessment.catalogue.general import GENERAL
from core.assessment.catalogue.rotation import OF_ROTATION
from core.assessment.catalogue.scenes import OF_SCENES
from core.assessment.mistakes import Mistake

MISTAKES: tuple[Mistake, ...] = (*OF_ROTATION, *OF_SCENES, *OF_BODIES, *GENERAL)
"""What explains a value by the question first: of two entries with the same value the first is shown first."""

__all__ = ["MISTAKES"]
