"""What the OpenAPI document promises is what a server answers, as schemathesis tries it.

`make schemathesis` tries more: every edge of every schema, and random questions with another seed each time.
"""

from __future__ import annotations

from tests.service.conftest import Server
from tests.service.schema_run import run


def test_schemathesis_finds_nothing(server: Server) -> None:
    done = run(server, "examples,fuzzing", 10, "--seed", "1758")
    assert done.returncode == 0, done.stdout
    assert "❌" not in done.stdout
