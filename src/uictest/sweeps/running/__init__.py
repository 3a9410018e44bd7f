"""Run a sweep: chunks, the store on disk, shards and clusters."""
