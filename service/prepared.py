"""Imported once by the fork server of the compute processes, which then inherit every kernel loaded and compiled."""

from core.integration.budget import Budget
from service.routing import TABLE
from service.settings import Settings
from service.worker import Terms, answering

_SETTINGS = Settings()
answering(Terms(TABLE, Budget(), _SETTINGS.max_nesting, _SETTINGS.max_keys)).warm()
