"""The attitude of a freely rotating body."""
