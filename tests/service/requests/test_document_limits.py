"""Keys that are named twice are found whatever stands between them; arrays of numbers are not looked into."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.problems import Refusal
from service.requests.document_limits import require_distinct_keys

NUMBERS = st.recursive(st.integers(-9, 9) | st.floats(allow_nan=False, allow_infinity=False), st.lists, max_leaves=6)
KEYS = st.sampled_from(["a", "b", "a[1]", "a[2]", "[1]", "[]", "], [", '"', "\\", ":", ""])


@st.composite
def documents(draw: Any, depth: int = 3) -> str:
    """Draw the text of a JSON value of which objects may name a key twice."""
    kind = draw(st.sampled_from(["numbers", "string", "list", "object"] if depth else ["numbers"]))
    if kind == "numbers":
        return json.dumps(draw(NUMBERS))
    if kind == "string":
        return json.dumps(draw(KEYS))
    inner = draw(st.lists(documents(depth=depth - 1), max_size=3))
    if kind == "list":
        return f"[{', '.join(inner)}]"
    return "{" + ",".join(f"{json.dumps(draw(KEYS))}: {entry}" for entry in inner) + "}"


def names_a_key_twice(text: str) -> bool:
    found = []

    def members(pairs: list[tuple[str, Any]]) -> None:
        found.append(len({name for name, _ in pairs}) < len(pairs))

    json.loads(text, object_pairs_hook=members)
    return any(found)


def refused(text: str) -> bool:
    # So long that not every string is looked at instead.
    body = f'{{"filling": "{"x" * 2000}", "document": {text}}}'.encode()
    try:
        require_distinct_keys(body)
    except Refusal:
        return True
    return False


@given(text=documents())
def test_exactly_the_documents_that_name_a_key_twice_are_refused(text: str) -> None:
    assert refused(text) == names_a_key_twice(text)


@pytest.mark.parametrize(
    ("text", "twice"),
    [
        ('{"a[1]": [1], "a[2]": [2]}', False),
        ('{"a[1]": [1], "a[1]": [2]}', True),
        ('[{"a": [[1, 2], [3, 4]]}, [], {"a": [1], "b": [2]}]', False),
        ('[{"a": [[1, 2], [3, 4]]}, [], {"a": [1], "a": [2]}]', True),
        ('{"a": [1], "\\u0061": [2]}', True),
    ],
)
def test_arrays_of_numbers_hide_nothing(text: str, twice: bool) -> None:
    assert refused(text) is twice
