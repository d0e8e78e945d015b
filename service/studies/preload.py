"""Imported once by the fork server of the local cluster, whose processes then begin with everything loaded."""

import gc

import distributed
import scipy.special

import service.routes
import service.studies.task

__all__ = ["distributed", "scipy", "service"]

# The collector writes into every object that it visits: pages that processes share would be copied for each.
gc.collect()
gc.freeze()
