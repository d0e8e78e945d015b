"""Requests as numpy archives: the mirror of `service.responses.npz`, for arrays that JSON would make ten times larger.

The member ``metadata.json`` is the request, in which ``{"array": name}`` stands for each array; the array is the member
``name.npy``. Everything is checked before it is unpacked: how many members there are and how large, that an array is
one of plain numbers, and that its header says no more than is there. Nothing is unpickled.
"""

from __future__ import annotations

import io
import zlib
from collections.abc import Mapping
from functools import partial
from typing import Any
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile, ZipInfo

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from core.errors import InvalidParameter
from service.problems import Refusal
from service.responses.npz import METADATA

MOST_MEMBERS = 600
"""Arrays of as many submissions as a large class hands in; reading so many small ones takes some 30 ms."""

ENTRY = b"PK\x01\x02"
"""How the entry of a member begins in the directory of an archive."""

_HEADERS = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}
"""By version of the format; the third is for names of fields, which arrays of plain numbers have not."""


class Arrays:
    """The arrays of an archive by name, each of which the document has to name.

    Parameters
    ----------
    members : mapping of str to ndarray
    """

    def __init__(self, members: Mapping[str, NDArray[Any]]) -> None:
        self._members, self._unnamed = members, set(members)

    @property
    def names(self) -> list[str]:
        """The names of all arrays."""
        return [*self._members]

    def named(self, name: str) -> NDArray[Any]:
        """Return an array, or raise `InvalidParameter` where there is none of this name."""
        if name not in self._members:
            raise InvalidParameter((), f"name an array of the archive, which has no member {name[:40]}.npy")
        self._unnamed.discard(name)
        return self._members[name]

    def __contains__(self, name: str) -> bool:
        return name in self._members

    def require_all_named(self) -> None:
        """Raise `Refusal` for an array that the document does not name: it would be ignored."""
        for name in sorted(self._unnamed):
            raise _invalid(f'has an array that its document does not name by {{"array": name}}: {name[:40]!r}')


def unpacked(body: bytes, most_bytes: int) -> tuple[bytes, Arrays]:
    """Return the JSON document of an archive, and its arrays by name.

    Parameters
    ----------
    most_bytes : int
        That all members may have when they are unpacked.

    Raises
    ------
    Refusal
        For what is no such archive.
    """
    contents = _contents(body, most_bytes)
    document = contents.pop(METADATA, None)
    if document is None:
        raise _invalid(f"has no member {METADATA}")
    return document, _read(contents)


def arrays_of(body: bytes, most_bytes: int) -> Arrays:
    """Return the arrays of an archive without a document; parameters and errors are those of `unpacked`."""
    contents = _contents(body, most_bytes)
    if METADATA in contents:
        raise _invalid(f"has a member {METADATA}: the document is another part")
    return _read(contents)


def _read(contents: Mapping[str, bytes]) -> Arrays:
    return Arrays({name.removesuffix(".npy"): _array(name, content) for name, content in contents.items()})


def _contents(body: bytes, most_bytes: int) -> dict[str, bytes]:
    """Return the members of an archive by name."""
    # Counted before the directory is read: it might have a hundred thousand entries.
    if body.count(ENTRY) > MOST_MEMBERS:
        raise Refusal("too-complex", f"the archive has more than {MOST_MEMBERS} members")
    try:
        with ZipFile(io.BytesIO(body)) as archive:
            members = archive.infolist()
            if sum(member.file_size for member in members) > most_bytes:
                detail = f"the members have more than {most_bytes} bytes when unpacked, the limit max_body_bytes"
                raise Refusal("body-too-large", detail, extra={"limit": most_bytes})
            contents = {member.filename: archive.read(member) for member in members if _plain(member)}
    except (BadZipFile, zlib.error, ValueError, EOFError, OSError, RuntimeError, NotImplementedError) as fault:
        raise _invalid("cannot be read as a zip archive") from fault
    if len(contents) < len(members):
        raise _invalid("names a member twice")
    return contents


