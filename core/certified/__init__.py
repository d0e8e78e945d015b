"""The closed forms in ball arithmetic: answers to any number of digits, every one of them proven."""
