"""What goes through shared memory between the processes comes out as it went in."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from service.execution.worker import SMALL, Stored, map_shared_memory, spill_to_shared_memory
from service.responses.json_rows import array_size, written
from service.responses.json_stream import Document, composed
from service.routes import questions

ROUTE = questions()[0]
STRINGS = [[f"{i}.5", "-0.1", "3"] for i in range(SMALL // 8)]
NUMBERS = np.random.default_rng(7).normal(size=(3, SMALL)).T


def through_a_file(document: Document, file: Path) -> Document:
    travelling = spill_to_shared_memory(document, file)
    assert any(isinstance(part, Stored) for part in travelling.parts)
    return map_shared_memory(travelling, file)


@pytest.mark.parametrize("media", [None, "application/x-npz"])
def test_arrays_and_decimal_strings_pass_through_the_file(media: str | None, tmp_path: Path) -> None:
    answer = {"odd": np.arange(SMALL + 1, dtype=np.uint8), "text": STRINGS, "rows": NUMBERS, "few": ["1", "2"]}
    document = composed(ROUTE, answer, media)
    assert document.numbers == array_size(answer)
    found = through_a_file(document, tmp_path / "x")
    assert found.numbers == document.numbers
    assert b"".join(found.pieces()) == b"".join(document.pieces())
    if media is None:
        assert b"".join(found.pieces()) == written(answer)


def test_pieces_of_decimal_strings_are_short(tmp_path: Path) -> None:
    found = through_a_file(composed(ROUTE, {"text": STRINGS}, None), tmp_path / "x")
    assert max(map(len, found.pieces())) <= 262_144
    assert found.large
