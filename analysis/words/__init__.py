"""Numbers, lists and our version as results write them: every room may use these."""
