"""A typed client of the Polhode service: every operation as a method, arrays as numpy arrays."""

from polhode_client import checkout as _checkout  # noqa: F401  before what it writes
from polhode_client.client import AsyncClient, Client
from polhode_client.operation import Operation
from polhode_client.progress import Progress, bar
from polhode_client.refused import Refused

__all__ = ["AsyncClient", "Client", "Operation", "Progress", "Refused", "bar"]
