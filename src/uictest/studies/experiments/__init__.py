"""The studies: each module is one and has it as `STUDY`."""
