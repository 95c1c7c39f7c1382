"""From a photograph of an eye to an iris's maps: what ``ocularist iris`` does."""
