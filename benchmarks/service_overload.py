"""Four times as many large questions as can be answered: with admission by predicted backlog, and without.

Run: python -m benchmarks.service_overload [seconds]. Everything stays on 127.0.0.1. The rate that two servers with the
same settings can sustain is measured first; then each is offered four times that rate, the same questions at the same
moments (drawn once, Poisson), whatever has been answered until then. Small questions are asked meanwhile. Every answer
is compared with the one that the same question got from the idle server: nothing that is accepted may be lost or wrong.
Answers are not kept, so that each is computed.
"""

from __future__ import annotations

import asyncio
import json
import os
import random
import sys
import time
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from benchmarks.machine import RESULTS, described
from benchmarks.servers import service

LIMIT = 1.0
"""Backlog above which questions are refused where admission is on (s)."""

TIMES_TOO_MANY = 4.0
PATH = "/v1/rotation/trajectory"
SMALL = "/v1/rotation/precession"


def question(number: int) -> bytes:
    """Return a large question of a few kinds: some hundred thousand steps or samples."""
    asked: dict[str, Any] = {
        "body": {"kind": "principal-moments", "moments": [1.0, 1.5, 2.0 + 0.1 * (number % 3)]},
        "angular_velocity": [0.1, 2.0, 0.1],
        "times": {"start": 0.0, "stop": 100.0, "count": 11},
    }
    steps = (1e-4, 5e-5, 2.5e-5)[number % 3]
    return json.dumps(asked | {"method": {"kind": "runge-kutta-4", "step": steps}}).encode()


LITTLE = json.dumps(
    {"body": {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]}, "angular_velocity": [0.1, 1.0, 0.1]}
).encode()


async def ask(port: int, path: str, body: bytes) -> tuple[int, dict[str, str], bytes]:
    """Ask one question over a connection of its own."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        head = f"POST {path} HTTP/1.1\r\nhost: x\r\nconnection: close\r\ncontent-type: application/json\r\n"
        writer.write(head.encode() + b"content-length: %d\r\n\r\n" % len(body) + body)
        top, _, content = (await reader.read()).partition(b"\r\n\r\n")
        status, *lines = top.decode().split("\r\n")
        headers = dict(line.lower().split(": ", 1) for line in lines)
        return int(status.split()[1]), headers, content
    finally:
        writer.close()


@dataclass
class Case:
    """What came of one server's load."""

    waits: list[float] = field(default_factory=list)
    refusals: list[float] = field(default_factory=list)
    small: list[float] = field(default_factory=list)
    outcomes: Counter[str] = field(default_factory=Counter)
    retry_after: list[int] = field(default_factory=list)

    def figures(self) -> dict[str, Any]:
        """Return them for the record (ms)."""
        kinds = {"accepted": self.waits, "refused": self.refusals, "small": self.small}
        return {
            "outcomes": dict(sorted(self.outcomes.items())),
            "retry_after_s": [min(self.retry_after), max(self.retry_after)] if self.retry_after else [],
            **{
                f"{kind}_ms": {"p50": round(1e3 * at(found, 0.5), 2), "p99": round(1e3 * at(found, 0.99), 2)}
                for kind, found in kinds.items()
                if found
            },
        }


def at(found: list[float], quantile: float) -> float:
    """Return a quantile."""
    return sorted(found)[int(quantile * len(found))]


async def sustained(port: int, expected: list[bytes], seconds: float = 4.0) -> float:
    """Return how many questions are answered each second if as many are asked as can run."""
    until, done = time.perf_counter() + seconds, 0

    async def one(number: int) -> None:
        nonlocal done
        while time.perf_counter() < until:
            status, _, content = await ask(port, PATH, question(number % 3))
            assert (status, content) == (200, expected[number % 3])
            number, done = number + 1, done + 1

    since = time.perf_counter()
    await asyncio.gather(*(one(number) for number in range(2 * (os.cpu_count() or 1))))
    return done / (time.perf_counter() - since)


async def offered(port: int, moments: list[float], expected: list[bytes]) -> Case:
    """Offer questions at given moments."""
    case, over = Case(), asyncio.Event()
    begin = time.perf_counter()

    async def large(number: int, moment: float) -> None:
        await asyncio.sleep(begin + moment - time.perf_counter())
        since = time.perf_counter()
        try:
            status, headers, content = await ask(port, PATH, question(number % 3))
        except OSError:
            case.outcomes["no answer"] += 1
            return
        spent = time.perf_counter() - since
        if status == 200:
            case.waits.append(spent)
            case.outcomes["answered" if content == expected[number % 3] else "wrong"] += 1
        else:
            code = json.loads(content)["code"]
            case.refusals.append(spent)
            case.outcomes[code] += 1
            if code == "too-busy":
                case.retry_after.append(int(headers["retry-after"]))

    async def small() -> None:
        while not over.is_set():
            since = time.perf_counter()
            status, _, _ = await ask(port, SMALL, LITTLE)
            case.small.append(time.perf_counter() - since)
            case.outcomes["small answered" if status == 200 else "small refused"] += 1
            await asyncio.sleep(0.02)

    asking = asyncio.ensure_future(small())
    await asyncio.gather(*(large(number, moment) for number, moment in enumerate(moments)))
    over.set()
    await asking
    return case


async def measure(seconds: float) -> dict[str, Any]:
    """Run both cases."""
    before, settings = os.getloadavg(), {"cached_answers": "0", "deadline_seconds": "300"}
    unbounded = {"max_backlog_seconds": "1e6"}
    with service(**settings, max_backlog_seconds=str(LIMIT)) as bounded, service(**settings, **unbounded) as open_door:
        expected = [(await ask(bounded.port, PATH, question(kind)))[2] for kind in range(3)]
        rate = await sustained(open_door.port, expected)
        draw, moments = random.Random(20240229), [0.0]
        while moments[-1] < seconds:
            moments.append(moments[-1] + draw.expovariate(TIMES_TOO_MANY * rate))
        cases = {
            "admission": await offered(bounded.port, moments, expected),
            "unbounded": await offered(open_door.port, moments, expected),
        }
    ratio = at(cases["admission"].waits, 0.99) / at(cases["unbounded"].waits, 0.99)
    return {
        "machine": described("uvicorn", "uvloop"),
        "load_average": {"before": before, "after": os.getloadavg()},
        "seconds_of_load": seconds,
        "max_backlog_seconds": LIMIT,
        "sustained_per_second": round(rate, 2),
        "offered_per_second": round(TIMES_TOO_MANY * rate, 2),
        "questions": len(moments),
        **{name: case.figures() for name, case in cases.items()},
        "accepted_p99_ratio": round(ratio, 4),
    }


def main(seconds: float = 10.0) -> None:
    """Measure, write the result, and fail if anything was lost or wrong."""
    result = asyncio.run(measure(seconds))
    (RESULTS / "service_overload.json").write_text(json.dumps(result, indent=2) + "\n")
    print(json.dumps(result, indent=2))
    for name in ("admission", "unbounded"):
        assert set(result[name]["outcomes"]) <= {"answered", "too-busy", "small answered"}, "lost or wrong"


if __name__ == "__main__":
    main(*map(float, sys.argv[1:2]))
