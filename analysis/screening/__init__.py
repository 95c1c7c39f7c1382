"""Who answered how: bias, inconsistency, named flags and weights; whether a verdict hangs on one.

Nobody is deleted here: a flag lowers a person's weight, and a table says what it changes.
"""
