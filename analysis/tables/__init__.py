"""Tables of answers: what columns they have, and how they are read, checked and completed."""
