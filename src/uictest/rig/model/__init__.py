"""The model of the rig: its records and how they are stepped."""
