"""What a user writes: scenarios, sweeps, series, validations, and the library they refer to."""
