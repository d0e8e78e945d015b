"""What a connection is in the equations: the generic function of which every kind has its own form.

A kind registers its form for its class, here or in a module of its own, and nothing else of the equations knows kinds.
"""

from __future__ import annotations

from functools import singledispatch

from core.errors import Path
from core.multibody.language.connection import Connection
from core.multibody.table.measures import Measures


@singledispatch
def add_rows(connection: Connection, measures: Measures, name: str, path: Path) -> None:
    """Add the coordinates, rows, forces, works and limits of a connection.

    Parameters
    ----------
    connection : Connection
        As it was written; the form for its class is taken.
    measures : Measures
        What they are added to.
    name : str
        Of the connection in the answer.
    path : Path
        Of the connection in the description.

    Raises
    ------
    InvalidParameter, NotApplicable
        Where the connection cannot be so.
    NotImplementedError
        For a class that has no form.
    """
    raise NotImplementedError(f"{type(connection).__name__} has no rows")
