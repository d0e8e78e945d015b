"""The examples, sent to a running service; what they show, by other means."""
