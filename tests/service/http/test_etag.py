"""Validators, and the headers of an answer."""

from hypothesis import given
from hypothesis import strategies as st

from service.http.etag import Representation, etag_of


def test_headers_describe_the_text() -> None:
    answer = Representation(b'{"a":1}')
    headers = dict(answer.headers)
    assert headers[b"content-length"] == b"7"
    assert headers[b"etag"] == answer.etag == etag_of(answer.body)
    assert headers[b"content-type"] == b"application/json"
    assert headers[b"x-content-type-options"] == b"nosniff"


@given(st.lists(st.binary(max_size=9), min_size=1, max_size=3), st.lists(st.binary(max_size=9), min_size=1, max_size=3))
def test_validators_distinguish_contents(one: list[bytes], two: list[bytes]) -> None:
    # Parts are JSON, paths, media types and versions, none of which holds a NUL.
    one, two = ([part.replace(b"\0", b"") for part in parts] for parts in (one, two))
    assert (etag_of(*one) == etag_of(*two)) == (one == two)


def test_a_validator_is_strong_and_quoted() -> None:
    etag = etag_of(b"a")
    assert etag.startswith(b'"')
    assert etag.endswith(b'"')
    assert etag[1:-1].isalnum()
