"""Routes of free rotation."""
