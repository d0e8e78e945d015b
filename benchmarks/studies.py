"""Studies against single requests and against what one would write without a service: flip intervals of many bodies.

Run: python -m benchmarks.studies [members]. Everything stays on this machine. Wall times are those of a machine with
whatever else runs on it; processor times are not disturbed by that, and both are reported. Peers take the same bodies
in the same run: solve_ivp of scipy with an event in a loop, the library in multiprocessing and in joblib.

More processes than the machine has cores are shown by giving each a fifth of a core, which the kernel enforces (control
groups, version 1; as root). Eight of them take 1.6 cores.
"""

from __future__ import annotations

import http.client
import json
import multiprocessing
import os
import sqlite3
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from joblib import Parallel, delayed
from scipy.integrate import solve_ivp

from benchmarks.machine import RESULTS, described
from benchmarks.servers import Server, children, service
from core.bodies.measured import PrincipalMoments
from core.rotation.precession.precession import precession

BODY = {"kind": "principal-moments", "moments": [1.0, 1.5, 2.0]}
VARY = [
    {"pointer": "/body/moments/0", "min": 1.0, "max": 1.4},
    {"pointer": "/body/moments/1", "min": 1.5, "max": 1.9},
    {"pointer": "/angular_velocity/0", "min": 0.001, "max": 0.1},
]
FLIPS: dict[str, Any] = {
    "question": {
        "path": "/v1/rotation/precession",
        "request": {"body": BODY, "angular_velocity": [0.01, 1.0, 0.01]},
    },
    "vary": VARY,
    "design": "random",
    "quantities": ["/flip_interval"],
}
LONG: dict[str, Any] = {
    "question": {
        "path": "/v1/rotation/trajectory",
        "request": {
            "body": BODY,
            "angular_velocity": [0.01, 1.0, 0.01],
            "times": [100.0],
            "method": {"kind": "runge-kutta-4", "step": 2e-3},
        },
    },
    "vary": [{"pointer": "/angular_velocity/0", "min": 0.001, "max": 0.1}],
    "design": "random",
    "quantities": ["/angular_velocity/0/1", "/accuracy/error"],
}
TICK = os.sysconf("SC_CLK_TCK")

GROUPS = Path("/sys/fs/cgroup/cpu")
SHARE, PERIOD = 0.2, 20_000
"""Part of a core that a process has which is held back, in every period (microseconds)."""
HELD_BACK = (1, 2, 4, 8)
MEMBERS_EACH = 400


def own_time(process: int) -> float:
    """Return the processor time of a process (s)."""
    fields = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICK


def processor_time(process: int) -> float:
    """Return the processor time of a process and its living descendants (s)."""
    return own_time(process) + sum(map(processor_time, children(process)))


def engine_of(server: Server) -> int:
    """Return the process that works on studies."""
    until = time.monotonic() + 30.0
    while time.monotonic() < until:
        for child in children(server.pid):
            if b"runner" in Path(f"/proc/{child}/cmdline").read_bytes():
                return child
        # The thread that has started it must have ended before it is the main thread's child.
        time.sleep(0.05)
    raise RuntimeError("no process works on studies")


@contextmanager
def held_back(processes: list[int]) -> Iterator[None]:
    """Let each of some processes have a share of a core and no more."""
    groups = {process: GROUPS / f"polhode_{process}" for process in processes}
    for process, group in groups.items():
        group.mkdir()
        (group / "cpu.cfs_period_us").write_text(str(PERIOD))
        (group / "cpu.cfs_quota_us").write_text(str(int(SHARE * PERIOD)))
        (group / "cgroup.procs").write_text(str(process))
    try:
        yield
    finally:
        for process, group in groups.items():
            (GROUPS / "cgroup.procs").write_text(str(process))
            group.rmdir()


def asked(port: int, method: str, path: str, body: Any = None) -> Any:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=120)
    headers = {} if body is None else {"content-type": "application/json"}
    connection.request(method, path, None if body is None else json.dumps(body), headers)
    answer = json.loads(connection.getresponse().read())
    connection.close()
    return answer


