"""Scenes that the client describes: bodies, places and connections become a table of quadratics."""
