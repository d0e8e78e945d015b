"""TypeScript clients that are generated: the project's own and those of two generators call every operation.

They compile in strict mode, with a type for each field of an answer, and a running service answers what they send.
Packages come from the npm registry.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pytest

ROOT = Path(__file__).parents[2]
DOCUMENT: dict[str, Any] = json.loads((ROOT / "docs" / "openapi.json").read_text())

STRICT = {
    "strict": True,
    "noUncheckedIndexedAccess": True,
    "target": "ES2022",
    "module": "ESNext",
    "moduleResolution": "bundler",
    "lib": ["ES2022", "DOM", "DOM.Iterable"],
    "types": ["node"],
    "noEmit": True,
}
PACKAGES = [
    "typescript@5.9",
    "@types/node@24",
    "esbuild",
    "openapi-typescript@7",
    "openapi-fetch",
    "@hey-api/openapi-ts",
]

HEAD = """
let study = "", calls = 0;
function need(value: unknown, name: string, error?: unknown) {
  if (value === undefined) throw new Error(name + " " + JSON.stringify(error));
  calls += 1;
}
const url = process.argv[2] ?? "";
const ready = () => new Promise((resolve) => setTimeout(resolve, 200));
"""
TAIL = "console.log(calls);"


class Call(NamedTuple):
    """An operation with one of its examples, and the first field of its answer (none of one that is not JSON)."""

    method: str
    path: str
    name: str
    question: Any
    field: str | None
    streamed: bool

    @property
    def needs_study(self) -> bool:
        return "{study}" in self.path


def calls() -> list[Call]:
    """Return every operation with its examples; a study is begun before it is looked at, and dismissed at the end."""
    found = [
        Call(method, path, entry["operationId"], question, field_of(entry), "events" in path)
        for path, verbs in DOCUMENT["paths"].items()
        for method, entry in verbs.items()
        for question in questions_of(path, entry)
    ]
    return sorted(found, key=lambda call: (call.needs_study, call.method == "delete"))


def questions_of(path: str, entry: Any) -> Iterator[Any]:
    if "requestBody" not in entry:
        yield None
        return
    plain = re.sub(r"\.svg$", "", path)
    content = DOCUMENT["paths"][plain]["post"]["requestBody"]["content"]["application/json"]
    for example in content["examples"].values():
        # Samples are what most drawings are of.
        if plain == path or "times" in example["value"]:
            yield example["value"]


def field_of(entry: Any) -> str | None:
    status = next(status for status in ("200", "202") if status in entry["responses"])
    schema = entry["responses"][status]["content"].get("application/json", {}).get("schema", {})
    if "$ref" not in schema:
        return None
    return next(iter(DOCUMENT["components"]["schemas"][schema["$ref"].rsplit("/", 1)[1]]["properties"]))


def lines_of_own(call: Call) -> str:
    given = ["study"] if call.needs_study else []
    given += [] if call.question is None else [json.dumps(call.question)]
    answer = f"await polhode.{call.name}({', '.join(given)})"
    if call.name == "create_study":
        return f"study = ({answer}).jobID; await polhode.finished(study); calls += 1;"
    return f'need(({answer}){f".{call.field}" if call.field else ""}, "{call.name}");'


def lines_of_fetch(call: Call) -> str:
    given = ["params: { path: { study } }"] if call.needs_study else []
    given += [] if call.question is None else [f"body: {json.dumps(call.question)}"]
    given += [] if call.field or call.name == "get_openapi" else ['parseAs: "text"']
    arguments = f", {{ {', '.join(given)} }}" if given else ""
    return answered(call, f'await client.{call.method.upper()}("{call.path}"{arguments})')


def lines_of_hey(call: Call) -> str:
    given = ["path: { study }"] if call.needs_study else []
    given += [] if call.question is None else [f"body: {json.dumps(call.question)}"]
    given += [] if call.field or call.name == "get_openapi" or call.streamed else ['parseAs: "text"']
    name = re.sub(r"_(\w)", lambda found: found[1].upper(), call.name)
    arguments = f"{{ {', '.join(given)} }}" if given else ""
    return answered(call, f"await sdk.{name}({arguments})", stream=call.streamed)


def answered(call: Call, sent: str, *, stream: bool = False) -> str:
    if stream:
        return f"{{ const r = {sent}; for await (const event of r.stream) need(event, 'event'); }}"
    lines = [f"const r = {sent};", f'need(r.data{f"?.{call.field}" if call.field else ""}, "{call.name}", r.error);']
    if call.name == "create_study":
        lines.append('study = r.data?.jobID ?? ""; await ended();')
    return f"{{ {' '.join(lines)} }}"


SCRIPTS = {
    "own": (
        'import { Polhode } from "polhode-client";',
        "const polhode = new Polhode(url);",
        lines_of_own,
    ),
    "openapi-typescript": (
        'import createClient from "openapi-fetch"; import type { paths } from "./schema.js";',
        "const client = createClient<paths>({ baseUrl: url });\n"
        "async function ended() { for (;;) {"
        " const r = await client.GET('/v1/studies/{study}', { params: { path: { study } } });"
        " if (r.data?.finished) return; await ready(); } }",
        lines_of_fetch,
    ),
    "hey-api": (
        'import { client } from "./hey/client.gen"; import * as sdk from "./hey/sdk.gen";',
        "client.setConfig({ baseUrl: url });\n"
        "async function ended() { for (;;) { const r = await sdk.getStudy({ path: { study } });"
        " if (r.data?.finished) return; await ready(); } }",
        lines_of_hey,
    ),
}


def run(*command: str, folder: Path) -> str:
    done = subprocess.run(command, cwd=folder, check=False, text=True, capture_output=True, timeout=600)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return done.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the packed client and the output of both generators, with no option of either."""
    place: Path = tmp_path_factory.mktemp("typescript")
    source = place / "clients" / "typescript"
    shutil.copytree(
        ROOT / "clients" / "typescript",
        source,
        ignore=shutil.ignore_patterns("node_modules", "dist", "schema.ts", "operations.ts"),
    )
    (place / "docs").mkdir()
    shutil.copy(ROOT / "docs" / "openapi.json", place / "docs")
    run("npm", "install", "--no-audit", "--no-fund", folder=source)
    packed = source / json.loads(run("npm", "pack", "--json", "--ignore-scripts", folder=source))[0]["filename"]
    (place / "package.json").write_text('{"private": true, "type": "module"}')
    run("npm", "install", "--no-audit", "--no-fund", *PACKAGES, str(packed), folder=place)
    run("npx", "openapi-typescript", "docs/openapi.json", "-o", "schema.ts", folder=place)
    run("npx", "openapi-ts", "-i", "./docs/openapi.json", "-o", "hey", "-c", "@hey-api/client-fetch", folder=place)
    return place


