"""Which path and which host a request is sent to."""

from __future__ import annotations

import re
from collections.abc import Iterable
from ipaddress import ip_address

_ABSOLUTE = re.compile(r"https?://[^/?#]+", re.IGNORECASE)


def path_of_target(target: str) -> str:
    """Return the path in a target in absolute form, a URL (RFC 9112, 3.2.2); any other target unchanged."""
    authority = _ABSOLUTE.match(target)
    return target if authority is None else target[authority.end() :] or "/"


def host_of(headers: Iterable[tuple[bytes, bytes]]) -> str:
    """Return the name or address in the Host header, without the port; empty where there is none."""
    written = next((value for name, value in headers if name == b"host"), b"").decode("latin-1").lower()
    if written.startswith("["):
        return written[1:].partition("]")[0]
    return written.rpartition(":")[0] if written.count(":") == 1 else written


def is_allowed(host: str, allowed: Iterable[str]) -> bool:
    """Return whether a host is an address, localhost, one of some names, or below one that begins with ``*.``."""
    if host == "localhost":
        return True
    try:
        # Browsers send a name where it was rebound to an address.
        ip_address(host)
        return True
    except ValueError:
        pass
    return any(host.endswith(name[1:]) if name.startswith("*.") else host == name for name in allowed)
