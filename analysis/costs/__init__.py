"""What LoDs cost on a renderer, and what cheaper ones save."""
