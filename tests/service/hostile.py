"""Requests that a service meets on the open net, as a table: name, body, expected status, code and pointer.

They vary a question with a body, an angular velocity and times; all are bytes, so that what is not JSON can be written.
"""

from __future__ import annotations

import json
from typing import Any

QUESTION: dict[str, Any] = {
    "body": {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]},
    "angular_velocity": [0.1, 1.0, 0.1],
    "times": {"start": 0.0, "stop": 1.0, "count": 3},
}

Case = tuple[str, bytes, int, str, str | None]


def text(**changes: Any) -> bytes:
    return json.dumps({**QUESTION, **changes}).encode()


def raw(old: str, new: bytes) -> bytes:
    """Return the question with a piece of its text replaced by bytes."""
    document = text()
    assert old.encode() in document
    return document.replace(old.encode(), new, 1)


def without(name: str) -> bytes:
    return json.dumps({key: value for key, value in QUESTION.items() if key != name}).encode()


def body(**changes: Any) -> bytes:
    return text(body={**QUESTION["body"], **changes})


def _not_json() -> list[Case]:
    texts = {
        "nothing": b"",
        "a blank": b" ",
        "a brace": b"{",
        "two documents": b"{}{}",
        "a trailing comma": b'{"body":1,}',
        "a comment": b"{/* */}",
        "single quotes": b"{'body': 1}",
        "bare words": b"{body: 1}",
        "a byte order mark": b"\xef\xbb\xbf{}",
        "utf-16": "{}".encode("utf-16"),
        "broken utf-8": b'{"body":"\xff\xfe"}',
        "overlong utf-8": b'{"body":"\xc0\xaf"}',
        "a surrogate in utf-8": b'{"body":"\xed\xa0\x80"}',
        "a lone high surrogate": b'{"body":"\\ud800"}',
        "a lone low surrogate": b'{"body":"\\udc00"}',
        "swapped surrogates": b'{"body":"\\udc00\\ud800"}',
        "a lone surrogate as key": b'{"\\ud800":1}',
        "a raw newline in a string": b'{"body":"\n"}',
        "a NUL byte": b'{"body":"\x00"}',
        "NUL bytes": b"\x00" * 1000,
        "an unknown escape": b'{"body":"\\x41"}',
        "hexadecimal": raw("1.0", b"0x10"),
        "a leading zero": raw("1.0", b"01.0"),
        "a leading plus": raw("1.0", b"+1.0"),
        "a bare point": raw("1.0", b".5"),
        "a trailing point": raw("1.0", b"5."),
        "an underscore in a number": raw("1.0", b"1_000"),
        "a complex number": raw("1.0", b"1j"),
        "nan in lower case": raw("1.0", b"nan"),
        "inf": raw("1.0", b"inf"),
        "5000 digits": raw("1.0", b"9" * 5000),
        "100000 digits": raw("1.0", b"9" * 100_000),
        "python": b"__import__('os').system('true')",
        "xml": b"<?xml version='1.0'?><a/>",
        "a pickle": b"\x80\x04\x95\x0b\x00\x00\x00\x00\x00\x00\x00\x8c\x07polhode\x94.",
        "gzip": b"\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\x03",
        "a form": b"body=1&angular_velocity=2",
        "half a document": text()[:-20],
        "quotes": b'"' * 100_001,
        "backslashes": b'"' + b"\\" * 100_001,
    }
    return [(f"not json: {name}", content, 400, "invalid-json", None) for name, content in texts.items()]


def _too_complex() -> list[Case]:
    texts = {
        "arrays": b"[" * 100_000,
        "closed arrays": b"[" * 5000 + b"]" * 5000,
        "objects": b'{"body":' * 1000 + b"1" + b"}" * 1000,
        "a mixture": b'[{"a":' * 500,
        "deep in a field": raw("1.0", b"[" * 40 + b"1.0" + b"]" * 40),
        "arrays in a row": b"[" + b"[]," * 200_000 + b"[]]",
        "bad rows": json.dumps({**QUESTION, "times": [[1, 2]] * 110_000}).encode(),
        "keys": json.dumps({f"key{i}": i for i in range(50_000)}).encode(),
        "equal keys": b"{" + b'"a":1,' * 100_000 + b'"a":1}',
        "empty keys": b"{" + b'"" :1,' * 100_000 + b'"":1}',
        "strings": json.dumps({**QUESTION, "times": ["1"] * 100_001}).encode(),
        "escapes": json.dumps({**QUESTION, "name": "\u00e9" * 200_001}).encode(),
    }
    return [(f"too complex: {name}", content, 400, "too-complex", None) for name, content in texts.items()]


