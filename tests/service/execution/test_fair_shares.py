"""Shares of the long class on a virtual clock."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from random import Random

import pytest

from service.execution.fair_shares import MOST, MOST_OF_A_CLIENT, QUANTUM, FairShares


@dataclass(eq=False)
class Work:
    client: str
    whole: float = 1e9
    seconds: float = 0.0


def advance(shares: FairShares[Work], running: set[Work], processors: int) -> set[Work]:
    """Return what ran during the next quantum, after it; what is finished leaves."""
    chosen = set(shares.chosen(processors, running))
    assert len(chosen) == min(processors, len(shares))
    for work in chosen:
        work.seconds += QUANTUM
    for work in list(chosen):
        if work.seconds >= work.whole:
            shares.remove(work)
            chosen.discard(work)
    return chosen


def shared(works: list[Work], processors: int, quanta: int) -> Counter[str]:
    shares: FairShares[Work] = FairShares()
    for work in works:
        shares.add(work)
    running: set[Work] = set()
    for _ in range(quanta):
        running = advance(shares, running, processors)
    found: Counter[str] = Counter()
    for work in works:
        found[work.client] += round(work.seconds / QUANTUM)
    return found


@pytest.mark.parametrize("processors", [1, 2, 3, 4])
def test_clients_have_equal_shares_however_many_computations_they_have(processors: int) -> None:
    works = [Work(client) for client in "aaaaaaaabbbbcccc"]
    found = shared(works, processors, 300)
    assert sum(found.values()) == 300 * processors
    assert max(found.values()) - min(found.values()) <= 2


def test_one_client_has_at_most_half_while_others_wait() -> None:
    found = shared([*(Work("many") for _ in range(8)), Work("one")], 4, 100)
    assert found == {"many": 300, "one": 100}
    found = shared([*(Work("many") for _ in range(8)), Work("few"), Work("few")], 4, 100)
    assert found == {"many": 200, "few": 200}
    assert shared([Work("many") for _ in range(8)], 4, 100) == {"many": 400}


def test_of_one_client_the_one_that_ran_least_goes_first() -> None:
    works = [Work("a", seconds=30 * QUANTUM), Work("a"), Work("a")]
    shared(works, 1, 20)
    assert [round(work.seconds / QUANTUM) for work in works] == [30, 10, 10]


def test_half_of_the_room_is_kept_for_clients_that_have_none() -> None:
    shares: FairShares[Work] = FairShares()
    for client in map(str, range(MOST)):
        assert shares.may_have_another(client)
        while shares.may_have_another(client):
            shares.add(Work(client))
        assert not shares.full or client == str(MOST - MOST // 2 + MOST // 2 // MOST_OF_A_CLIENT - 1)
        if shares.full:
            break
    clients = Counter(work.client for work in shares)
    assert max(clients.values()) == MOST_OF_A_CLIENT
    assert len(clients) == MOST // 2 + MOST // 2 // MOST_OF_A_CLIENT


def test_nothing_is_stopped_within_its_quantum() -> None:
    shares: FairShares[Work] = FairShares()
    works = [Work("a"), Work("b")]
    for work in works:
        shares.add(work)
    first = shares.chosen(1, set())
    first[0].seconds += 0.5 * QUANTUM
    assert shares.chosen(1, set(first)) == first
    first[0].seconds += 0.6 * QUANTUM
    assert shares.chosen(1, set(first)) != first


def test_a_client_saves_nothing_while_it_is_away() -> None:
    shares: FairShares[Work] = FairShares()
    old, new = Work("old"), Work("new")
    shares.add(old)
    running: set[Work] = set()
    for _ in range(50):
        running = advance(shares, running, 1)
    shares.add(new)
    for _ in range(20):
        running = advance(shares, running, 1)
    # What runs is a quantum ahead before it gives way.
    assert 9 <= round(new.seconds / QUANTUM) <= 11


def test_a_client_that_leaves_and_comes_again_gains_nothing_by_it() -> None:
    """One has a computation that goes on, another many short ones that begin one after the other."""
    shares: FairShares[Work] = FairShares()
    steady = Work("steady")
    shares.add(steady)
    running: set[Work] = set()
    done = 0
    current = Work("coming", 2 * QUANTUM)
    shares.add(current)
    for _ in range(200):
        running = advance(shares, running, 1)
        if current not in shares:
            done += 2
            current = Work("coming", 2 * QUANTUM)
            shares.add(current)
    assert 90 <= done <= 110


def test_random_computations_of_ten_clients_are_shared_within_a_fifth() -> None:
    """As long as all of them have something to do; sizes over three orders of magnitude, seed fixed."""
    random, shares = Random(20261125), FairShares[Work]()
    used: Counter[str] = Counter()
    current = [Work(str(i), QUANTUM * 10 ** random.uniform(0, 3)) for i in range(10)]
    for work in current:
        shares.add(work)
    running: set[Work] = set()
    for _ in range(20_000):
        running = advance(shares, running, 2)
        for i, work in enumerate(current):
            if work not in shares:
                used[work.client] += round(work.seconds / QUANTUM)
                current[i] = Work(str(i), QUANTUM * 10 ** random.uniform(0, 3))
                shares.add(current[i])
    assert min(used.values()) >= 0.8 * 4000
    assert len(shares) == 10
