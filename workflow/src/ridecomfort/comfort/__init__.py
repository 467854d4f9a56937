"""The three comfort methods, from signals to critical sections, and how they agree."""
