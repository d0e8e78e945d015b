"""How uncertain inputs move a free rotation."""
