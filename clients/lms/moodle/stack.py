"""A STACK question for Moodle with variants of a mechanics question: python stack.py question.json > question.xml.

The file has the request to POST /v1/variants, the text with {@name@} for each number that varies, and what is asked:

    {"name": "Flip interval", "text": "<p>... moments {@moments_1@} ...</p>", "variants": {...},
     "numbers": {"moments_1": "/body/moments/0"}, "pointer": "/flip_interval", "unit": "s", "rtol": 0.01}

STACK chooses a variant by `rand`; every variant is deployed. The service is that of POLHODE_URL.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as xml

from polhode_client import Client

Document = dict[str, Any]


def at(document: Any, pointer: str) -> Any:
    """Return what stands at a JSON pointer."""
    for step in pointer.split("/")[1:]:
        document = document[int(step)] if isinstance(document, list) else document[step]
    return document


def variables(spec: Document, variants: list[Document]) -> str:
    """Return the question variables: lists with an entry for each variant, one of which is chosen."""
    lists = {name: [at(one["request"], pointer) for one in variants] for name, pointer in spec["numbers"].items()}
    lists["answer"] = [one["figures"][0]["value"] for one in variants]
    lines = [f"variant: rand({len(variants)}) + 1;"]
    lines += [f"{name}: {json.dumps(values)}[variant];" for name, values in lists.items()]
    return "\n".join(lines)


def quiz(spec: Document, variants: list[Document]) -> bytes:
    """Return the file that Moodle imports as Moodle XML."""
    root = xml.Element("quiz")
    question = xml.SubElement(root, "question", type="stack")

    def text(parent: xml.Element, name: str, content: str, **attributes: str) -> None:
        xml.SubElement(xml.SubElement(parent, name, attributes), "text").text = content

    def fields(parent: xml.Element, **content: object) -> None:
        for name, value in content.items():
            xml.SubElement(parent, name).text = str(value)

    text(question, "name", spec["name"])
    text(question, "questiontext", f"{spec['text']}<p>[[input:ans1]] [[validation:ans1]]</p>", format="html")
    text(question, "generalfeedback", "", format="html")
    fields(question, defaultgrade=1, penalty=0.1, hidden=0)
    text(question, "questionvariables", variables(spec, variants))
    text(question, "specificfeedback", "[[feedback:prt1]]", format="html")
    text(question, "questionnote", "{@variant@}", format="html")
    fields(question, questionsimplify=1)
    answer = xml.SubElement(question, "input")
    unit = spec.get("unit")
    fields(answer, name="ans1", type="units" if unit else "numerical", tans=f"answer*{unit}" if unit else "answer")
    fields(answer, boxsize=15, strictsyntax=1, insertstars=0, forbidfloat=0, mustverify=1, showvalidation=1)
    tree = xml.SubElement(question, "prt")
    fields(tree, name="prt1", value=1, autosimplify=1, feedbackstyle=1)
    node = xml.SubElement(tree, "node")
    test = "UnitsRelative" if unit else "NumRelative"
    right = f"answer*{unit}" if unit else "answer"
    fields(node, name=0, answertest=test, sans="ans1", tans=right, testoptions=spec["rtol"], quiet=0)
    for outcome, score in (("true", 1), ("false", 0)):
        fields(node, **{f"{outcome}scoremode": "=", f"{outcome}score": score, f"{outcome}nextnode": -1})
        fields(node, **{f"{outcome}answernote": f"prt1-1-{outcome[0].upper()}"})
        text(node, f"{outcome}feedback", "", format="html")
    for seed in range(1, len(variants) + 1):
        fields(question, deployedseed=seed)
    xml.indent(root)
    written: bytes = xml.tostring(root, encoding="utf-8", xml_declaration=True)
    return written


def main() -> None:
    """Ask for the variants, write the question to standard output."""
    spec = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    with Client(os.environ.get("POLHODE_URL", "http://127.0.0.1:8000")) as polhode:
        variants: Any = polhode.vary(**spec["variants"] | {"quantities": [spec["pointer"]]})["variants"]
    plain = json.loads(json.dumps(variants, default=lambda array: array.tolist()))
    sys.stdout.buffer.write(quiz(spec, plain))


if __name__ == "__main__":
    main()
