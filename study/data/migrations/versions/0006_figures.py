"""The dashboard's figures: what was drawn of a study's answers, when, and by whom.

Revision 0006, after 0005.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Apply this revision."""
    op.create_table(
        "figure_sets",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("study_id", sa.Integer(), nullable=False),
        sa.Column("kind", sa.String(length=20), nullable=False),
        sa.Column("as_of", sa.DateTime(timezone=True), nullable=True),
        sa.Column("seen", sa.String(length=100), nullable=True),
        sa.Column("took_s", sa.Double(), nullable=True),
        sa.Column("summary", sa.JSON(), nullable=True),
        sa.Column("claimed_by", sa.String(length=200), nullable=True),
        sa.Column("lease_until", sa.DateTime(timezone=True), nullable=True),
        sa.Column("started_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("error", sa.Text(), nullable=True),
        sa.Column("failed_at", sa.DateTime(timezone=True), nullable=True),
        sa.ForeignKeyConstraint(["study_id"], ["studies.id"], name=op.f("fk_figure_sets_study_id")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_figure_sets")),
        sa.UniqueConstraint("study_id", "kind", name=op.f("uq_figure_sets_study_id_kind")),
    )
    op.create_table(
        "figure_files",
        sa.Column("set_id", sa.Integer(), nullable=False),
        sa.Column("name", sa.String(length=100), nullable=False),
        sa.Column("content", sa.LargeBinary(), nullable=False),
        sa.ForeignKeyConstraint(
            ["set_id"], ["figure_sets.id"], name=op.f("fk_figure_files_set_id")
        ),
        sa.PrimaryKeyConstraint("set_id", "name", name=op.f("pk_figure_files")),
    )
