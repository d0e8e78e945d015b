"""Whether anybody waits for somebody else's question: three loads on one server, each bounded, all on 127.0.0.0/8.

Run: python -m benchmarks.scheduling [seconds]. One client asks small scenes and precessions, in turns alone and while
another client has four questions of 30 s running, so that other load on the machine is the same for both. Then ten
clients, each with its own key and four questions at a time, ask a hundred questions each, whose lengths are drawn over
two orders of magnitude; until the first of them is through, or the seconds are over, the time that the compute
processes gave to each is compared. Answers are not kept, so that each is computed.
"""

from __future__ import annotations

import asyncio
import json
import os
import re
import statistics
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from random import Random
from typing import Any

from benchmarks.machine import RESULTS, described
from benchmarks.servers import Server, service
from service.http.keys import new_key

SMALL, LARGE = "/v1/rotation/precession", "/v1/rotation/trajectory"
SCENES = "/v1/scenes"
CLIENTS, QUESTIONS, AT_A_TIME = 10, 100, 4
TURNS, IN_A_TURN = 5, 20
MOST_RATIO, MOST_MILLISECONDS, LEAST_SHARE = 2.0, 1000.0, 0.8
"""Goals: of a small question's median beside long ones to that alone, of the longest one, of a client's share."""
BODY = {"kind": "principal-moments", "moments": [1.0, 1.5, 2.1]}


def precession(number: int) -> dict[str, Any]:
    """Return a question that is answered in the event loop."""
    return {"body": BODY, "angular_velocity": [0.1, 1.0 + 1e-3 * number, 0.1]}


def small_scene(number: int) -> dict[str, Any]:
    """Return a scene that takes some 10 ms: a pendulum of two rods that swings through large angles."""
    return {
        "bodies": {
            "upper": {"at": [0.6, -0.8], "mass": 1.0},
            "lower": {"at": [1.4, -1.4 - 1e-4 * number], "mass": 1.0},
        },
        "connections": [
            {"kind": "rod", "a": [0.0, 0.0], "b": "upper"},
            {"kind": "rod", "a": "upper", "b": "lower"},
        ],
        "times": {"start": 0.0, "stop": 1.0, "count": 11},
    }


def endless(number: int) -> dict[str, Any]:
    """Return a question that takes longer than the deadline: some 500,000 steps of an implicit method in Python."""
    method = {"kind": "radau", "tolerance": 1e-10}
    times = {"start": 0.0, "stop": 10_000.0 + number, "count": 11}
    return {"body": BODY, "angular_velocity": [0.1, 1.0, 0.1], "times": times, "method": method}


def drawn(random: Random) -> dict[str, Any]:
    """Return a question of 40,000 to 4,000,000 steps."""
    method = {"kind": "runge-kutta-4", "step": 100.0 / (4e4 * 100.0 ** random.random())}
    times = {"start": 0.0, "stop": 100.0, "count": 11}
    return {"body": BODY, "angular_velocity": [0.1, 2.0, 0.1], "times": times, "method": method}


class Client:
    """Asks from an address of its own, with a key if it has one."""

    def __init__(self, server: Server, address: str, key: str | None = None) -> None:
        self._server, self._address = server, address
        self._key = f"authorization: Bearer {key}\r\n" if key else ""

    async def ask(self, path: str, question: dict[str, Any]) -> tuple[int, bytes, float]:
        """Return status, answer and time (s) of a question over a connection of its own."""
        since, body = time.perf_counter(), json.dumps(question).encode()
        reader, writer = await asyncio.open_connection("127.0.0.1", self._server.port, local_addr=(self._address, 0))
        try:
            head = f"POST {path} HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\n{self._key}"
            head += f"content-type: application/json\r\ncontent-length: {len(body)}\r\n\r\n"
            writer.write(head.encode() + body)
            top, _, content = (await reader.read()).partition(b"\r\n\r\n")
            return int(top.split()[1]), content, time.perf_counter() - since
        finally:
            writer.close()


class Figures:
    """Outcomes and times (ms) of one kind of question."""

    def __init__(self) -> None:
        self.outcomes: Counter[str] = Counter()
        self.spent: list[float] = []

    @property
    def median(self) -> float:
        """The median time (ms)."""
        return statistics.median(self.spent)

    def written(self) -> dict[str, Any]:
        """Return what is recorded."""
        ordered = sorted(self.spent)
        return {
            "outcomes": dict(self.outcomes),
            "median_ms": round(self.median, 2),
            "p99_ms": round(ordered[int(0.99 * len(ordered))], 2),
            "worst_ms": round(ordered[-1], 2),
        }


KINDS = {"scene": (SCENES, small_scene), "precession": (SMALL, precession)}


