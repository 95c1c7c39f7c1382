"""The commands of ``ocularist``, one module each. Importing one loads nothing heavy."""
