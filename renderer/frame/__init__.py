"""One frame from first pass to last: views, targets, edges and bloom; see docs/frame.md."""
