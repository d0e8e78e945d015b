"""Spoilt questions to every endpoint, numbered: a run of many goes on where it was ended, and any can be asked again.

Run: python -m tests.service.mutation_run COUNT FILE, or python -m tests.service.mutation_run --ask NUMBER.

The file has a line for each question that was not answered or refused as promised, and at the end of a stretch the
number of the next one. Questions are asked in a process of their own: one that ends it, or takes longer than
`LONGEST_SECONDS` of processor time, is noted, and the others go on.
"""

from __future__ import annotations

import asyncio
import json
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import Any
from urllib.parse import quote

from service.app import Service
from service.routing import PostRoute
from tests.service.conftest import inline_service
from tests.service.http.test_dispatch import receiving, scope, sending
from tests.service.spoilt_questions import random_spoils, spoilt

STRETCH = 500
LONGEST_SECONDS = 60
MOST_BYTES = 4 << 30
PATHS = 20
"""One of so many questions has a spoilt path or query in place of a spoilt body."""

EXPECTED = {200, 202, 204, 400, 404, 405, 406, 413, 415, 422}
LETTERS = "/{}%?&=.-_~ \x00\u00e9abc019"


def service(folder: str) -> Service:
    """Return the service that is asked, with limits at which questions end soon; it keeps studies in a folder."""
    return inline_service(
        max_samples=500, max_evaluations=20_000, data=folder, max_studies=STRETCH, max_address_studies=STRETCH
    )


class Question:
    """The question of a number: method, path, query and body."""

    def __init__(self, asked: Service, number: int) -> None:
        random = Random(number)
        routes = [route for route in asked.table if isinstance(route, PostRoute)]
        route = random.choice(routes)
        self.method, self.path, self.query = "POST", route.path, ""
        example = random.choice(sorted(route.examples))
        self.body = json.dumps(spoilt(route.examples[example].question, random_spoils(random)))
        if random.randrange(PATHS) == 0:
            self.method = random.choice(("GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS"))
            letters = list(random.choice([route.path for route in asked.table]))
            for _ in range(random.randrange(4)):
                letters.insert(random.randrange(len(letters) + 1), random.choice(LETTERS))
            self.path = quote("".join(letters))
            self.query = quote("".join(random.choices(LETTERS, k=random.randrange(8))), safe="&=%")

    async def fault(self, asked: Service) -> str | None:
        """Return what is wrong with the answer, None if nothing is."""
        messages: list[dict[str, Any]] = []
        head = scope(self.method, self.path, {"content-type": "application/json"}) | {
            "query_string": self.query.encode()
        }
        await asked(head, receiving(self.body.encode()), sending(messages))
        status, content = messages[0]["status"], b"".join(message["body"] for message in messages[1:])
        unready = status == 503 and (b'"not-ready"' in content or (self.method, self.path) == ("HEAD", "/readyz"))
        if status not in EXPECTED and not unready:
            return f"{status}: {content[:300]!r}"
        headers = dict(messages[0]["headers"])
        if content and b"json" in headers[b"content-type"]:
            try:
                document = json.loads(content, parse_constant=_refuse)
            except ValueError as fault:
                return f"{fault}: {content[:300]!r}"
            if status >= 400 and (len(content) > 2048 or document["code"] == "internal-error"):
                return f"{status}, {len(content)} bytes: {content[:300]!r}"
        return None


def _refuse(name: str) -> None:
    raise ValueError(f"{name} in an answer")


def ask(first: int, count: int) -> None:
    """Ask questions in this process, and print the number of each before and what is wrong with it after it."""
    resource.setrlimit(resource.RLIMIT_DATA, (MOST_BYTES, MOST_BYTES))

    async def all_of_them(asked: Service) -> None:
        for number in range(first, first + count):
            print(number, flush=True)  # noqa: T201
            used = resource.getrusage(resource.RUSAGE_SELF).ru_utime
            resource.setrlimit(resource.RLIMIT_CPU, (int(used) + LONGEST_SECONDS, resource.RLIM_INFINITY))
            question = Question(asked, number)
            fault = await question.fault(asked)
            if fault is not None:
                print(json.dumps(fault), flush=True)  # noqa: T201

    with tempfile.TemporaryDirectory() as folder:
        asyncio.run(all_of_them(service(folder)))


def faults(first: int, stop: int) -> Iterator[tuple[int, str]]:
    """Yield the questions that are not answered as promised, with what is wrong."""
    while first < stop:
        command = [sys.executable, "-W", "ignore", "-m", "tests.service.mutation_run", "--stretch"]
        done = subprocess.run(
            [*command, str(first), str(stop - first)],
            capture_output=True,
            text=True,
            check=False,
        )
        for line in done.stdout.splitlines():
            if line.isdigit():
                first = int(line)
            elif line.startswith('"'):
                yield first, json.loads(line)
            else:
                # Of a library, which would otherwise print it in the middle of a service.
                yield first, f"printed: {line}"
        if done.returncode:
            yield first, f"the process ended with {done.returncode}: {done.stderr[-1000:]}"
        first += 1


def run(count: int, file: Path) -> None:
    """Ask questions up to a number, from where the file ends."""
    lines = file.read_text().splitlines() if file.exists() else []
    first = next((int(line) for line in reversed(lines) if line.isdigit()), 0)
    while first < count:
        stop = min(first + STRETCH, count)
        found = list(faults(first, stop))
        with file.open("a") as notes:
            notes.writelines(f"{json.dumps(entry)}\n" for entry in found)
            notes.write(f"{stop}\n")
        first = stop


def main(arguments: list[str]) -> None:
    """Run what the command line says."""
    match arguments:
        case ["--stretch", first, count]:
            ask(int(first), int(count))
        case ["--ask", number]:
            with tempfile.TemporaryDirectory() as folder:
                asked = service(folder)
                question = Question(asked, int(number))
                print(question.method, question.path, question.query)  # noqa: T201
                print(question.body)  # noqa: T201
                print(asyncio.run(question.fault(asked)))  # noqa: T201
        case [count, file]:
            run(int(count), Path(file))
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
