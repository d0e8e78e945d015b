"""Scenes with contacts: this project beside physics engines, on questions with closed forms and where there is none.

`python -m benchmarks.contact_peers` measures and writes benchmarks/results/contact_peers.json; the page of the peers
shows it.
"""
