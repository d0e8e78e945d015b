"""What goes through shared memory between the processes comes out as it went in."""

from pathlib import Path

import numpy as np

from service.worker import SMALL, StoredText, _stored, restored
from service.writing import array_size, chunks, written

STRINGS = [[f"{i}.5", "-0.1", "3"] for i in range(SMALL)]


def test_arrays_and_decimal_strings_pass_through_the_file(tmp_path: Path) -> None:
    rows = np.random.default_rng(7).normal(size=(3, SMALL)).T
    answer = {"odd": np.arange(SMALL + 1, dtype=np.uint8), "text": STRINGS, "rows": rows, "few": ["1", "2"]}
    with (tmp_path / "x").open("xb") as out:
        stored = _stored(answer, out)
    assert isinstance(stored["text"], StoredText)
    assert stored["few"] == ["1", "2"]
    found = restored(stored, tmp_path / "x")
    assert found["rows"].tobytes() == np.ascontiguousarray(rows).tobytes()
    assert found["rows"].flags.aligned
    assert array_size(found) == array_size(answer)
    assert written(found) == written(answer) == b"".join(chunks(found))
