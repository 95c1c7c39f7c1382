"""Personal links, outcomes, where people come from, and withdrawals without a person."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "links",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("study_id", sa.Integer(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("token_hash", sa.String(length=64), nullable=False),
        sa.Column("is_used", sa.Boolean(), nullable=False),
        sa.Column("participant_id", sa.Integer(), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(["study_id"], ["studies.id"], name=op.f("fk_links_study_id")),
        sa.ForeignKeyConstraint(
            ["participant_id"], ["participants.id"], name=op.f("fk_links_participant_id")
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_links")),
        sa.UniqueConstraint("token_hash", name=op.f("uq_links_token_hash")),
        sa.UniqueConstraint("study_id", "number", name=op.f("uq_links_study_id_number")),
    )
    op.create_index("ix_links_participant", "links", ["participant_id"])
    op.create_table(
        "withdrawals",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("study_id", sa.Integer(), nullable=False),
        sa.Column("simulated", sa.Boolean(), nullable=False),
        sa.Column("withdrawn_on", sa.Date(), nullable=False),
        sa.Column("step", sa.String(length=30), nullable=False),
        sa.ForeignKeyConstraint(["study_id"], ["studies.id"], name=op.f("fk_withdrawals_study_id")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_withdrawals")),
    )
    op.add_column("participants", sa.Column("outcome", sa.String(length=30), nullable=True))
    op.add_column("participants", sa.Column("arrival", sa.JSON(), nullable=True))
    op.add_column("participants", sa.Column("person_key", sa.String(length=64), nullable=True))
    op.create_index("ix_participants_person_key", "participants", ["person_key"], unique=True)
    op.execute(
        "UPDATE participants SET outcome = 'completed' "
        "WHERE completed_at IS NOT NULL AND withdrawn_at IS NULL"
    )
    # What stood for those who withdrew was a row with their pseudonym; its day is all that is kept.
    op.execute(
        "INSERT INTO withdrawals (study_id, simulated, withdrawn_on, step) "
        "SELECT study_id, simulated, DATE(withdrawn_at), '' FROM participants "
        "WHERE withdrawn_at IS NOT NULL ORDER BY withdrawn_at"
    )
    op.execute("DELETE FROM participants WHERE withdrawn_at IS NOT NULL")
    # Not as a batch: SQLite would make the table anew, and refuse for the rows that refer to it.
    op.drop_column("participants", "withdrawn_at")
