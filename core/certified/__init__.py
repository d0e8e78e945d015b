"""The closed forms in ball arithmetic: answers with any number of proven digits."""
