"""Routes of certified answers."""
