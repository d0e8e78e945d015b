"""Imported once by the fork server of the compute processes, which then inherit every kernel loaded and compiled."""

import gc

from core.integration.budget import Budget
from service.reading import Limits
from service.routing import TABLE
from service.worker import Terms, answering

answering(Terms(TABLE, Budget(), Limits())).warm()
# The collector writes into every object that it visits: pages that processes share would be copied for each.
gc.collect()
gc.freeze()
