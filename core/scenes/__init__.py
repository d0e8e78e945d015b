"""Constrained systems, one per file; the union is the catalogue."""

from __future__ import annotations

from typing import Annotated

from core.quantities import TaggedBy
from core.scenes.chain_on_wedge import ChainOnWedge
from core.scenes.rod_in_hole import RodInHole
from core.scenes.unwinding_shafts import UnwindingShafts

Scene = Annotated[UnwindingShafts | RodInHole | ChainOnWedge, TaggedBy("kind")]
