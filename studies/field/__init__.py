"""The stop of the real train, and the stops of the rig that are held against it."""
