"""The free body computed by this project and by its peers, in one run: errors against 50 digits, medians of times.

`python -m benchmarks.peers` measures it and writes benchmarks/results/peers.json, docs/peers.md and the pictures;
docs/decisions/0012-fair-comparison.md has the rules.
"""
