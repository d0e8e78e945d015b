"""Grade the worked homework, number by number: python -m examples.grade_homework [--service http://127.0.0.1:8000]."""

from __future__ import annotations

import argparse

from examples.ask import ask, names, service_url

FOLDER = "assessments/"


def main() -> None:
    """Print a line for each number that was submitted."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--service", default=service_url())
    service = parser.parse_args().service
    for name in names():
        if name.startswith(FOLDER):
            for result in ask(name, service)["results"]:
                for test in result["tests"]:
                    print(f"{name.removeprefix(FOLDER):10} {test['pointer']:31} {test['verdict']:10} {test['score']}")
                    if not test["correct"]:
                        print(f"           {test['feedback']}")


if __name__ == "__main__":
    main()
