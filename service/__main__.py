"""Starts the service: python -m service [--host --port --workers].

The application is imported last: what is wrong with the command line, the settings or the port is said at once.
"""

from __future__ import annotations

import argparse
import contextlib
import errno
import gc
import os
import signal
import socket
import sys
from collections.abc import Mapping, Sequence
from multiprocessing import forkserver
from typing import Any

import orjson
from pydantic import ValidationError

from core.near_names import nearest
from service import VERSION
from service.broken_pipe import ending_with_its_reader
from service.execution import PRELOAD
from service.http.keys import new_key
from service.observability.logs import LOG, configure
from service.observability.shared_counts import sharing
from service.settings import Settings

PREFIX = Settings.model_config["env_prefix"]

ALIKE_SETTINGS = 0.9
"""Share of its letters, the prefix among them, that a variable has in common with a setting that it misspells."""

HANGING_SECONDS = 30
"""Time in which a server process tells its supervisor that it lives, or is killed with all that it answers.

uvicorn's own 5 s are too few for one that only waits for a core, beside others that fill the machine."""


def _written(default: object) -> object:
    return "none" if default in ("", None) else default


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line, which also documents every setting."""
    lines = [
        f"  POLHODE_{name.upper():<22} {field.description} Default: {_written(field.default)}."
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
    """Run the service under uvicorn until it is stopped."""
    with ending_with_its_reader():
        options = parser().parse_args(arguments)
        if options.new_key is not None:
            key, line = new_key(options.new_key)
            sys.stdout.write(f"key, shown only now: {key}\nline for keys_file:  {line}\n")
            return
        given = {name: value for name in ("host", "port", "workers") if (value := getattr(options, name)) is not None}
        settings, unknown = _read_settings(given), unknown_settings(os.environ)
        misspelt = [f"{name} is no setting; did you mean {near}?" for name, near in unknown.items() if near]
        if misspelt:
            sys.exit("\n".join(misspelt))
        if options.openapi:
            from service.app import app

            sys.stdout.buffer.write(orjson.dumps(app.openapi(), option=orjson.OPT_INDENT_2 | orjson.OPT_APPEND_NEWLINE))
            return
    configure(settings.log_level)
    for name in unknown:
        LOG.warning("%s is no setting and has no effect; python -m service --help lists them all", name)
    _serve(settings, given)


def _read_settings(given: Mapping[str, Any]) -> Settings:
    """Return the settings of the environment and the command line; end with the faults that they have."""
    try:
        return Settings(**given)
    except ValidationError as error:
        faults = [
            f"POLHODE_{str(fault['loc'][0]).upper()}: {fault['msg']}, given {str(fault['input'])!r}"
            for fault in error.errors()
        ]
        sys.exit("\n".join(faults))


def _serve(settings: Settings, given: Mapping[str, Any]) -> None:
    """Run the service until it is stopped; `given` are the settings of the command line."""
    host, port = settings.host, free_port(settings.host, settings.port)
    # Server processes read their settings from the environment that they inherit.
    os.environ.update({f"POLHODE_{name.upper()}": str(value) for name, value in given.items()})
    # uvicorn raises the signal that stopped it again when it has finished; this makes that an ordinary end.
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(0))
    from service.execution.compilation import ensure_compiled

    ensure_compiled()
    several = settings.workers > 1
    if not several:
        # It imports as much as this process does, at the same time.
        forkserver.set_forkserver_preload([PRELOAD])
        forkserver.ensure_running()
        # Until the application is ready; next to nothing of what is made before is ever garbage.
        gc.disable()
    import uvicorn

    from service.app import app

    app.address = f"http://{host}:{port}"
    with sharing() if several else contextlib.nullcontext():
        uvicorn.run(
            "service.app:app" if several else app,
            host=host,
            port=port,
            workers=settings.workers,
            **server_options(settings),
        )


def server_options(settings: Settings) -> dict[str, Any]:
    """Return what uvicorn is given beside the application and its address."""
    from service.http.connection import Connection

    return {
        "http": Connection,
        "log_config": None,
        "access_log": False,
        "server_header": False,
        "proxy_headers": bool(settings.forwarded_allow_ips),
        "forwarded_allow_ips": settings.forwarded_allow_ips,
        "timeout_graceful_shutdown": settings.shutdown_seconds,
        "timeout_keep_alive": settings.keep_alive_seconds,
        "timeout_worker_healthcheck": HANGING_SECONDS,
    }


def unknown_settings(environment: Mapping[str, str]) -> dict[str, str | None]:
    """Return the variables that look like settings and are none, each with the setting that was probably meant."""
    known = [f"{PREFIX}{name.upper()}" for name in Settings.model_fields]
    given = [name for name in environment if name.startswith(PREFIX) and name not in known]
    return {name: nearest(name, known, ALIKE_SETTINGS) for name in given}


def free_port(host: str, port: int) -> int:
    """Return a port that can be listened on, any free one for 0; exit with the reason if there is none."""
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(address)
            number: int = probe.getsockname()[1]
            return number
    except OSError as error:
        hint = ""
        if error.errno == errno.EADDRINUSE:
            hint = "; choose another: --port 8001, or POLHODE_PORT=8001 make serve"
        sys.exit(f"cannot listen on {host}, port {port}: {error.strerror}{hint}")


if __name__ == "__main__":
    main()
