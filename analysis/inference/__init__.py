"""From tables to verdicts: every model of a study fitted once, and what each person moves."""
