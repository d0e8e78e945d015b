"""From the bytes of a request to a validated question, or to messages about its errors."""
