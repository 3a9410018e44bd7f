"""Summarise the rows of a sweep: counts, maps, trends, sensitivities, frontiers."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
