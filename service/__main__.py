"""Starts the service: python -m service [--host --port --workers]."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence

from pydantic import ValidationError

from service import VERSION
from service.app import create_app
from service.http.keys import new_key
from service.observability.logs import configure
from service.running import Config, run
from service.settings import Settings


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line, which also documents every setting."""
    lines = [
        f"  POLHODE_{name.upper():<22} {field.description} Default: {field.default}."
        for name, field in Settings.model_fields.items()
    ]
    parser = argparse.ArgumentParser(
        "python -m service",
        description="Polhode: the motion of rigid bodies over HTTP.",
        epilog="environment variables, one per setting:\n" + "\n".join(lines),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--host", help="address to listen on (default 127.0.0.1)")
    parser.add_argument("--port", type=int, help="port to listen on (default 8000)")
    parser.add_argument("--workers", type=int, help="server processes that share the port (default 1)")
    parser.add_argument("--openapi", action="store_true", help="write the OpenAPI document to standard output and stop")
    parser.add_argument(
        "--new-key",
        metavar="NAME",
        help="make a key, show it and its line for keys_file (two hyphens: no limits), and stop",
    )
    parser.add_argument("--version", action="version", version=VERSION)
    return parser


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the service until it is told to stop."""
    options = parser().parse_args(arguments)
    if options.new_key is not None:
        key, line = new_key(options.new_key)
        sys.stdout.write(f"key, shown only now: {key}\nline for keys_file:  {line}\n")
        return
    given = {name: value for name in ("host", "port", "workers") if (value := getattr(options, name)) is not None}
    try:
        settings = Settings(**given)
    except ValidationError as error:
        faults = [f"POLHODE_{str(fault['loc'][0]).upper()}: {fault['msg']}" for fault in error.errors()]
        sys.exit("\n".join(faults))
    if options.openapi:
        sys.stdout.buffer.write(create_app(settings).openapi() + b"\n")
        return
    configure(settings.log_level)
    # Server processes read their settings from the environment that they inherit.
    os.environ.update({f"POLHODE_{name.upper()}": str(value) for name, value in given.items()})
    config = Config(
        "service.server:app",
        host=settings.host,
        port=settings.port,
        workers=settings.workers,
        log_config=None,
        access_log=False,
        server_header=False,
        # The address of the client is not used, so headers of proxies need not be read.
        proxy_headers=False,
        timeout_graceful_shutdown=settings.shutdown_seconds,
        timeout_keep_alive=15,
        h11_max_incomplete_event_size=65536,
    )
    run(config)


if __name__ == "__main__":
    main()