def _twice() -> list[Case]:
    texts = {
        "a key": (raw('"times"', b'"body": {"kind": "principal-moments", "moments": [3,2,1]}, "times"'), "/body"),
        "a key of the body": (raw('"moments"', b'"moments": [3.0, 2.0, 1.0], "moments"'), "/body/moments"),
        "the kind": (raw('"kind"', b'"kind": "principal-moments", "kind"'), "/body/kind"),
        "an escaped key": (raw('"start"', b'"st\\u0061rt": 0.0, "start"'), "/times/start"),
        "a spaced key": (raw('"start"', b'"start"  \n : 0.0, "start"'), "/times/start"),
    }
    return [(f"twice: {name}", content, 400, "duplicate-key", at) for name, (content, at) in texts.items()]


def _wrong_numbers() -> list[Case]:
    values = {
        "NaN": b"NaN",
        "-NaN": b"-NaN",
        "Infinity": b"Infinity",
        "-Infinity": b"-Infinity",
        "1e999": b"1e999",
        "-1e999": b"-1e999",
        "1e400 written out": b"1" + b"0" * 400,
        "4000 digits": b"9" * 4000,
        "true": b"true",
        "false": b"false",
        "null": b"null",
        "a string": b'"1.5"',
        "an empty string": b'""',
        "NaN as a string": b'"NaN"',
        "an array": b"[1.0]",
        "an empty array": b"[]",
        "an object": b'{"value": 1.0}',
        "code": b'"${jndi:ldap://127.0.0.1/a}"',
    }
    places = {
        "/body/moments/0": "1.0",
        "/angular_velocity/1": "1.0, 0.1]",
        "/times/stop": '1.0, "count"',
        "/times/start": '0.0, "stop"',
        "/body/moments/2": "3.0]",
    }
    cases: list[Case] = []
    for name, value in values.items():
        # Not a token of any JSON dialect.
        status, code = (400, "invalid-json") if name == "-NaN" else (422, "invalid-parameter")
        for place, old in places.items():
            content = raw(old, value + old[3:].encode())
            cases.append((f"number: {name} at {place}", content, status, code, None if status == 400 else place))
    return cases


def _wrong_shapes() -> list[Case]:
    q = QUESTION
    listed: list[tuple[str, bytes, str | None]] = [
        ("null", b"null", ""),
        ("an array", b"[]", ""),
        ("a number", b"1", ""),
        ("a string", b'"a"', ""),
        ("an array of questions", json.dumps([q]).encode(), ""),
        ("nothing in it", b"{}", None),
        ("no body", without("body"), "/body"),
        ("no angular velocity", without("angular_velocity"), "/angular_velocity"),
        ("no times", without("times"), "/times"),
        ("an unknown key", text(unknown=1), "/unknown"),
        ("a key with a slash", text(**{"a/b": 1}), "/a~1b"),
        ("a key with a tilde", text(**{"a~b": 1}), "/a~0b"),
        ("a prototype", text(__proto__={"a": 1}), "/__proto__"),
        ("a class", text(__class__="a"), "/__class__"),
        ("an empty key", text(**{"": 1}), "/"),
        ("a long key", text(**{"k" * 100_000: 1}), ""),
        ("a case of a key", text(Times=1), "/Times"),
        ("body null", text(body=None), "/body"),
        ("body a string", text(body="principal-moments"), "/body"),
        ("body an array", text(body=[1, 2, 3]), "/body"),
        ("body empty", text(body={}), "/body"),
        ("no kind", text(body={"moments": [1, 2, 3]}), "/body"),
        ("an unknown kind", body(kind="cube-of-doom"), "/body/kind"),
        ("a kind in capitals", body(kind="Principal-Moments"), "/body/kind"),
        ("kind null", body(kind=None), "/body/kind"),
        ("kind a number", body(kind=1), "/body/kind"),
        ("kind an array", body(kind=["principal-moments"]), "/body/kind"),
        ("kind of a method", body(kind="runge-kutta-4"), "/body/kind"),
        ("a long kind", body(kind="k" * 100_000), "/body/kind"),
        ("an unknown key of the body", body(mass=1.0), "/body/mass"),
        ("no moments", text(body={"kind": "principal-moments"}), "/body/moments"),
        ("two moments", body(moments=[1.0, 2.0]), "/body/moments"),
        ("four moments", body(moments=[1.0, 2.0, 3.0, 4.0]), "/body/moments"),
        ("no entries", body(moments=[]), "/body/moments"),
        ("moments an object", body(moments={"0": 1, "1": 2, "2": 3}), "/body/moments"),
        ("moments a string", body(moments="123"), "/body/moments"),
        ("moments nested", body(moments=[[1.0, 2.0, 3.0]]), "/body/moments/0"),
        ("a negative moment", body(moments=[1.0, 1.0, -1.0]), "/body/moments/2"),
        ("angular velocity a number", text(angular_velocity=1.0), "/angular_velocity"),
        ("angular velocity too short", text(angular_velocity=[1.0]), "/angular_velocity"),
        ("angular velocity too long", text(angular_velocity=[1.0] * 5000), "/angular_velocity"),
        ("angular velocity an object", text(angular_velocity={"x": 1}), "/angular_velocity"),
        ("times null", text(times=None), "/times"),
        ("times a number", text(times=3), "/times"),
        ("times a string", text(times="0:1:3"), "/times"),
        ("times true", text(times=True), "/times"),
        ("times empty", text(times=[]), "/times"),
        ("times empty object", text(times={}), None),
        ("times nested", text(times=[[0.0, 1.0]]), "/times/0"),
        ("times with null", text(times=[0.0, None]), "/times/1"),
        ("times with a string", text(times=[0.0, "1"]), "/times/1"),
        ("no count", text(times={"start": 0.0, "stop": 1.0}), "/times/count"),
        ("an unknown key of times", text(times={**q["times"], "step": 0.1}), "/times/step"),
        ("count zero", text(times={**q["times"], "count": 0}), "/times/count"),
        ("count negative", text(times={**q["times"], "count": -5}), "/times/count"),
        ("count a fraction", text(times={**q["times"], "count": 2.5}), "/times/count"),
        ("count a float", text(times={**q["times"], "count": 2.0}), "/times/count"),
        ("count true", text(times={**q["times"], "count": True}), "/times/count"),
        ("count a string", text(times={**q["times"], "count": "3"}), "/times/count"),
        ("count beyond 64 bits", text(times={**q["times"], "count": 2**70}), "/times/count"),
        ("count of 4000 digits", raw('"count": 3', b'"count": ' + b"9" * 4000), "/times/count"),
        ("bad rows", json.dumps({**q, "times": [[1, 2]] * 45_000}).encode(), "/times/0"),
        ("late bad entry", json.dumps({**q, "times": [0.5] * 200_000 + [None]}).encode(), "/times/200000"),
    ]
    return [(f"shape: {name}", content, 422, "invalid-parameter", at) for name, content, at in listed]


