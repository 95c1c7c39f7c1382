"""Events stay as they are: the database itself refuses to change or delete them.

Revision 0004, after 0003. Only the events of somebody who withdraws may be deleted, while their
number stands in the table ``erasures``.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None

UNCHANGED = "events are added, never changed"
KEPT = "events are deleted only when their participant withdraws"
WITHDRAWS = "EXISTS (SELECT 1 FROM erasures WHERE participant_id = OLD.participant_id)"

SQLITE = (
    f"CREATE TRIGGER events_unchanged BEFORE UPDATE ON events "
    f"BEGIN SELECT RAISE(ABORT, '{UNCHANGED}'); END",
    f"CREATE TRIGGER events_kept BEFORE DELETE ON events WHEN NOT {WITHDRAWS} "
    f"BEGIN SELECT RAISE(ABORT, '{KEPT}'); END",
)
POSTGRESQL = (
    f"""
    CREATE FUNCTION events_unchanged() RETURNS trigger LANGUAGE plpgsql AS $$
    BEGIN
        IF TG_OP = 'DELETE' THEN
            IF {WITHDRAWS} THEN RETURN OLD; END IF;
            RAISE EXCEPTION '{KEPT}' USING ERRCODE = 'integrity_constraint_violation';
        END IF;
        RAISE EXCEPTION '{UNCHANGED}' USING ERRCODE = 'integrity_constraint_violation';
    END $$
    """,
    "CREATE TRIGGER events_unchanged BEFORE UPDATE OR DELETE ON events "
    "FOR EACH ROW EXECUTE FUNCTION events_unchanged()",
    f"""
    CREATE FUNCTION events_not_emptied() RETURNS trigger LANGUAGE plpgsql AS $$
    BEGIN
        RAISE EXCEPTION '{KEPT}' USING ERRCODE = 'integrity_constraint_violation';
    END $$
    """,
    "CREATE TRIGGER events_not_emptied BEFORE TRUNCATE ON events "
    "FOR EACH STATEMENT EXECUTE FUNCTION events_not_emptied()",
)


def upgrade() -> None:
    """Apply this revision."""
    op.create_table(
        "erasures",
        sa.Column("participant_id", sa.Integer(), nullable=False, autoincrement=False),
        sa.PrimaryKeyConstraint("participant_id", name=op.f("pk_erasures")),
    )
    is_sqlite = op.get_bind().dialect.name == "sqlite"
    for statement in SQLITE if is_sqlite else POSTGRESQL:
        op.execute(statement)
