"""The application of one server process, for servers that take an import path: uvicorn service.server:app."""

from service.app import create_app
from service.observability.logs import configure
from service.settings import Settings

_SETTINGS = Settings()
configure(_SETTINGS.log_level)
app = create_app(_SETTINGS)
