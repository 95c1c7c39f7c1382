"""The report: the answer in words, its tables, its page, its files."""
