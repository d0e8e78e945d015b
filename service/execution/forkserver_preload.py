"""Imported once by the fork server of the compute processes, which then inherit every kernel loaded and compiled."""

import gc

from service.execution.worker import handler_of, terms_of
from service.routing import TABLE
from service.settings import Settings

# Settings come from the environment, which the fork server inherits like the server processes.
handler_of(terms_of(Settings(), TABLE))
# The collector writes into every object that it visits: pages that processes share would be copied for each.
gc.collect()
gc.freeze()
