"""The pages in a real browser. `make browser` runs these tests in an environment of their own."""
