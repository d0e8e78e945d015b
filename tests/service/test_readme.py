"""The README lists what there is. Its code runs in tests/examples/test_code_blocks.py."""

import json
import re
from pathlib import Path

from service.routing import ENDINGS

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_the_table_lists_every_endpoint():
    table = "".join(re.findall(r"^\| `.*?\|", README, re.MULTILINE))
    paths = json.loads((ROOT / "docs" / "openapi.json").read_text())["paths"]
    listed = set(re.findall(r"(/[a-z0-9/.{}-]*)`", table))
    documented = {
        path for path in paths if not path.startswith("/v1/certified/") and not path.endswith(tuple(ENDINGS.values()))
    }
    assert listed == documented | {"/v1/certified/..."}
