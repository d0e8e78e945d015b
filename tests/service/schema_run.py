"""Schemathesis against a real server process: what the OpenAPI document promises is what is answered.

Run: python -m tests.service.schema_run [questions for each operation].
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from tests.service.conftest import Server


def main(most: int = 100) -> int:
    """Return the exit code of schemathesis."""
    server = Server(POLHODE_MAX_EVALUATIONS="200000", POLHODE_MAX_SAMPLES="2000")
    try:
        server.wait_until_ready()
        command = Path(sys.executable).with_name("schemathesis")
        options = ["--checks", "not_a_server_error,content_type_conformance,response_schema_conformance"]
        bounds = ["--max-examples", str(most), "--phases", "examples,fuzzing"]
        return subprocess.run([command, "run", f"{server.url}/openapi.json", *options, *bounds], check=False).returncode
    finally:
        server.stop()


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:2])))
