"""Clients have their turns in rotation, and each its own in order."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from service.execution.fair_queue import FairQueue


def drained(queue: FairQueue[int]) -> list[int]:
    return [queue.pop() for _ in range(len(queue))]


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
    assert queue.pop() == 1
    queue.put_back("a", 1)
    assert drained(queue) == [1, 2, 3]


def test_what_is_taken_out_has_no_turn() -> None:
    queue = filled(("a", 1), ("b", 2), ("a", 3))
    queue.remove("a", 1)
    queue.remove("b", 2)
    queue.remove("b", 7)
    assert (len(queue), drained(queue)) == (1, [3])


clients = st.sampled_from("abcd")


@given(st.lists(clients, max_size=20), clients)
def test_what_is_ahead_of_a_new_entry_is_what_is_served_before_it(others: list[str], client: str) -> None:
    """But that those who have been served least recently may go before or after it within its round."""
    queue = filled(*((other, i) for i, other in enumerate(others)))
    ahead = set(queue.ahead_of(client))
    queue.append(client, 99)
    order = drained(queue)
    before = set(order[: order.index(99)])
    assert before <= ahead
    assert len(ahead - before) <= len(set(others) - {client})


@given(st.lists(st.tuples(clients, st.integers()), max_size=30))
def test_nothing_is_lost_and_each_client_is_served_in_order(entries: list[tuple[str, int]]) -> None:
    numbered = [(client, (i, number)) for i, (client, number) in enumerate(entries)]
    queue: FairQueue[tuple[int, int]] = FairQueue()
    for client, entry in numbered:
        queue.append(client, entry)
    assert sorted(queue) == sorted(entry for _, entry in numbered)
    order = [queue.pop() for _ in range(len(queue))]
    for own in "abcd":
        wanted = [entry for client, entry in numbered if client == own]
        assert [entry for entry in order if entry in wanted] == wanted
