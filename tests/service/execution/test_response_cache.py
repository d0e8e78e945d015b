"""Answers that are kept: which stay, and what all of them take."""

import tracemalloc

from service.execution.response_cache import DOOR, OVERHEAD, SMALL, ResponseCache
from service.http.etag import Representation


def answer(k: int, length: int = 20) -> Representation:
    return Representation(b"%0*d" % (length, k))


def put(kept: ResponseCache, body: bytes, found: Representation) -> None:
    """Offer an answer for the second time."""
    for _ in range(2):
        kept.put("/a", body, found)


def test_an_answer_is_kept_when_its_question_comes_again() -> None:
    kept = ResponseCache(2, 10**6)
    kept.put("/a", b"1", answer(1))
    assert kept.get("/a", b"1") is None
    kept.put("/a", b"1", answer(1))
    assert kept.get("/a", b"1") is not None


def test_questions_that_come_once_drive_nothing_out() -> None:
    kept = ResponseCache(4, 10**6)
    for k in range(4):
        put(kept, b"%d" % k, answer(k))
    for k in range(4, 300):
        kept.put("/a", b"%d" % k, answer(k))
    assert all(kept.get("/a", b"%d" % k) for k in range(4))


def test_what_was_asked_once_long_ago_is_new_again() -> None:
    kept = ResponseCache(10**6, 10**9)
    for k in range(DOOR):
        kept.put("/a", b"%d" % k, answer(k))
    # A quarter of the places are taken at most, an eighth on average.
    assert len(kept) < DOOR // 4


def test_what_was_asked_for_last_stays() -> None:
    kept = ResponseCache(2, 10**6)
    for k in (1, 2):
        put(kept, b"%d" % k, answer(k))
    found = kept.get("/a", b"1")
    assert found is not None
    assert found.text == answer(1).text
    put(kept, b"3", answer(3))
    assert [kept.get("/a", b"%d" % k) is not None for k in (1, 2, 3)] == [True, False, True]
    assert len(kept) == 2


def test_the_path_is_part_of_the_question() -> None:
    kept = ResponseCache(2, 10**6)
    put(kept, b"1", answer(1))
    assert kept.get("/b", b"1") is None


def test_none_are_kept_where_there_is_no_room() -> None:
    for kept in (ResponseCache(0, 10**6), ResponseCache(5, 0), ResponseCache(5, OVERHEAD)):
        put(kept, b"1", answer(1))
        assert (len(kept), kept.bytes) == (0, 0)


def test_large_ones_are_not_kept() -> None:
    kept = ResponseCache(5, 10**6)
    put(kept, b"1", answer(1, SMALL))
    assert len(kept) == 0
    put(kept, b"1", answer(1, SMALL - 1))
    assert len(kept) == 1


def test_a_question_answered_twice_at_a_time_counts_once() -> None:
    kept = ResponseCache(5, 10**6)
    for _ in range(3):
        kept.put("/a", b"1", answer(1))
    assert (len(kept), kept.bytes) == (1, 1 + 20 + OVERHEAD)


def test_the_oldest_make_room_for_bytes() -> None:
    kept = ResponseCache(1000, 3 * (21 + OVERHEAD))
    for k in range(9):
        put(kept, b"%d" % k, answer(k))
    assert [kept.get("/a", b"%d" % k) is not None for k in range(9)] == [False] * 6 + [True] * 3
    assert kept.bytes == 3 * (21 + OVERHEAD)


def test_the_bound_is_that_of_the_memory_taken() -> None:
    for length in (1, 100, 1000, 8000):
        most = 2_000_000
        kept = ResponseCache(10**9, most)
        tracemalloc.start()
        try:
            for k in range(5000):
                put(kept, b"%0*d" % (100, k), answer(k, length))
            taken, _ = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
        assert 0 < len(kept) < 5000
        assert most // 4 < taken <= most
