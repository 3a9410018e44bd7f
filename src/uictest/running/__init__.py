"""Many stops: on threads, in chunks, on clusters."""
