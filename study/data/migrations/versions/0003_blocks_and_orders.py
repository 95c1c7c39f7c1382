"""Which block of clips and which row of the orders a participant has.

Revision 0003, after 0002.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Apply this revision."""
    op.add_column("participants", sa.Column("block", sa.Integer(), nullable=True))
    op.add_column("participants", sa.Column("order_row", sa.Integer(), nullable=True))
