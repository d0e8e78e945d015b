"""What a Dockerfile says, as far as ours says it."""

from __future__ import annotations

import json
import re
import shlex
from dataclasses import dataclass, field


@dataclass
class Stage:
    """What follows one FROM.

    Attributes
    ----------
    image, name : str
    steps : list of (str, str)
        Instruction and argument, in order.
    """

    image: str
    name: str
    steps: list[tuple[str, str]] = field(default_factory=list)

    def last(self, instruction: str) -> str:
        """Return the argument of the last such instruction, or nothing."""
        return next((argument for found, argument in reversed(self.steps) if found == instruction), "")

    def entrypoint(self) -> list[str]:
        """Return the command that the image runs."""
        command: list[str] = json.loads(self.last("ENTRYPOINT"))
        return command

    def health_check(self) -> list[str]:
        """Return the command that tells whether it is well."""
        command: list[str] = json.loads(self.last("HEALTHCHECK").split("CMD", 1)[1])
        return command


def stages(text: str) -> list[Stage]:
    """Return the stages of a Dockerfile."""
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    joined = re.sub(r"\\\n\s*", " ", "\n".join(lines))
    found: list[Stage] = []
    for line in joined.splitlines():
        instruction, argument = line.split(None, 1)
        if instruction == "FROM":
            image, *named = argument.split()
            found.append(Stage(image, named[1] if named else str(len(found))))
        else:
            found[-1].steps.append((instruction, argument))
    return found


def assignments(argument: str, known: dict[str, str]) -> dict[str, str]:
    """Return the variables that ENV sets, with those of `known` put in."""
    pairs = (word.split("=", 1) for word in shlex.split(argument))
    return {name: re.sub(r"\$\{?(\w+)\}?", lambda found: known.get(found[1], ""), value) for name, value in pairs}
