import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from service.http.limits import require_acceptable
from service.problems import Refusal
from service.requests.document_limits import Limits, enforce_document_limits, require_distinct_keys


def code(call: object, *arguments: object) -> str | None:
    try:
        call(*arguments)  # type: ignore[operator]
    except Refusal as refusal:
        return refusal.problem.type.code
    return None


documents = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text('ab"\\:,{}[] \n', max_size=6),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text('ab":\\{[ ', max_size=4), inner, max_size=4),
    max_leaves=20,
)


def depth(node: object) -> int:
    if isinstance(node, dict):
        return 1 + max((depth(entry) for entry in node.values()), default=0)
    if isinstance(node, list):
        return 1 + max((depth(entry) for entry in node), default=0)
    return 0


@given(documents, st.integers(1, 6), st.booleans())
@settings(deadline=None, derandomize=True, max_examples=300)
def test_depth_is_that_of_the_document(document: object, limit: int, spaced: bool) -> None:
    body = json.dumps(document, indent=1 if spaced else None).encode()
    assert (code(enforce_document_limits, body, Limits(nesting=limit)) == "too-complex") == (depth(document) > limit)


@given(documents)
@settings(deadline=None, derandomize=True, max_examples=300)
def test_a_document_without_repeated_keys_passes(document: object) -> None:
    require_distinct_keys(json.dumps(document).encode())


@pytest.mark.parametrize(
    ("body", "pointer"),
    [
        (b'{"a":1,"a":2}', "/a"),
        (b'{"a" :1,"a"\n:2}', "/a"),
        (b'{"a":1,"\\u0061":2}', "/a"),
        (b'{"b":{"a":1},"c":[[{"a":1,"b":2,"a":3}]]}', "/c/0/0/a"),
        (b'{"a":"x",":a":1,  ":a":2}', "/:a"),
        (b'[{"k":1},{"k":1,"k":1}]', "/1/k"),
        (b'{"' + b"k" * 99 + b'":1,"' + b"k" * 99 + b'":1}', ""),
    ],
)
def test_repeated_keys_are_found(body: bytes, pointer: str) -> None:
    with pytest.raises(Refusal) as caught:
        require_distinct_keys(body)
    assert caught.value.problem.type.code == "duplicate-key"
    assert caught.value.problem.faults[0].pointer == pointer


def test_keys_are_counted_without_building_the_document() -> None:
    body = json.dumps({f"k{i}": 0 for i in range(50)}).encode()
    assert code(enforce_document_limits, body, Limits(keys=50)) is None
    assert code(enforce_document_limits, body, Limits(keys=49)) == "too-complex"


@pytest.mark.parametrize("document", [["a"] * 50, ["\n" * 49], {"k": ["a"] * 49}])
def test_strings_and_escapes_are_counted_without_building_the_document(document: object) -> None:
    body = json.dumps(document).encode()
    assert code(enforce_document_limits, body, Limits(strings=50)) is None
    assert code(enforce_document_limits, body, Limits(strings=49 - body.count(b"n"))) == "too-complex"


@pytest.mark.parametrize("accept", [b"*/*", b"application/json", b"text/html, application/*;q=0.2", b""])
def test_json_is_acceptable(accept: bytes) -> None:
    assert code(require_acceptable, accept) is None


def test_what_cannot_be_given_is_not_acceptable() -> None:
    assert code(require_acceptable, b"text/csv") == "not-acceptable"
