"""Where questions are answered: handler, cost model, admission, worker pool, response cache."""

PRELOAD = "service.execution.forkserver_preload"
"""The module that the fork server of the compute processes imports."""