def downloaded(port: int, path: str, media: str) -> bytes:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=120)
    connection.request("GET", path, headers={"accept": media})
    answer = connection.getresponse().read()
    connection.close()
    return answer


def study(server: Server, folder: str, request: dict[str, Any]) -> dict[str, float]:
    """Run a study to its end: wall time from its first member to its last, and processor times (s).

    ``members`` is what its members took, ``engine`` what the process that divides and stores them, ``processes`` both
    with everything else that the cluster does.
    """
    state = asked(server.port, "POST", "/v1/studies", request)
    path = f"/v1/studies/{state['jobID']}"
    engine = engine_of(server)
    before, engine_before = processor_time(engine), own_time(engine)
    while state["status"] in ("accepted", "running"):
        time.sleep(0.5)
        state = asked(server.port, "GET", path)
    spent, engine_spent = processor_time(engine) - before, own_time(engine) - engine_before
    assert state["status"] == "successful", state
    with sqlite3.connect(Path(folder) / "studies.sqlite") as database:
        (chunks,) = database.execute("SELECT COUNT(*) FROM chunks WHERE study = ?", (state["jobID"],)).fetchone()
    moments = [np.datetime64(state[name][:23]) for name in ("started", "finished")]
    wall = float((moments[1] - moments[0]) / np.timedelta64(1, "s"))
    return {
        "wall": wall,
        "members": state["seconds"],
        "engine": engine_spent,
        "processes": spent,
        "count": state["count"],
        "stretches": chunks,
    }


def warm(server: Server, folder: str) -> None:
    """Have the processes of studies running, with everything loaded."""
    for request in (FLIPS, LONG):
        study(server, folder, {**request, "count": 400})


def scaling() -> list[dict[str, float]]:
    """Return what studies of as many members for each process take, with processes that are held back."""
    found = []
    for workers in HELD_BACK:
        with tempfile.TemporaryDirectory() as folder:
            settings = {"data": folder, "study_workers": str(workers), "study_idle_seconds": "600"}
            with service(**settings) as server:
                warm(server, folder)
                computing = [
                    inner
                    for child in children(engine_of(server))
                    if b"forkserver" in Path(f"/proc/{child}/cmdline").read_bytes()
                    for inner in children(child)
                ]
                assert len(computing) == workers
                with held_back(computing):
                    result = study(server, folder, {**LONG, "count": MEMBERS_EACH * workers})
                found.append({"workers": workers, **result, "per_second": result["count"] / result["wall"]})
    return found


def single_requests(server: Server, seconds: float) -> dict[str, float]:
    """Ask for one body after the other on one connection."""
    chance = np.random.default_rng(1)
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=120)
    count, before, since = 0, processor_time(server.pid), time.perf_counter()
    while time.perf_counter() - since < seconds:
        low, middle, spin = chance.random(3)
        question = {
            "body": {"kind": "principal-moments", "moments": [1.0 + 0.4 * low, 1.5 + 0.4 * middle, 2.0]},
            "angular_velocity": [0.001 + 0.1 * spin, 1.0, 0.01],
        }
        connection.request(
            "POST", "/v1/rotation/precession", json.dumps(question), {"content-type": "application/json"}
        )
        connection.getresponse().read()
        count += 1
    wall = time.perf_counter() - since
    return {"count": count, "wall": wall, "processes": processor_time(server.pid) - before}


def bodies(count: int) -> list[tuple[list[float], list[float]]]:
    chance = np.random.default_rng(2).random((count, 3))
    return [([1.0 + 0.4 * a, 1.5 + 0.4 * b, 2.0], [0.001 + 0.1 * c, 1.0, 0.01]) for a, b, c in chance.tolist()]


def flip_by_library(case: tuple[list[float], list[float]]) -> float:
    moments, spin = case
    x, y, z = spin
    return (
        precession(PrincipalMoments((moments[0], moments[1], moments[2])).mass_properties(), (x, y, z)).flip_interval
        or 0.0
    )