async def repeated(client: Client, turn: int, load: list[asyncio.Task[Any]], found: dict[str, Figures]) -> None:
    """Ask small questions one after the other while there is load."""
    for name, (path, question) in KINDS.items():
        for number in range(IN_A_TURN):
            assert not any(task.done() for task in load), "the load has ended"
            status, _, seconds = await client.ask(path, question(turn * IN_A_TURN + number))
            found[name].outcomes[str(status)] += 1
            found[name].spent.append(1e3 * seconds)


async def beside_long_questions(server: Server) -> dict[str, Any]:
    """Return the small client's figures alone and beside four long questions, and their ratios."""
    small, large = Client(server, "127.0.0.2"), Client(server, "127.0.0.3")
    alone, beside = ({name: Figures() for name in KINDS} for _ in range(2))
    await repeated(small, 0, [], {name: Figures() for name in KINDS})
    for turn in range(TURNS):
        await repeated(small, turn, [], alone)
        load = [asyncio.create_task(large.ask(LARGE, endless(4 * turn + number))) for number in range(4)]
        await asyncio.sleep(1.0)
        await repeated(small, turn, load, beside)
        for task in load:
            task.cancel()
        await asyncio.gather(*load, return_exceptions=True)
        # Its compute processes are ended once the server has seen that the client has left.
        await asyncio.sleep(1.0)
    return {
        "alone": {name: figures.written() for name, figures in alone.items()},
        "beside_four_long_questions": {name: figures.written() for name, figures in beside.items()},
        "ratio_of_medians": {name: round(beside[name].median / alone[name].median, 2) for name in KINDS},
    }


async def shares(server: Server, keys: list[str], seconds: float) -> dict[str, Any]:
    """Return outcomes, and the smallest and largest share of a client in proportion to the fair one."""
    outcomes: Counter[str] = Counter()
    through = asyncio.Event()

    async def one(number: int, key: str) -> None:
        client, random = Client(server, f"127.0.0.{10 + number}", key), Random(number)
        questions = iter([drawn(random) for _ in range(QUESTIONS)])

        async def some() -> None:
            for question in questions:
                status, _, _ = await client.ask(LARGE, question)
                outcomes[str(status)] += 1

        await asyncio.gather(*(some() for _ in range(AT_A_TIME)))
        through.set()

    tasks = [asyncio.create_task(one(number, key)) for number, key in enumerate(keys)]
    since = time.perf_counter()
    with_limit = asyncio.wait_for(through.wait(), seconds)
    await asyncio.gather(with_limit, return_exceptions=True)
    used, compared = await used_seconds(server), time.perf_counter() - since
    await asyncio.gather(*tasks)
    fair = sum(used.values()) / len(keys)
    return {
        "seconds": round(time.perf_counter() - since, 1),
        "seconds_compared": round(compared, 1),
        "outcomes": dict(outcomes),
        "smallest_share": round(min(used.values()) / fair, 3),
        "largest_share": round(max(used.values()) / fair, 3),
    }


async def used_seconds(server: Server) -> dict[str, float]:
    """Return the time of compute processes by key."""
    reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
    writer.write(b"GET /metrics HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\n\r\n")
    text = (await reader.read()).decode()
    writer.close()
    return {key: float(value) for key, value in re.findall(r'polhode_used_seconds_total\{key="(.+)"\} (\S+)', text)}


def main(seconds: float = 120.0) -> None:
    """Measure and write the result; fail if a small question was not answered or a share is too small."""
    before = os.getloadavg()
    with service(cached_answers="0") as server:
        small = asyncio.run(beside_long_questions(server))
    with tempfile.TemporaryDirectory() as folder:
        made = [new_key(f"client-{number}") for number in range(CLIENTS)]
        file = Path(folder) / "keys"
        file.write_text("".join(f"{line}\n" for _, line in made))
        with service(cached_answers="0", keys_file=str(file)) as server:
            fair = asyncio.run(shares(server, [key for key, _ in made], seconds))
    result = {
        "machine": described("uvicorn", "uvloop"),
        "load_average": {"before": before, "after": os.getloadavg()},
        **small,
        "shares_of_ten_clients": fair,
    }
    (RESULTS / "scheduling.json").write_text(json.dumps(result, indent=2) + "\n")
    print(json.dumps(result, indent=2))
    for name, beside in small["beside_four_long_questions"].items():
        assert set(beside["outcomes"]) == {"200"}, f"not every {name} was answered"
        assert beside["worst_ms"] < MOST_MILLISECONDS
        assert small["ratio_of_medians"][name] < MOST_RATIO
    assert fair["outcomes"] == {"200": CLIENTS * QUESTIONS}
    assert fair["smallest_share"] >= LEAST_SHARE


if __name__ == "__main__":
    main(*map(float, sys.argv[1:2]))
