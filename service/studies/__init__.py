"""Studies in the background: what is stored of them, the process that works on them, and their resources over HTTP."""
