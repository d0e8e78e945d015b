"""One request and its response: context, limits, keys, validators."""
