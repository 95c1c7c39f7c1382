"""The main character: face, lids, lashes, skin, hair, clothes and their light."""
