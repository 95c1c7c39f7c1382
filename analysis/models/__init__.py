"""Statistical models of what observers answer: fitted on counts, ignorant of tables and charts."""
