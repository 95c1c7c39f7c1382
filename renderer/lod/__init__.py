"""Which LoD an eye of a given size is drawn with: the policy and what it rests on."""
