"""Write the sources of the site: python -m docs.site build/site."""

from __future__ import annotations

import json
import shutil
import sys
from pathlib import Path

from docs.site.links import linked_files, moved, place_of
from docs.site.navigation import DOCS, navigation, pages
from docs.site.reference import reference


def write(folder: Path) -> None:
    """Write pages, the files that they link to, and the configuration of MkDocs."""
    sources, target = pages(), folder / "pages"
    if target.exists():
        shutil.rmtree(target)
    files: set[Path] = {DOCS / "openapi.json"}
    for place, source in sources.items():
        text = source.read_text(encoding="utf-8")
        files.update(linked_files(text, source))
        _put(target / place, moved(text, source, place, sources))
    for place, text in reference().items():
        _put(target / place, text)
    for file in files - {source.resolve() for source in sources.values()}:
        if file.is_file():
            copy = target / place_of(file)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, copy)
    shutil.copyfile(DOCS / "site/wide.css", target / "wide.css")
    # KaTeX typesets the formulas; the site loads nothing from elsewhere.
    shutil.copytree(DOCS / "site/katex", target / "katex")
    configuration = (DOCS / "site/mkdocs.yml").read_text(encoding="utf-8")
    # JSON is YAML, too.
    _put(folder / "mkdocs.yml", f"{configuration}nav: {json.dumps(navigation())}\n")


def _put(file: Path, text: str) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write(Path(sys.argv[1]))
