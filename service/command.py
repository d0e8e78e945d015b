"""The command `polhode`: serve, grade, study, new-key and openapi.

``polhode grade`` answers files of requests to ``POST /v1/assessments`` in this process, without a server.
``polhode study`` sends a study to a running service, reports its progress and fetches its results.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections.abc import Sequence
from http.client import HTTPException
from pathlib import Path
from typing import Any
from urllib.error import HTTPError, URLError
from urllib.request import Request, urlopen

from service import VERSION
from service.broken_pipe import ending_with_its_reader

POLLING = 0.5
"""Time between two looks at the state of a study (s)."""

RESPONSE_TIMEOUT = 60.0
"""Time that a response of the service may take (s)."""

ENDINGS = {
    ".csv": ".csv",
    ".json": "",
    ".npz": ".npz",
    ".parquet": ".parquet",
    ".svg": ".svg",
    ".zip": ".zarr.zip",
}
"""Of the address of a study's results, by the ending of the file that they are written to."""


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser("polhode", description="The motion of rigid bodies and small constrained systems.")
    parser.add_argument("--version", action="version", version=VERSION)
    commands = parser.add_subparsers(dest="command", required=True)
    serve = commands.add_parser(
        "serve", help="start the service; polhode serve --help lists every setting", add_help=False
    )
    serve.set_defaults(run=lambda options: _service(options.rest))
    grade = commands.add_parser("grade", help="grade submissions without a server")
    grade.add_argument("files", nargs="+", type=Path, metavar="FILE", help="a request to POST /v1/assessments")
    grade.set_defaults(run=_grade)
    study = commands.add_parser("study", help="run a study on a running service")
    study.add_argument("file", type=Path, metavar="FILE", help="a request to POST /v1/studies")
    study.add_argument("--output", type=Path, required=True, help=f"ending in one of {', '.join(ENDINGS)}")
    address = f"http://127.0.0.1:{os.environ.get('POLHODE_PORT') or '8000'}"
    study.add_argument("--url", type=_address, default=address, help=f"of the service (default {address})")
    study.add_argument("--key-file", type=Path, metavar="FILE", help="with the key, for a service that asks for one")
    study.set_defaults(run=_study)
    key = commands.add_parser("new-key", help="make a key for a client, and its line for keys_file")
    key.add_argument("name")
    key.set_defaults(run=lambda options: _service(["--new-key", options.name]))
    document = commands.add_parser("openapi", help="write the OpenAPI document to standard output")
    document.set_defaults(run=lambda options: _service(["--openapi"]))
    return parser


def main(arguments: Sequence[str] | None = None) -> None:
    """Run a command."""
    with ending_with_its_reader():
        options, rest = parser().parse_known_args(arguments)
        if rest and options.command != "serve":
            parser().error(f"unrecognized arguments: {' '.join(rest)}")
    options.rest = rest
    options.run(options)


def _service(arguments: Sequence[str]) -> None:
    from service.__main__ import main as run

    run(arguments)


@ending_with_its_reader()
def _grade(options: argparse.Namespace) -> None:
    from core.errors import MechanicsError
    from core.systems.budget import Budget
    from service.execution.request_handler import RequestHandler
    from service.problems import Refusal, problem_of
    from service.requests.request_reader import Limits
    from service.responses.json_rows import written
    from service.routes import questions

    routes = {route.path: route for route in questions()}
    handler, route = RequestHandler(routes.values(), Budget(), Limits()), routes["/v1/assessments"]
    for file in options.files:
        try:
            answer = handler.answer(route, handler.read(route, _read(file)))
        except (Refusal, MechanicsError) as error:
            problem = error.problem if isinstance(error, Refusal) else problem_of(error)
            sys.exit(f"{file}: {problem.body().decode()}")
        sys.stdout.buffer.write(bytes(written(answer)) + b"\n")


def _study(options: argparse.Namespace) -> None:
    if options.output.suffix not in ENDINGS:
        sys.exit(f"the output must end in one of {', '.join(ENDINGS)}")
    if not options.output.parent.is_dir():
        sys.exit(f"{options.output}: there is no folder {options.output.parent}")
    key = {} if options.key_file is None else {"Authorization": f"Bearer {_read(options.key_file).decode().strip()}"}
    state = json.loads(_sent(f"{options.url}/v1/studies", key, body=_read(options.file)))
    address = f"{options.url}/v1/studies/{state['jobID']}"
    while state["status"] in ("accepted", "running"):
        sys.stderr.write(f"\r{state['status']}, {state.get('progress', 0)} %")
        sys.stderr.flush()
        time.sleep(POLLING)
        state = json.loads(_sent(address, key))
    sys.stderr.write(f"\r{state['status']}       \n")
    if state["status"] != "successful":
        sys.exit(str(state.get("message", state["status"])))
    results = f"{address}/results{ENDINGS[options.output.suffix]}"
    read = _sent(results, key)
    try:
        options.output.write_bytes(read)
    except OSError as error:
        sys.exit(f"{options.output}: {error.strerror}; the results stay at {results}")


def _address(text: str) -> str:
    """Return the address of a service without a slash at its end."""
    if not text.startswith(("http://", "https://")):
        raise argparse.ArgumentTypeError(f"{text} does not begin with http:// or https://")
    return text.rstrip("/")


def _read(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        sys.exit(f"{file}: {error.strerror}")


def _sent(url: str, key: dict[str, str], *, body: bytes | None = None) -> bytes:
    """Return the response of a service; end with its problem, or with what keeps it from being reached."""
    declared = {} if body is None else {"Content-Type": "application/json"}
    try:
        with urlopen(Request(url, body, key | declared), timeout=RESPONSE_TIMEOUT) as response:
            read: bytes = response.read()
            return read
    except HTTPError as refused:
        with refused:
            said = refused.read()
        if not refused.headers.get_content_type().endswith("json"):
            sys.exit(f"{url}: {refused.code} {refused.reason}")
        problem: Any = json.loads(said)
        sys.exit(f"{problem['title']}: {problem.get('detail', '')}")
    except URLError as error:
        sys.exit(f"no service at {url}: {error.reason}")
    except (OSError, HTTPException) as error:
        sys.exit(f"{url}: the response broke off: {error}")


if __name__ == "__main__":
    main()
