"""Grade submissions with the answer keys in this folder, without a network.

python -I <this folder> < request.json

The request is {"question": name, "submissions": [...]}; the question may be left out if there is one. The answer on
standard output has the results that the service gives.
"""

import json
import sys
from pathlib import Path

from core.assessment.answer_key import AnswerKey

KEYS = Path(__file__).parent / "keys"


def main() -> None:
    """Read a request, write its results."""
    request = json.load(sys.stdin)
    names = sorted(file.stem for file in KEYS.glob("*.json"))
    name = request.get("question", names[0] if len(names) == 1 else None)
    if name not in names:
        sys.exit(f"the question must be one of: {', '.join(names)}")
    key = AnswerKey(json.loads((KEYS / f"{name}.json").read_text(encoding="utf-8")))
    json.dump({"results": key.results(request["submissions"])}, sys.stdout)


if __name__ == "__main__":
    main()
