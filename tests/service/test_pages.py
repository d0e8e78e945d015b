"""The pages as files: each is served, none needs anything from elsewhere, all together weigh little."""

import gzip
import json
import re
from pathlib import Path

import httpx
import pytest

from core.multibody.language.connection import TimedConnection
from core.multibody.language.kinds import KINDS as CONNECTIONS
from service.app import Service
from service.routes.pages import FOLDER
from tests.service.conftest import client_of, inline_toys

pytestmark = pytest.mark.anyio

PAGES = {"/": "index.html", "/scenes": "scenes.html", "/docs": "docs.html"}
KINDS = {".js": "text/javascript", ".css": "text/css", ".txt": "text/plain"}
VENDOR = FOLDER / "vendor"
SERVED = {f"/page/{file.relative_to(FOLDER).as_posix()}": file for file in FOLDER.rglob("*") if file.suffix in KINDS}
OWN = [file for file in FOLDER.glob("*") if file.is_file()]
RECIPES = {"package.json", "three.entry.mjs", "three.d.ts", "uplot.d.ts"}
"""Of the vendored files, and their types; they are not served."""


@pytest.fixture(scope="module")
def service() -> Service:
    return inline_toys()


@pytest.fixture
async def client(service: Service):  # type: ignore[no-untyped-def]
    async with client_of(service) as open_client:
        yield open_client


async def test_every_file_is_served_and_validated(client: httpx.AsyncClient) -> None:
    assert len(SERVED) > 25
    for path, file in (SERVED | {path: FOLDER / name for path, name in PAGES.items()}).items():
        response = await client.get(path)
        assert response.status_code == 200, path
        assert response.content == file.read_bytes()
        kind = KINDS.get(file.suffix, "text/html")
        assert response.headers["content-type"] == f"{kind}; charset=utf-8"
        assert response.headers["cache-control"] == "no-cache"
        again = await client.get(path, headers={"if-none-match": response.headers["etag"]})
        assert (again.status_code, again.content) == (304, b"")
        head = await client.head(path)
        assert (head.status_code, head.content) == (200, b"")


async def test_recipes_and_folders_are_not_served(client: httpx.AsyncClient) -> None:
    for path in (
        "/page/vendor/package.json",
        "/page/vendor/three.entry.mjs",
        "/page/vendor/",
        "/page",
        "/page/../app.py",
    ):
        assert (await client.get(path)).status_code == 404


async def test_pages_may_load_and_ask_only_this_service(client: httpx.AsyncClient) -> None:
    for path in PAGES:
        policy = (await client.get(path)).headers["content-security-policy"]
        directives = dict(part.strip().split(" ", 1) for part in policy.split(";"))
        assert directives["default-src"] == "'none'"
        assert directives["script-src"] == directives["connect-src"] == "'self'"


async def test_files_are_no_operations_of_the_api(client: httpx.AsyncClient) -> None:
    paths = (await client.get("/openapi.json")).json()["paths"]
    assert set(PAGES) <= set(paths)
    assert not [path for path in paths if path.startswith("/page/")]


def test_own_files_name_no_other_place() -> None:
    for file in OWN:
        text = file.read_text(encoding="utf-8")
        assert not re.search(r"(?:https?:)?//[\w-]+\.\w", text.replace("// ", "")), file.name


def test_what_pages_name_is_there() -> None:
    for name in PAGES.values():
        text = (FOLDER / name).read_text(encoding="utf-8")
        named = re.findall(r'(?:src|href)="(/page/[^"]+)"', text)
        assert len(named) >= 4
        assert set(named) <= set(SERVED)
        assert not re.search(r"<script(?![^>]* src=)|\son\w+=", text), "the policy forbids scripts in the text"


def test_what_scripts_import_is_there() -> None:
    for file in FOLDER.glob("*.js"):
        for target in re.findall(r'from "(\./[^"]+)"', file.read_text(encoding="utf-8")):
            assert (file.parent / target).is_file(), (file.name, target)


def test_scripts_import_what_the_vendored_build_exports() -> None:
    exported = set(re.findall(r"\b[A-Z]\w+", (VENDOR / "three.entry.mjs").read_text(encoding="utf-8")))
    imported = set()
    for file in FOLDER.glob("*.js"):
        for names in re.findall(r'import \{([^}]+)\} from "./vendor/three.js"', file.read_text(encoding="utf-8")):
            imported |= set(names.replace(" ", "").replace("\n", "").strip(",").split(","))
    assert imported <= exported
    assert len(imported) > 15


def test_the_inspector_has_spans_of_what_begins_and_ends() -> None:
    line = next(line for line in (FOLDER / "part_fields.js").read_text().splitlines() if "WITHOUT_SPAN =" in line)
    always = {name for name, kind in CONNECTIONS.items() if not issubclass(kind, TimedConnection)}
    assert set(re.findall('"([a-z-]+)"', line)) == always


def test_everything_vendored_has_its_licence_and_an_exact_version() -> None:
    packages = json.loads((VENDOR / "package.json").read_text(encoding="utf-8"))
    for name, version in (packages["dependencies"] | packages["devDependencies"]).items():
        assert re.fullmatch(r"\d+\.\d+\.\d+", version), name
    for stem in ("three", "uplot", "swagger-ui"):
        licence = (VENDOR / f"{stem}.LICENSE.txt").read_text(encoding="utf-8")
        assert "MIT" in licence or "Apache License" in licence
    for file in VENDOR.iterdir():
        known = file.name in RECIPES or file.name.endswith(".LICENSE.txt")
        assert known or any(
            (VENDOR / f"{stem}.LICENSE.txt").exists() for stem in (file.stem, file.stem.removesuffix("-bundle"))
        )


def weight(files: list[Path]) -> int:
    return sum(len(gzip.compress(file.read_bytes(), 9)) for file in files)


def test_the_pages_weigh_at_most_900_kilobytes_gzipped() -> None:
    code = [file for file in FOLDER.rglob("*") if file.suffix in (".js", ".css", ".html")]
    assert weight(code) <= 900_000
    assert weight([file for file in code if not file.name.startswith("swagger-ui")]) <= 350_000


def test_links_into_the_reference_lead_to_operations() -> None:
    document = json.loads((FOLDER.parents[1] / "docs" / "openapi.json").read_text(encoding="utf-8"))
    operations = {
        (tag, operation["operationId"])
        for path in document["paths"].values()
        for operation in path.values()
        if isinstance(operation, dict) and "operationId" in operation
        for tag in operation["tags"]
    }
    links = {found for file in OWN for found in re.findall(r"/docs#/(\w+)/(\w+)", file.read_text(encoding="utf-8"))}
    assert links
    assert links <= operations
