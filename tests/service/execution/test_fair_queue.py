"""Clients have their turns in rotation, and each its own in order."""

from __future__ import annotations

from typing import TypeVar

from hypothesis import given
from hypothesis import strategies as st

from service.execution.fair_queue import FairQueue

T = TypeVar("T")


def anybody(entry: object) -> bool:
    return True


def drained(queue: FairQueue[T]) -> list[T | None]:
    return [queue.pop(anybody) for _ in range(len(queue))]


def filled(*entries: tuple[str, int]) -> FairQueue[int]:
    queue: FairQueue[int] = FairQueue()
    for client, entry in entries:
        queue.append(client, entry)
    return queue


def test_one_client_with_many_requests_delays_no_other() -> None:
    queue = filled(*(("many", i) for i in range(5)), ("few", 10), ("few", 11), ("one", 20))
    assert drained(queue) == [0, 10, 20, 1, 11, 2, 3, 4]


def test_what_is_put_back_is_next() -> None:
    queue = filled(("a", 1), ("b", 2), ("a", 3))
    assert queue.pop(anybody) == 1
    queue.put_back("a", 1)
    assert drained(queue) == [1, 2, 3]


def test_what_is_taken_out_has_no_turn() -> None:
    queue = filled(("a", 1), ("b", 2), ("a", 3))
    queue.remove("a", 1)
    queue.remove("b", 2)
    queue.remove("b", 7)
    assert (len(queue), drained(queue)) == (1, [3])


clients = st.sampled_from("abcd")


def test_a_client_whose_first_is_not_admitted_has_no_turn() -> None:
    queue = filled(("a", 1), ("b", 2), ("a", 3), ("c", 4))
    assert queue.pop(lambda entry: entry != 1) == 2
    assert queue.pop(lambda entry: entry == 2) is None
    assert [*queue.of("a")] == [1, 3]
    assert not queue.of("b")
    assert drained(queue) == [1, 4, 3]


@given(st.lists(st.tuples(clients, st.integers()), max_size=30))
def test_nothing_is_lost_and_each_client_is_served_in_order(entries: list[tuple[str, int]]) -> None:
    numbered = [(client, (i, number)) for i, (client, number) in enumerate(entries)]
    queue: FairQueue[tuple[int, int]] = FairQueue()
    for client, entry in numbered:
        queue.append(client, entry)
    assert sorted(queue) == sorted(entry for _, entry in numbered)
    order = drained(queue)
    for own in "abcd":
        wanted = [entry for client, entry in numbered if client == own]
        assert [entry for entry in order if entry in wanted] == wanted
