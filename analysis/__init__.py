"""Statistics and charts from tidy tables: plain tables in, tables and figures out.

Imports nothing of the renderer or the study: it works on anyone's ratings. Importing it loads no
plotting library.
"""

from analysis.table import COLUMNS, Column, accepted_in, codebook, column_names, columns_of

__all__ = ["COLUMNS", "Column", "accepted_in", "codebook", "column_names", "columns_of"]
