"""Run a sweep: chunks, the store on disk, shards and clusters."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
