"""The kernel: the model of the rig as machine code, and what it is called with."""
