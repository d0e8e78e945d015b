"""Compare what answers about described scenes cost in two versions; write benchmarks/results/side_by_side.json.

    python -m benchmarks.side_by_side BEFORE [REPEATS]

BEFORE is a checkout of the earlier version, with its kernels compiled. Both versions answer every scene of the
catalogue in turn, each in a process of its own, as the service answers it, without HTTP and JSON. Of every question the
least processor time counts, because other programs of the machine only ever add.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from benchmarks.machine import RESULTS, described
from core.multibody.solve import OF_MOTION
from core.systems.budget import Budget
from service.requests.described_scene import DescribedSceneRequest
from service.routes.described_scenes import described_examples, solved

QUESTIONS = ("whole", "whole without audit", "start", "start without audit")
"""Each example as it is; without times, where nothing that it asks for needs them; both with the audit switched off."""
LONG = 0.6
"""Processor time (s) after which a question is not repeated any more."""


def answer() -> None:
    """Answer questions that are named on the standard input, and print what each took (s); null where it is none."""
    examples = {entry["name"]: entry["example"] for entry in described_examples()}
    print(json.dumps(list(examples)), flush=True)
    for line in sys.stdin:
        name, question = json.loads(line)
        asked = DescribedSceneRequest.model_validate(json.loads(json.dumps(examples[name])))
        if question.startswith("start"):
            asked = without_times(asked)
        budget = Budget(audited=not question.endswith("without audit"))
        since = time.thread_time()
        solved(asked, budget)
        print(json.dumps(time.thread_time() - since), flush=True)


def without_times(asked: DescribedSceneRequest) -> DescribedSceneRequest:
    """Return a question without what needs times."""
    kept = [output for output in asked.outputs or () if isinstance(output, str) and output not in OF_MOTION]
    outputs = kept if asked.outputs else None
    return asked.model_copy(update={"times": None, "method": None, "round": None, "outputs": outputs})


class Version:
    """A version that answers questions in a process of its own."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process
        self.names: list[str] = self._read()

    def _read(self) -> Any:
        assert self.process.stdout is not None
        return json.loads(self.process.stdout.readline())

    def took(self, name: str, question: str) -> float:
        """Return the processor time of an answer (s)."""
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps([name, question]) + "\n")
        self.process.stdin.flush()
        return float(self._read())


def compared(versions: list[Version], name: str, repeats: int) -> Iterator[tuple[str, list[float]]]:
    """Yield what each question about a scene takes in both versions (ms)."""
    for question in QUESTIONS:
        spent: list[list[float]] = [[], []]
        for _ in range(1 + repeats):
            for own, version in zip(spent, versions, strict=True):
                own.append(version.took(name, question))
            if sum(map(sum, spent)) > LONG:
                break
        yield question, [round(1e3 * min(own), 3) for own in spent]


def summary(rows: dict[str, dict[str, list[float]]]) -> dict[str, Any]:
    """Return medians over the scenes, and of the ratio of the second version to the first."""
    found: dict[str, Any] = {}
    for question in QUESTIONS:
        pairs = [row[question] for row in rows.values()]
        found[question] = {
            "median before and after (ms)": [statistics.median(own) for own in zip(*pairs, strict=True)],
            "mean before and after (ms)": [statistics.mean(own) for own in zip(*pairs, strict=True)],
            "median ratio": statistics.median(after / before for before, after in pairs),
        }
    for of in ("whole", "start"):
        shares = [[1.0 - row[f"{of} without audit"][k] / row[of][k] for row in rows.values()] for k in (0, 1)]
        found[f"median share of the audit, {of}"] = [statistics.median(own) for own in shares]
    return found


def main(before: str, repeats: int) -> None:
    """Measure, write and print."""
    load, rows = os.getloadavg()[0], {}
    with ExitStack() as stack:
        versions = []
        for tree in (Path(before).resolve(), Path.cwd()):
            process = stack.enter_context(
                subprocess.Popen(
                    [sys.executable, __file__, "--answer"],
                    cwd=tree,
                    env={**os.environ, "PYTHONPATH": str(tree)},
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    text=True,
                )
            )
            stack.callback(process.kill)
            versions.append(Version(process))
        for name in (name for name in versions[1].names if name in versions[0].names):
            rows[name] = dict(compared(versions, name, repeats))
    result = {
        "machine": described(),
        "load average": {"before": load, "after": os.getloadavg()[0]},
        "all": summary(rows),
        "milliseconds before and after, by scene": rows,
    }
    (RESULTS / "side_by_side.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    print(json.dumps(result["all"], indent=1))


if __name__ == "__main__":
    if sys.argv[1] == "--answer":
        answer()
    else:
        main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 7)
