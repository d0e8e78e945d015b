"""Send an example to a running service and print its answer: python -m examples.ask scenes/rod-in-hole/horizontal."""

from __future__ import annotations

import argparse
import json
import urllib.error
import urllib.request
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent
SERVICE = "http://127.0.0.1:8000"


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


def ask(name: str, service: str = SERVICE) -> dict[str, Any]:
    """Return the service's answer, which may be a problem that says why there is none."""
    question = urllib.request.Request(service + path_of(name), request_of(name), {"Content-Type": "application/json"})
    try:
        with urllib.request.urlopen(question, timeout=60) as reply:
            answer: dict[str, Any] = json.load(reply)
    except urllib.error.HTTPError as refusal:
        with refusal:
            answer = json.load(refusal)
    return answer


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name", choices=names(), metavar="name", help="one of: " + ", ".join(names()))
    parser.add_argument("--service", default=SERVICE, help="where it runs (default: %(default)s)")
    options = parser.parse_args()
    print(json.dumps(ask(options.name, options.service), indent=1))


if __name__ == "__main__":
    main()
