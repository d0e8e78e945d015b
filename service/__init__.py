"""Transport for the mechanics: parse, limit, dispatch, write. Adds nothing to the answers but their envelope."""

VERSION = "1.0.0"
"""Version of the service and of the answers it gives; part of the signature of every answer."""
