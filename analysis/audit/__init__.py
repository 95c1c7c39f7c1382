"""What a design can and cannot say: cells shown, LoDs linked by comparisons, catch, sides."""

from analysis.audit.auditing import audit_design, audit_tables, shown_clips
from analysis.audit.design import Audit, ShownClip

__all__ = ["Audit", "ShownClip", "audit_design", "audit_tables", "shown_clips"]