def _too_much() -> list[Case]:
    return [
        (
            "budget: samples",
            text(times={"start": 0, "stop": 1, "count": 10**7}),
            422,
            "budget-exceeded",
            "/times/count",
        ),
        ("budget: 1e9", text(times={"start": 0, "stop": 1, "count": 10**9}), 422, "budget-exceeded", "/times/count"),
        ("size: bytes", b" " * 8_000_001, 413, "body-too-large", None),
        ("size: a large question", text(times=[0.123456789012345] * 450_000), 413, "body-too-large", None),
    ]


CASES: list[Case] = [
    *_not_json(),
    *_too_complex(),
    *_twice(),
    *_wrong_numbers(),
    *_wrong_shapes(),
    *_too_much(),
]

HEADERS: list[tuple[str, dict[str, str], int, str]] = [
    ("text", {"content-type": "text/plain"}, 415, "unsupported-media-type"),
    ("a form", {"content-type": "application/x-www-form-urlencoded"}, 415, "unsupported-media-type"),
    ("multipart", {"content-type": "multipart/form-data; boundary=x"}, 415, "unsupported-media-type"),
    ("an empty type", {"content-type": ""}, 415, "unsupported-media-type"),
    ("almost json", {"content-type": "application/jsonp"}, 415, "unsupported-media-type"),
    ("problem json", {"content-type": "application/problem+json"}, 415, "unsupported-media-type"),
    (
        "latin type",
        {"content-type": "application/jsön".encode("latin-1").decode("latin-1")},
        415,
        "unsupported-media-type",
    ),
    ("gzip", {"content-type": "application/json", "content-encoding": "gzip"}, 415, "unsupported-media-type"),
    ("brotli", {"content-type": "application/json", "content-encoding": "br"}, 415, "unsupported-media-type"),
    (
        "two codings",
        {"content-type": "application/json", "content-encoding": "identity, gzip"},
        415,
        "unsupported-media-type",
    ),
    ("a list of types", {"content-type": "text/plain, application/json"}, 415, "unsupported-media-type"),
    ("a quoted type", {"content-type": '"application/json"'}, 415, "unsupported-media-type"),
    ("a long type", {"content-type": "a/" + "b" * 7_000}, 415, "unsupported-media-type"),
    ("json refused", {"content-type": "application/json", "accept": "application/json;q=0"}, 406, "not-acceptable"),
    ("words wanted", {"content-type": "application/json", "accept": "whatever you have"}, 406, "not-acceptable"),
    ("a weight that is none", {"content-type": "application/json", "accept": "*/*;q=nan"}, 406, "not-acceptable"),
    ("a weight below none", {"content-type": "application/json", "accept": "*/*;q=-1"}, 406, "not-acceptable"),
    ("a weight in exponents", {"content-type": "application/json", "accept": "*/*;q=1e999"}, 406, "not-acceptable"),
    ("many wanted", {"content-type": "application/json", "accept": "text/csv," * 500}, 406, "not-acceptable"),
    ("semicolons wanted", {"content-type": "application/json", "accept": ";" * 2_000}, 406, "not-acceptable"),
    ("csv wanted", {"content-type": "application/json", "accept": "text/csv"}, 406, "not-acceptable"),
    ("html wanted", {"content-type": "application/json", "accept": "text/html"}, 406, "not-acceptable"),
]
