"""How a sweep is run: chunks, the store that keeps them, shards and clusters."""