@pytest.mark.parametrize("client", SCRIPTS)
def test_every_operation_is_called_with_types(client: str, folder: Path, service: str) -> None:
    imports, made, line = SCRIPTS[client]
    listed = calls()
    script = "\n".join([imports, HEAD, made, *map(line, listed), TAIL])
    (folder / f"{client}.ts").write_text(script)
    (folder / f"{client}.json").write_text(json.dumps({"compilerOptions": STRICT, "include": [f"{client}.ts"]}))
    run("npx", "tsc", "-p", f"{client}.json", folder=folder)
    run(
        "npx",
        "esbuild",
        f"{client}.ts",
        "--bundle",
        "--platform=node",
        "--format=esm",
        f"--outfile={client}.mjs",
        folder=folder,
    )
    assert int(run("node", f"{client}.mjs", service, folder=folder)) >= len(listed)


TYPED = {
    "const a = await polhode.precession({ body: coin, angular_velocity: [1, 1, 1] });": None,
    "const interval: number | null = a.flip_interval;": None,
    "(await polhode.precession({ body: coin, angular_velocity: [1, 1, 1] })).flip_intervals;": "TS2551",
    "await polhode.precession({ body: coin, angular_velocities: [1, 1, 1] });": "TS2561",
    'await polhode.wobble({ period: "430" });': "TS2322",
    "const drawn: string = await polhode.energy_ellipsoid_svg({ body: coin, angular_velocity: [1, 1, 1] });": None,
}
"""By line, which fault of types it has."""


def test_a_type_checker_knows_questions_and_answers(folder: Path) -> None:
    head = [
        'import { Polhode, type components } from "polhode-client";',
        'const polhode = new Polhode("http://test");',
        'const coin: components["schemas"]["PrincipalMoments"] = { kind: "principal-moments", moments: [1, 1, 2] };',
    ]
    (folder / "typed.ts").write_text("\n".join([*head, *TYPED]))
    (folder / "typed.json").write_text(json.dumps({"compilerOptions": STRICT, "include": ["typed.ts"]}))
    done = subprocess.run(["npx", "tsc", "-p", "typed.json"], cwd=folder, check=False, text=True, capture_output=True)
    for number, fault in enumerate(TYPED.values(), len(head) + 1):
        found = re.findall(rf"^typed.ts\({number},\d+\): error (TS\d+)", done.stdout, re.MULTILINE)
        assert found == ([] if fault is None else [fault]), done.stdout


RETRIED = """
import { Polhode, Refused } from "polhode-client";
const sent: (string | undefined)[] = [];
const replies = [429, 202, 202, 503, 422].map((status) => new Response(
  JSON.stringify({ code: "too-busy", detail: "later", jobID: "one" }),
  { status, headers: status === 429 ? { "retry-after": "0" } : status === 503 ? { "retry-after": "99" } : {} }));
const polhode = new Polhode("http://test/", { fetch: async (_, made) => {
  sent.push((made?.headers as Record<string, string>)["idempotency-key"]);
  return replies.shift() ?? Response.error();
} });
const study = { question: { path: "/v1/rotation/wobble", request: {} }, vary: [], quantities: [] };
await polhode.create_study(study);
await polhode.create_study(study);
const refused: unknown[] = [];
for (const _ of "ab") await polhode.wobble({}).catch((error) => refused.push(error));
const known = refused.map((one) => one instanceof Refused && [one.status, one.retryAfter]);
console.log(JSON.stringify({ sent, refused: known }));
"""


def test_a_busy_service_is_retried_after_the_time_that_it_names(folder: Path) -> None:
    (folder / "retried.ts").write_text(RETRIED)
    run(
        "npx",
        "esbuild",
        "retried.ts",
        "--bundle",
        "--platform=node",
        "--format=esm",
        "--outfile=retried.mjs",
        folder=folder,
    )
    found = json.loads(run("node", "retried.mjs", folder=folder))
    first, again, other, *rest = found["sent"]
    assert first == again != other
    assert rest == [None, None]
    # Longer than the patience, and nothing to wait for.
    assert found["refused"] == [[503, 99], [422, None]]
