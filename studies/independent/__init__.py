"""The rig written a second time, for an integrator that chooses its own steps."""
