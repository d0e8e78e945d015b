"""Scenes whose parts share no connection: each part answered as if it were alone, and the answers joined."""
