"""What people wrote: a code book, and how many mention what."""
