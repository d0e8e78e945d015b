"""Send an example to a running service and print its answer: python -m examples.ask [scenes/rod-in-hole/horizontal].

Without a name the T-handle of the README is asked about, and the names of all examples are listed.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import urllib.error
import urllib.request
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent
FIRST = "t-handle"
SHOWN = 3
"""Entries of a long array that are printed."""


def service_url() -> str:
    """Return where the service runs that was started with the same environment."""
    return f"http://127.0.0.1:{os.environ.get('POLHODE_PORT') or '8000'}"


def names() -> list[str]:
    """Return the names of all examples, the folder first; the T-handle of the README is "t-handle"."""
    return sorted(str(file.relative_to(FOLDER).with_suffix("")) for file in FOLDER.rglob("*.json"))


def request_of(name: str) -> bytes:
    """Return the body to be sent."""
    return (FOLDER / f"{name}.json").read_bytes()


def path_of(name: str) -> str:
    """Return the path that an example goes to; one outside of any folder is a trajectory."""
    folder = Path(name).parent
    return "/v1/rotation/trajectory" if folder == Path(".") else f"/v1/{folder}"


def ask(name: str, service: str | None = None) -> dict[str, Any]:
    """Return the service's answer, which may be a problem that says why there is none."""
    url = (service or service_url()) + path_of(name)
    question = urllib.request.Request(url, request_of(name), {"Content-Type": "application/json"})
    try:
        with urllib.request.urlopen(question, timeout=60) as reply:
            answer: dict[str, Any] = json.load(reply)
    except urllib.error.HTTPError as refusal:
        with refusal:
            answer = json.load(refusal)
    return answer


def shortened(value: Any) -> Any:
    """Return an answer with its long arrays cut, for people."""
    if isinstance(value, dict):
        return {key: shortened(entry) for key, entry in value.items()}
    if isinstance(value, list):
        shown = [shortened(entry) for entry in value[:SHOWN]]
        return [*shown, f"... {len(value)} in all"] if len(value) > 3 * SHOWN else [shortened(entry) for entry in value]
    return value


def main(arguments: list[str] | None = None) -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name", nargs="?", choices=names(), metavar="name", help="one of: " + ", ".join(names()))
    parser.add_argument("--service", default=service_url(), help="where it runs (default: %(default)s)")
    parser.add_argument("--whole", action="store_true", help="print long arrays in full")
    options = parser.parse_args(arguments)
    if options.name is None:
        print("examples: " + ", ".join(names()), file=sys.stderr)
    try:
        answer = ask(options.name or FIRST, options.service)
    except OSError as error:
        sys.exit(f"no answer from {options.service}: {error}; is the service running (make serve)?")
    print(json.dumps(answer if options.whole else shortened(answer), indent=1))


if __name__ == "__main__":
    main()
