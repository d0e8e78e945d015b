"""The independent check of an answer about a described scene against its description."""
