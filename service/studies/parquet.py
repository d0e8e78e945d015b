"""Files in the format Apache Parquet, written row group by row group: flat columns of numbers and texts.

Each column of a row group is one page of plain values, compressed with zstd. Readers need nothing beyond version 1 of
the format and that codec.

References
----------
Apache Parquet, https://parquet.apache.org/docs/file-format/ and `parquet.thrift` of its version 2.12 (names and numbers
of fields).
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Mapping, Sequence
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np

from service.http.compression import zstd
from service.studies.thrift import Long, Struct, varint

MAGIC = b"PAR1"

LEVEL = 1
"""Of zstd, as for responses: higher ones take several times as long for rows of numbers."""


class Kind(IntEnum):
    """Physical types of columns, by their numbers in the format."""

    INTEGER = 2
    DOUBLE = 5
    TEXT = 6


class Column(NamedTuple):
    """A column of a table.

    Attributes
    ----------
    name : str
    kind : Kind
    optional : bool
        Whether values may be absent.
    """

    name: str
    kind: Kind
    optional: bool = False


class ParquetFile:
    """A file that is written piece by piece: `head`, the row groups, `foot`.

    Parameters
    ----------
    columns : sequence of Column
    about : mapping of str to str
        Metadata of the file.
    """

    head = MAGIC

    def __init__(self, columns: Sequence[Column], about: Mapping[str, str]) -> None:
        self._columns, self._about = columns, about
        self._groups: list[Struct] = []
        self._rows, self._written = 0, len(MAGIC)

    def group(self, rows: int, values: Iterable[Sequence[Any]]) -> bytes:
        """Return the bytes of a row group.

        Parameters
        ----------
        rows : int
        values : iterable of sequence
            One for each column; None, and NaN among doubles, stands for a value that is absent.
        """
        pieces, chunks, total = [], [], 0
        for column, entries in zip(self._columns, values, strict=True):
            page = _page(column, entries)
            compressor = zstd(LEVEL)
            packed = compressor.compress(page) + compressor.flush()
            header = Struct(
                (1, 0), (2, len(page)), (3, len(packed)), (5, Struct((1, rows), (2, _PLAIN), (3, _RLE), (4, _RLE)))
            ).encoded()
            place = self._written
            sizes = len(header) + len(page), len(header) + len(packed)
            about = Struct(
                (1, column.kind), (2, [_PLAIN, _RLE]), (3, [column.name]), (4, _ZSTD), (5, Long(rows)),
                (6, Long(sizes[0])), (7, Long(sizes[1])), (9, Long(place)),
            )  # fmt: skip
            chunks.append(Struct((2, Long(place)), (3, about)))
            pieces += [header, packed]
            total += sizes[0]
            self._written += sizes[1]
        self._groups.append(Struct((1, chunks), (2, Long(total)), (3, Long(rows))))
        self._rows += rows
        return b"".join(pieces)

    def foot(self) -> bytes:
        """Return the end of the file, which says what is where."""
        elements = [Struct((4, "schema"), (5, len(self._columns)))]
        for column in self._columns:
            text = [(6, 0), (10, Struct((1, Struct())))] if column.kind is Kind.TEXT else []
            elements.append(Struct((1, column.kind), (3, int(column.optional)), (4, column.name), *text))
        pairs = [Struct((1, key), (2, value)) for key, value in self._about.items()]
        about = Struct(
            (1, 1), (2, elements), (3, Long(self._rows)), (4, self._groups), (5, pairs), (6, "polhode")
        ).encoded()
        return about + struct.pack("<I", len(about)) + MAGIC


_PLAIN, _RLE, _ZSTD = 0, 3, 6


def _page(column: Column, entries: Sequence[Any]) -> bytes:
    """Return which values of a column are there, and these."""
    if column.kind is Kind.TEXT:
        present = np.array([entry is not None for entry in entries], dtype=bool)
        texts = [entry.encode() for entry in entries if entry is not None]
        values = b"".join(part for text in texts for part in (struct.pack("<I", len(text)), text))
    else:
        numbers = np.asarray(entries, dtype="<f8" if column.kind is Kind.DOUBLE else "<i8")
        present = ~np.isnan(numbers)
        values = (numbers[present] if column.optional else numbers).tobytes()
    if not column.optional:
        return values
    # One run of bits, in groups of eight.
    levels = varint(((len(present) + 7) // 8) << 1 | 1) + np.packbits(present, bitorder="little").tobytes()
    return struct.pack("<I", len(levels)) + levels + values
