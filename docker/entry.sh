#!/bin/sh
# Runs the service with the options that are given, or a command: docker run polhode dask scheduler.
set -eu
# The compiler reads what it keeps only from where it could also write, which the root file system is not.
mkdir -p "$NUMBA_CACHE_DIR"
cp -a "$COMPILED/." "$NUMBA_CACHE_DIR/"
case "${1-}" in
    "" | -*) set -- python -m service "$@" ;;
esac
exec "$@"
