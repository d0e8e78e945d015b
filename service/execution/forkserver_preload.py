"""Imported once by the fork server of the compute processes, which then inherit every kernel loaded and compiled."""

import gc

# Next to nothing of what is made until the end of this module is garbage; to look for it takes a sixth of the time.
gc.disable()

from service.execution.unused_memory import give_back  # noqa: E402
from service.execution.worker import handler_of, terms_of  # noqa: E402
from service.observability.logs import configure  # noqa: E402
from service.routing import TABLE  # noqa: E402
from service.settings import Settings  # noqa: E402

# Settings come from the environment, which the fork server inherits like the server processes.
_settings = Settings()
configure(_settings.log_level)
handler_of(terms_of(_settings, TABLE))
give_back()
# The collector writes into every object that it visits: pages that processes share would be copied for each.
gc.freeze()
gc.enable()
