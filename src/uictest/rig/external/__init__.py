"""Stops with a controller from outside: in this process, or each in a child process that may crash."""