def flip_by_integration(case: tuple[list[float], list[float]]) -> float:
    """Return the time between two sign changes of the middle component, by DOP853 at a tolerance of 1e-9."""
    (a, b, c), spin = case

    def equations(time: float, w: Any) -> list[float]:
        return [(b - c) / a * w[1] * w[2], (c - a) / b * w[2] * w[0], (a - b) / c * w[0] * w[1]]

    def middle(time: float, w: Any) -> float:
        return float(w[1])

    found = solve_ivp(equations, (0.0, 500.0), spin, method="DOP853", rtol=1e-9, atol=1e-12, events=middle)
    first, second, *_ = found.t_events[0]
    return float(second - first)


def timed(work: Callable[[], Any]) -> float:
    since = time.perf_counter()
    work()
    return time.perf_counter() - since


def peers() -> dict[str, dict[str, float]]:
    """Return members per second of what one would write."""
    few, many = bodies(30), bodies(20_000)
    assert np.allclose([*map(flip_by_integration, few[:5])], [*map(flip_by_library, few[:5])], rtol=1e-6)
    found = {"scipy solve_ivp in a loop": (len(few), timed(lambda: [*map(flip_by_integration, few)]))}
    found["the library in a loop"] = (len(many), timed(lambda: [*map(flip_by_library, many)]))
    with multiprocessing.Pool(2) as pool:
        pool.map(flip_by_library, many[:100])
        found["multiprocessing.Pool(2)"] = (len(many), timed(lambda: pool.map(flip_by_library, many, chunksize=1000)))
    parallel = Parallel(n_jobs=2, batch_size=1000)
    parallel(delayed(flip_by_library)(case) for case in many[:100])
    found["joblib, 2 processes"] = (
        len(many),
        timed(lambda: parallel(delayed(flip_by_library)(case) for case in many)),
    )
    return {name: {"count": count, "wall": wall, "per_second": count / wall} for name, (count, wall) in found.items()}


def main(members: int = 1_000_000) -> None:
    """Measure and write the result."""
    before = os.getloadavg()
    result: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as folder:
        for workers in (1, 2):
            with service(data=folder, study_workers=str(workers), study_idle_seconds="600") as server:
                warm(server, folder)
                if workers == 1:
                    result["single requests"] = single_requests(server, 5.0)
                result[f"flips, {workers}"] = study(server, folder, {**FLIPS, "count": members})
                result[f"long, {workers}"] = study(server, folder, {**LONG, "count": 3000})
    result["held back"] = scaling()
    result["peers"] = peers()
    one, single = result["flips, 1"], result["single requests"]
    ratios = {
        "flips: study over single requests, wall, 1 process": one["count"]
        / one["wall"]
        * single["wall"]
        / single["count"],
        "flips: study over single requests, wall, 2 processes": result["flips, 2"]["count"]
        / result["flips, 2"]["wall"]
        * single["wall"]
        / single["count"],
        "flips: study over single requests, processor time": (single["processes"] / single["count"])
        / (one["processes"] / one["count"]),
        "flips: 2 processes over 1, wall": one["wall"] / result["flips, 2"]["wall"],
        "long members: 2 processes over 1, wall": result["long, 1"]["wall"] / result["long, 2"]["wall"],
        "long members: engine's share of processor time": 1.0
        - result["long, 1"]["members"] / result["long, 1"]["processes"],
        **{
            f"long members: {one['workers']:.0f} processes over 1, each with a fifth of a core": one["per_second"]
            / result["held back"][0]["per_second"]
            for one in result["held back"][1:]
        },
        "flips: processes that one engine supplies": result["flips, 1"]["members"] / result["flips, 1"]["engine"],
        "long members: processes that one engine supplies": result["long, 1"]["members"] / result["long, 1"]["engine"],
        "long members: wall over processor time of members, 1 process": result["long, 1"]["wall"]
        / result["long, 1"]["members"],
    }
    for name, ratio in ratios.items():
        print(f"{ratio:8.3g}  {name}")
    document = {
        "machine": described("dask", "distributed", "numpy", "scipy", "joblib"),
        "load_average": {"before": before, "after": os.getloadavg()},
        "seconds": result,
        "ratios": ratios,
    }
    (RESULTS / "studies.json").write_text(json.dumps(document, indent=2) + "\n")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
