"""The documentation as a static site: `make site` writes the sources for MkDocs with this package, and builds them."""
