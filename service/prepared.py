"""Imported once by the fork server of the compute processes, which then inherit every kernel loaded and compiled."""

from core.integration.budget import Budget
from service.reading import Limits
from service.routing import TABLE
from service.worker import Terms, answering

answering(Terms(TABLE, Budget(), Limits())).warm()
