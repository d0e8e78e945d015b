"""The product's answers about described scenes beside those of the plain engine."""