def _plain(member: ZipInfo) -> bool:
    if member.filename != METADATA and not member.filename.endswith(".npy"):
        raise _invalid(f"has a member that is neither {METADATA} nor an array (.npy)")
    if member.compress_type not in (ZIP_STORED, ZIP_DEFLATED) or member.flag_bits & 1:
        raise _invalid("has a member that is encrypted, or neither stored nor deflated")
    return True


def _array(name: str, content: bytes) -> NDArray[Any]:
    """Return the array of a member."""
    stream = io.BytesIO(content)
    try:
        shape, by_columns, dtype = _HEADERS[npy.read_magic(stream)](stream)
    # A header is a literal of Python; what its reader makes of another text is not documented.
    except Exception as fault:
        raise _invalid(f"has a member whose header cannot be read: {name[:40]!r}") from fault
    if dtype.kind not in "iuf" or dtype.itemsize > 8 or len(shape) not in (1, 2):
        raise _invalid(f"has an array that is not one of plain numbers in one or two dimensions: {name[:40]!r}")
    # Rows of nothing take no bytes, however many there are said to be; of two negative lengths the product may fit.
    if min(shape) < 0 or shape[1:] == (0,):
        raise _invalid(f"has an array with rows of no numbers, or of a negative length: {name[:40]!r}")
    start = stream.tell()
    if len(content) - start != dtype.itemsize * int(np.prod(shape, dtype=object)):
        raise _invalid(f"has an array of another size than its header says: {name[:40]!r}")
    flat = np.frombuffer(content, dtype, offset=start)
    return flat.reshape(shape, order="F" if by_columns else "C")


def _invalid(rule: str) -> Refusal:
    return Refusal("invalid-archive", f"the body {rule}")


def taking_arrays(schema: Any, most: int) -> Any:
    """Return a validator's schema that takes ``{"array": name}`` for every list, with the arrays as its context.

    Parameters
    ----------
    most : int
        Numbers of an array that is made a list, each an object of its own however few bytes it has in the archive.
    """
    if isinstance(schema, (list, tuple)):
        return type(schema)(taking_arrays(entry, most) for entry in schema)
    if not isinstance(schema, Mapping):
        return schema
    walked = {key: value if key == "metadata" else taking_arrays(value, most) for key, value in schema.items()}
    if walked.get("type") == "any" and (walked.get("metadata") or {}).get("rows"):
        return {"type": "function-plain", "function": {"type": "with-info", "function": _array_for}}
    if walked.get("type") == "any" and (walked.get("metadata") or {}).get("arrays_within"):
        return {"type": "function-plain", "function": {"type": "with-info", "function": _arrays_within}}
    # A union of an object and a list has to see the list, so that faults are those of one.
    if walked.get("type") == "list" or (walked.get("type") == "union" and _has_list(schema["choices"])):
        function = {"type": "with-info", "function": partial(_list_for, most)}
        return {"type": "function-wrap", "function": function, "schema": walked}
    return walked


def _has_list(choices: Any) -> bool:
    # A choice may come with a label.
    return any((choice[0] if isinstance(choice, tuple) else choice).get("type") == "list" for choice in choices)


def _array_for(value: Any, info: Any) -> Any:
    """Return the array that a value names, anything else as it is."""
    name = value.get("array") if type(value) is dict and len(value) == 1 else None
    return info.context.named(name) if type(name) is str else value


def _arrays_within(value: Any, info: Any) -> Any:
    """Return a JSON value in which arrays stand where they are named."""
    if type(value) is dict:
        # What is wrong with one submission is said of it, and refuses no other.
        missing = len(value) == 1 and type(value.get("array")) is str and value["array"] not in info.context
        found = value if missing else _array_for(value, info)
        return found if found is not value else {key: _arrays_within(entry, info) for key, entry in value.items()}
    return value


def _list_for(most: int, value: Any, handler: Any, info: Any) -> Any:
    found = _array_for(value, info)
    if isinstance(found, np.ndarray):
        if found.size > most:
            raise Refusal("too-complex", f"an array that is read as a list has more than {most} numbers")
        # Rows of a fixed length are tuples to the validator.
        found = found.tolist() if found.ndim == 1 else list(map(tuple, found.tolist()))
    return handler(found)
