"""``python -m study`` is ``ocularist``: how ``ocularist run`` starts its two processes."""

from study.cli import main

raise SystemExit(main())
