"""The target of a request in absolute form (RFC 9112, 3.2.2), as proxies send it: a whole URL in place of its path."""

from __future__ import annotations

import re

_ABSOLUTE = re.compile(r"https?://[^/?#]+", re.IGNORECASE)


def path_of_target(target: str) -> str:
    """Return the path in a target that is a URL; any other target unchanged."""
    authority = _ABSOLUTE.match(target)
    return target if authority is None else target[authority.end() :] or "/"
