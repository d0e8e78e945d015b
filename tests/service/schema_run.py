"""Schemathesis against a real server process: what the OpenAPI document promises is what is answered.

Run: python -m tests.service.schema_run [questions for each operation].
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from tests.service.conftest import Server

# Every check but one: that whatever fits the schema is accepted. Rules between fields (a mass or a density, a triangle
# of moments, a number of samples that one question may have) are stated in words there, and refused with their reason.
LEFT_OUT = "positive_data_acceptance"


def run(server: Server, phases: str, most: int, *options: str) -> subprocess.CompletedProcess[str]:
    """Run phases of schemathesis with at most so many random questions for each operation."""
    command = [str(Path(sys.executable).with_name("schemathesis")), "run", f"{server.url}/openapi.json"]
    checks = ["--checks", "all", "--exclude-checks", LEFT_OUT, "--phases", phases]
    bounds = ["--max-examples", str(most), "--generation-database", "none", "--no-color"]
    return subprocess.run([*command, *checks, *bounds, *options], check=False, text=True, stdout=subprocess.PIPE)


def main(most: int = 200) -> int:
    """Return the exit code of schemathesis."""
    server = Server(POLHODE_MAX_EVALUATIONS="200000", POLHODE_MAX_SAMPLES="2000")
    try:
        server.wait_until_ready()
        done = run(server, "examples,coverage,fuzzing", most)
        sys.stdout.write(done.stdout)
        return done.returncode
    finally:
        server.stop()


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:2])))
