"""Requests of several parts (multipart/form-data, RFC 7578): a JSON document, and a file with columns of numbers.

The part `request` is the document without its columns; the part `columns` is a table with the names of the columns in
its first line (CSV), or a numpy archive with an array for each. The columns are put where the question has them.
"""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Iterator, Sequence
from math import isfinite
from typing import Any

from core.errors import Path, pointer_of
from service.problems import Fault, Refusal, headline
from service.requests.document_limits import Limits, enforce_document_limits, require_distinct_keys
from service.requests.npz_body import Arrays, arrays_of

REQUEST, COLUMNS = "request", "columns"
LONGEST_DELIMITER = 200
MOST_PARTS = 10
ARCHIVE = b"PK"
"""How a zip archive begins."""

_NAME = re.compile(rb'content-disposition:[^\r\n]*[; ]name="([^"\r\n]*)"', re.IGNORECASE)


def is_form(body: bytes) -> bool:
    """Return whether a body that is no JSON has several parts; otherwise it is an archive."""
    return body.startswith(b"--")


def unpacked_form(body: bytes, place: Path, limits: Limits) -> tuple[bytes, Arrays | None]:
    """Return the document of a request of several parts with its columns, and arrays that it names.

    Parameters
    ----------
    body : bytes
    place : path
        Of the columns in the document.
    limits : Limits
        On the document, and on an archive.

    Raises
    ------
    Refusal
        For what is no such request, and for cells that are no numbers, with the row.
    """
    parts = dict(_parts(body))
    missing = next((name for name in (REQUEST, COLUMNS) if name not in parts), None)
    if missing is not None:
        raise _refused("", f"must have a part named {missing}", "send request=@request.json and columns=@data.csv")
    enforce_document_limits(parts[REQUEST], limits)
    try:
        document = json.loads(parts[REQUEST])
        require_distinct_keys(parts[REQUEST])
        owner = document
        for step in place[:-1]:
            owner = owner[step]
    except (ValueError, LookupError, TypeError, RecursionError) as fault:
        rule = f"must be a JSON object with {pointer_of(place[:-1])} in the part {REQUEST}"
        raise _refused("", rule, None) from fault
    if not isinstance(owner, dict) or place[-1] in owner:
        raise _refused(pointer_of(place), "must be left out beside a file of columns", None)
    content = parts[COLUMNS]
    if content.startswith(ARCHIVE):
        arrays = arrays_of(content, limits.bytes)
        owner[place[-1]] = {name: {"array": name} for name in arrays.names}
        return json.dumps(document).encode(), arrays
    owner[place[-1]] = _table(content, place, _named_in(owner))
    return json.dumps(document).encode(), None


def _parts(body: bytes) -> Iterator[tuple[str, bytes]]:
    """Yield name and content of every part."""
    delimiter = body[: LONGEST_DELIMITER + 2].partition(b"\r\n")[0]
    chunks = (b"\r\n" + body).split(b"\r\n" + delimiter)
    if len(delimiter) > LONGEST_DELIMITER or len(chunks) < 3 or not chunks[-1].startswith(b"--"):
        raise _refused("", "must be multipart/form-data that ends with its delimiter", None)
    if len(chunks) > MOST_PARTS:
        raise _refused("", f"must have at most {MOST_PARTS} parts", None)
    for chunk in chunks[1:-1]:
        head, _, content = chunk.partition(b"\r\n\r\n")
        name = _NAME.search(head)
        if name is None:
            raise _refused("", "must name each of its parts", None)
        yield name[1].decode("latin-1"), content


def _named_in(owner: dict[str, Any]) -> set[str]:
    """Return the names that the document uses of columns; others may hold anything and are left out."""
    found: set[str] = set()
    for value in owner.values():
        if isinstance(value, str):
            found.add(value)
        elif isinstance(value, dict):
            found |= set(value) | {entry for entry in value.values() if isinstance(entry, str)}
    return found


def _table(content: bytes, place: Path, used: set[str]) -> dict[str, list[float | None]]:
    """Return the columns of a table with a line of names."""
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise _refused(pointer_of(place), "must be text in UTF-8, or a numpy archive", None) from fault
    first = text.partition("\n")[0]
    delimiter = max(",;\t", key=first.count)
    try:
        lines = [line for line in csv.reader(io.StringIO(text, newline=""), delimiter=delimiter) if line]
    except csv.Error as fault:
        raise _refused(pointer_of(place), f"must be a table: {fault}", None) from fault
    heads = [head.strip() for head in lines[0]] if lines else []
    if not heads or len(set(heads)) < len(heads):
        raise _refused(pointer_of(place), "must begin with a line of different names of columns", None)
    found: dict[str, list[float | None]] = {head: [] for head in heads if head in used}
    for row, line in enumerate(lines[1:]):
        if len(line) != len(heads):
            raise _refused(pointer_of(place), f"must have {len(heads)} cells in row {row}, not {len(line)}", None)
        for head, cell in zip(heads, line, strict=True):
            if head in found:
                found[head].append(_number(cell.strip(), (*place, head, row), row))
    return found


def _number(cell: str, path: Sequence[str | int], row: int) -> float | None:
    if not cell:
        return None
    try:
        number = float(cell)
    except ValueError as fault:
        raise _refused(
            pointer_of(path), f"must be a number (row {row})", "leave the cell of a missing one empty"
        ) from fault
    if not isfinite(number) or "_" in cell:
        raise _refused(
            pointer_of(path), f"must be a finite number (row {row})", "leave the cell of a missing one empty"
        )
    return number


def _refused(pointer: str, rule: str, remedy: str | None) -> Refusal:
    faults = [Fault(pointer, rule, remedy)]
    return Refusal("invalid-parameter", headline(faults), faults=faults)
