"""Documents: what is sent is the same whole and in pieces, whatever parts it is made of."""

from __future__ import annotations

import io
import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from service.responses import npz as archive
from service.responses.json_rows import CHUNK, ONE_PIECE, NotFinite, array_size, written
from service.responses.json_stream import ONE_TEXT, SLICE, Document, composed
from service.routing import PostRoute
from tests.drawn import draws
from tests.service.toy_routes import TOY

RNG = np.random.default_rng(20261121)
LARGE: dict[str, Any] = {
    "signature": {"source": "polhode"},
    "time": RNG.normal(size=ONE_PIECE + 1),
    "rows": RNG.normal(size=(3, ONE_PIECE)).T,
    "cube": RNG.normal(size=(2, 3, ONE_PIECE)),
    "faces": RNG.integers(-9, 9, (ONE_PIECE, 3)),
    "text": [["0.5", "-1"]] * ONE_PIECE,
    "few": np.arange(3.0),
    "nothing": None,
}


def drawn(question: dict[str, Any]) -> bytes:
    return b"<svg>%d</svg>" % len(question)


DRAWN = PostRoute("/x", "x", "", "", None, None, lambda q, b: {}, representations={"image/svg+xml": drawn})


@st.composite
def arrays(draw: st.DrawFn) -> np.ndarray[Any, Any]:
    """Arrays as answers hold them: of doubles or integers, of any layout, some longer than a chunk."""
    shape = draw(st.sampled_from([(1,), (7,), (CHUNK,), (CHUNK + 1,), (5, 3), (CHUNK, 3), (3, 2, 4), (2, CHUNK, 2)]))
    values = np.random.default_rng(draw(st.integers(0, 9))).normal(size=shape)
    if draw(st.booleans()):
        values = (1e6 * values).astype(np.int64)
    return {"as it is": values, "transposed": values.T, "Fortran": np.asfortranarray(values), "reversed": values[::-1]}[
        draw(st.sampled_from(["as it is", "transposed", "Fortran", "reversed"]))
    ]


TEXTS = st.builds(
    lambda character, size: bytes([character]) * size,
    st.integers(97, 122),
    st.sampled_from([0, 1, 2, 1000, SLICE - 1, SLICE, SLICE + 1, 3 * SLICE + 5]),
)
PARTS = st.lists(TEXTS | TEXTS.map(memoryview) | arrays(), min_size=1, max_size=5)


class TestDocument:
    @given(PARTS)
    @settings(deadline=None, derandomize=True, max_examples=draws(40))
    def test_pieces_are_the_whole_for_any_mix_of_parts(self, parts: list[Any]) -> None:
        document = Document(sum(part.size for part in parts if isinstance(part, np.ndarray)), tuple(parts))
        pieces = list(document.pieces())
        assert b"".join(pieces) == document.whole()
        assert list(document.pieces()) == pieces
        assert max(map(len, pieces), default=0) <= max(SLICE, 25 * CHUNK)
        assert all(map(len, pieces))
        # Part by part: text as it is, arrays as what the standard library reads as the same numbers.
        rest = document.whole()
        for part in parts:
            own = b"".join(Document(0, (part,)).pieces())
            assert rest.startswith(own)
            rest = rest[len(own) :]
            if isinstance(part, np.ndarray):
                assert json.loads(own) == part.tolist()
            else:
                assert own == part
        assert rest == b""

    @given(PARTS)
    @settings(deadline=None, derandomize=True, max_examples=20)
    def test_memory_is_that_of_its_parts(self, parts: list[Any]) -> None:
        assert Document(0, tuple(parts)).memory == sum(len(memoryview(part).tobytes()) for part in parts)

    def test_one_text_is_not_copied(self) -> None:
        text = b"x" * SLICE * 2
        assert Document(0, (text,)).whole() is text
        assert type(Document(0, (memoryview(text),)).whole()) is bytes
        assert all(isinstance(piece, memoryview) and piece.obj is text for piece in Document(0, (text,)).pieces())

    @pytest.mark.parametrize(
        ("numbers", "parts", "large"),
        [
            (0, (b"",), False),
            (ONE_PIECE, (b"x" * ONE_TEXT,), False),
            (ONE_PIECE + 1, (b"x",), True),
            (0, (b"x" * (ONE_TEXT + 1),), True),
            (0, (b"x" * ONE_TEXT, b"x"), True),
            (0, (memoryview(b"x" * ONE_TEXT), memoryview(b"x")), True),
            (ONE_PIECE + 1, (b"[", np.zeros(ONE_PIECE + 1), b"]"), True),
        ],
    )
    def test_large_is_what_has_many_numbers_or_much_text(
        self, numbers: int, parts: tuple[Any, ...], large: bool
    ) -> None:
        assert Document(numbers, parts).large is large


class TestComposed:
    def test_a_small_answer_is_one_text(self) -> None:
        answer = {"a": np.arange(float(ONE_PIECE)), "b": None}
        document = composed(TOY, answer, None)
        assert document.parts == (written(answer),)
        assert (document.numbers, document.large) == (ONE_PIECE, False)

    def test_a_large_answer_is_arrays_between_texts_and_reads_the_same(self) -> None:
        document = composed(TOY, LARGE, None)
        assert document.whole() == written(LARGE)
        assert (document.numbers, document.large) == (array_size(LARGE), True)
        kinds = [isinstance(part, np.ndarray) for part in document.parts]
        # No two texts stand side by side: each would be a message of its own between the processes.
        assert kinds == [i % 2 == 1 for i in range(len(kinds))]
        # What is kept of an array is its own memory, however it lies.
        assert [part for part in document.parts if part is LARGE["rows"]]
        texts = sum(len(part) for part in document.parts if not isinstance(part, np.ndarray))
        assert texts < 1.1 * len(json.dumps(LARGE["text"])) + 1000

    @pytest.mark.parametrize("size", [3, ONE_PIECE + 1])
    def test_an_archive_is_read_by_numpy(self, size: int) -> None:
        answer = {"time": RNG.normal(size=size), "name": "x"}
        document = composed(TOY, answer, archive.MEDIA_TYPE)
        assert document.numbers == size
        with np.load(io.BytesIO(document.whole())) as found:
            np.testing.assert_array_equal(found["time"], answer["time"])

    def test_other_representations_are_the_routes_own(self) -> None:
        document = composed(DRAWN, {"a": 1.0, "b": np.zeros(4)}, "image/svg+xml")
        assert (document.whole(), document.numbers, document.large) == (b"<svg>2</svg>", 4, False)

    @pytest.mark.parametrize("media", [None, archive.MEDIA_TYPE, "image/svg+xml"])
    @pytest.mark.parametrize("size", [3, ONE_PIECE + 1])
    @pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
    def test_what_is_not_finite_is_composed_in_no_way(self, media: str | None, size: int, bad: float) -> None:
        rows = np.zeros(size)
        rows[-1] = bad
        for answer in ({"a": rows}, {"a": np.zeros(size), "b": {"c": bad}}):
            with pytest.raises(NotFinite):
                composed(DRAWN, answer, media)
