"""Judging a stop: figures in the engineer's units, criteria, verdicts, outcome, the result document."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
