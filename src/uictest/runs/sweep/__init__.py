"""Sweeps: their chunks, and the results and reports of a finished one."""
