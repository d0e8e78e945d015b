"""Which path and which host a request is sent to."""

from __future__ import annotations

import re
from collections.abc import Iterable
from ipaddress import ip_address

_ABSOLUTE = re.compile(r"https?://([^/?#]+)", re.IGNORECASE)


def of_target(target: str) -> tuple[str, str]:
    """Return host and path of a target in absolute form (RFC 9112, 3.2.2); of any other, no host and the target."""
    found = _ABSOLUTE.match(target)
    return ("", target) if found is None else (found[1], target[found.end() :] or "/")


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
