"""From the fields of an answer to JSON, npz or SVG."""
