"""What the models say of a study's tables: realism, preference, noticing, with uncertainty."""
