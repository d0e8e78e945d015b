"""Imported once by the fork server of the local cluster, whose processes then begin with everything loaded."""

import gc
from importlib import import_module

import service.studies.task  # noqa: F401

for name in ("distributed", "service.routes"):
    import_module(name)
# The collector writes into every object that it visits: pages that processes share would be copied for each.
gc.collect()
gc.freeze()
