"""Thrift's compact protocol, as far as descriptions in files need it: structures, lists, texts and counts.

References
----------
Apache Thrift, "Thrift compact protocol encoding",
https://github.com/apache/thrift/blob/master/doc/specs/thrift-compact-protocol.md.
"""

from __future__ import annotations

from typing import Any


class Long(int):
    """An integer of 64 bits; others have 32."""


class Struct:
    """A structure of Thrift: values by the numbers of their fields, which rise."""

    def __init__(self, *fields: tuple[int, Any]) -> None:
        self._fields = fields

    def encoded(self) -> bytes:
        """Return it in the compact protocol."""
        pieces, last = [], 0
        for field, value in self._fields:
            pieces += [bytes([(field - last) << 4 | _number(value)]), _encoded(value)]
            last = field
        return b"".join(pieces) + b"\0"


def _number(value: Any) -> int:
    """Return the number of a value's type in the compact protocol."""
    return {Struct: 12, list: 9, str: 8, Long: 6}.get(type(value), 5)


def _encoded(value: Any) -> bytes:
    match value:
        case Struct():
            return value.encoded()
        case str():
            text = value.encode()
            return varint(len(text)) + text
        case list():
            kind = _number(value[0]) if value else 12
            head = bytes([len(value) << 4 | kind]) if len(value) < 15 else bytes([0xF0 | kind]) + varint(len(value))
            return head + b"".join(map(_encoded, value))
        case _:
            # Zigzag: none of the integers here is negative.
            return varint(2 * int(value))


def varint(value: int) -> bytes:
    """Return a number in groups of seven bits, the lowest first."""
    found = bytearray()
    while value > 0x7F:
        found.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes([*found, value])
