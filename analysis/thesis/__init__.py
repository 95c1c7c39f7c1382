"""The thesis's findings beside these data."""
