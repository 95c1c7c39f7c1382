"""The designer's answer: per distance the cheapest LoD that is enough, by margins set before."""
