"""Study data: database, events, jobs, export. The only place that speaks SQL."""
