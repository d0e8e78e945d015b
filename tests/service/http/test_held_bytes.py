"""What one client holds refuses no other; what all hold is bounded."""

from __future__ import annotations

import pytest

from service.http.held_bytes import HeldBytes
from service.problems import Refusal


def test_one_client_may_hold_half_and_refuses_nobody() -> None:
    held = HeldBytes(100)
    with held.holding("many", 51):
        with pytest.raises(Refusal, match="more than 50 bytes, its share of the limit max_held_bytes") as caught:
            held.require_room("many")
        assert (caught.value.problem.type.code, caught.value.problem.headers) == ("too-busy", ())
        held.require_room("other")
        held.add("other", 49)
        held.require_room("third")
        held.add("third", 1)
        with pytest.raises(Refusal, match="take more than 100 bytes, the limit max_held_bytes") as caught:
            held.require_room("fourth", close=True)
        assert caught.value.problem.headers == (("Connection", "close"),)
    held.require_room("fourth")
    assert held.total == 50


def test_a_client_may_have_any_answer_and_others_within_its_share() -> None:
    held = HeldBytes(100)
    freed: list[int] = []
    held.freed = lambda: freed.append(held.total)
    held.add("reads", 40)
    assert held.may_answer("reads", 200)
    with held.answering("reads", 30):
        assert held.may_answer("reads", 20)
        assert not held.may_answer("reads", 21)
        assert held.may_answer("other", 200)
        held.require_share("other")
        with pytest.raises(Refusal, match="its share of the limit max_held_bytes"), held.reserved("reads", 21):
            pass
        with held.reserved("reads", 20):
            assert held.total == 90
        with pytest.raises(Refusal, match="its share of the limit max_held_bytes"):
            held.require_share("reads")
    assert freed == [70, 40]
    held.require_share("reads")
