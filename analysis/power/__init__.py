"""Power before anyone is recruited: simulated observers take a study many times over.

Everything here works on a plain plan of who would see what; it knows no study file.
"""
