"""The definition of a connection: the generic function of which every kind has its own form."""

from __future__ import annotations

from functools import singledispatch

from core.multibody.audit.bodies import Path, Reader
from core.multibody.audit.definition import Definition
from core.multibody.audit.placement import Undefined
from core.multibody.language.connection import Connection


@singledispatch
def definition_of(connection: Connection, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a connection, of which the form for its class is taken.

    Parameters
    ----------
    connection : Connection
        As it was written; it has been found in order before.
    reader : Reader
        Reads its numbers and places.
    name : str
        Of the connection in the answer.
    path : Path
        Of the connection in the description.

    Raises
    ------
    Undefined
        Where there is none.
    """
    raise Undefined(connection.kind)
