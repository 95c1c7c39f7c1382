"""The study as data and rules: definition, schedule, audit. Pure: no web, no database, no clock."""
