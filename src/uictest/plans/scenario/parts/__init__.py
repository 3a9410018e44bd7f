"""The parts of the rig as a user describes them: one module per part, one frozen model per thing."""
