"""Messages arrive as they were sent, and large parts are not copied on the way."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from service.execution.messages import ALIGNMENT, LENGTH, apart, decoded, encoded
from service.responses.json_stream import Document


def carried(message: Any) -> Any:
    whole = b"".join(encoded(message))
    assert int.from_bytes(whole[:LENGTH], "little") == len(whole) - LENGTH
    buffer = np.empty(len(whole) - LENGTH, np.uint8)
    buffer[:] = np.frombuffer(whole, np.uint8, offset=LENGTH)
    return decoded(buffer.data)


@pytest.mark.parametrize("message", [0.25, "text", None, {"a": [1, 2]}, b"", b"x" * 100_000])
def test_messages_arrive_as_they_were_sent(message: Any) -> None:
    assert carried(message) == message


@pytest.mark.parametrize("shape", [(0,), (7,), (1000, 3), (2, 0)])
def test_arrays_arrive_to_the_bit_and_where_they_are_used(shape: tuple[int, ...]) -> None:
    array = np.random.default_rng(1).normal(size=shape)
    for sent in (array, array[::-1], np.asfortranarray(array)):
        found = carried(Document(3, (b"[", sent, b"]"))).parts[1]
        np.testing.assert_array_equal(found, sent)
        assert found.flags.aligned


def test_large_texts_travel_beside_the_pickle() -> None:
    text = bytes(range(256)) * 300
    sent = Document(0, apart((b"{", text, memoryview(text), b"}"), 65_536))
    parts = encoded(sent)
    assert sum(len(part) == len(text) for part in parts) == 2
    assert all(np.shares_memory(np.frombuffer(part), np.frombuffer(text)) for part in parts if len(part) == len(text))
    first, *large, last = carried(sent).parts
    assert (first, last) == (b"{", b"}")
    assert [bytes(part) for part in large] == [text, text]
    assert sum(map(len, parts)) % ALIGNMENT == LENGTH
