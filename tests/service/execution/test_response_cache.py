"""The cache of answers: which are cached, and how much they take."""

import tracemalloc

import pytest

from service.execution.response_cache import LARGEST, REMEMBERED, ResponseCache
from service.http.etag import Representation


def answer(k: int, length: int = 20) -> Representation:
    return Representation(b"%0*d" % (length, k))


def put(cache: ResponseCache, body: bytes, found: Representation) -> None:
    """Offer an answer for the second time."""
    for _ in range(2):
        cache.put("/a", body, found)


def test_an_answer_is_cached_when_its_question_comes_again() -> None:
    cache = ResponseCache(2)
    cache.put("/a", b"1", answer(1))
    assert cache.get("/a", b"1") is None
    cache.put("/a", b"1", answer(1))
    found = cache.get("/a", b"1")
    assert found is not None
    assert found.body == answer(1).body


def test_questions_that_come_once_drive_nothing_out() -> None:
    cache = ResponseCache(4)
    for k in range(4):
        put(cache, b"%d" % k, answer(k))
    for k in range(4, 300):
        cache.put("/a", b"%d" % k, answer(k))
    assert all(cache.get("/a", b"%d" % k) for k in range(4))


def test_what_was_used_last_stays() -> None:
    cache = ResponseCache(2)
    for k in (1, 2):
        put(cache, b"%d" % k, answer(k))
    cache.get("/a", b"1")
    put(cache, b"3", answer(3))
    assert [cache.get("/a", b"%d" % k) is not None for k in (1, 2, 3)] == [True, False, True]
    assert len(cache) == 2


def test_the_path_is_part_of_the_question() -> None:
    cache = ResponseCache(2)
    put(cache, b"1", answer(1))
    assert cache.get("/b", b"1") is None


@pytest.mark.parametrize(("most", "length", "cached"), [(0, 20, 0), (5, LARGEST, 0), (5, LARGEST - 1, 1)])
def test_none_is_cached_that_is_large_or_where_none_may_be(most: int, length: int, cached: int) -> None:
    cache = ResponseCache(most)
    put(cache, b"1", answer(1, length))
    assert len(cache) == cached


def test_the_memory_is_bounded() -> None:
    tracemalloc.start()
    try:
        cache = ResponseCache(100)
        for k in range(REMEMBERED // 8):
            put(cache, b"%d" % k, answer(k, LARGEST - 10))
        for k in range(3 * REMEMBERED):
            cache.put("/a", b"once %d" % k, answer(1))
        taken, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert len(cache) == 100
    # A hundred answers with 1 kB of objects each, and the hashes of what came once.
    assert taken < 100 * (LARGEST + 1_000) + 150 * REMEMBERED
