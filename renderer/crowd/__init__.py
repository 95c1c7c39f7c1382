"""The other five people: bodies, clothes, motion, and how the cornea mirrors them."""
