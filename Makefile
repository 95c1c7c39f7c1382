# The two commands that set everything up are `make study` and `make test`; `make help` lists the rest.
.DEFAULT_GOAL := help
.PHONY: help study test test-long test-fresh pictures lock clean

PYTHON := .venv/bin/python
# make study STUDY=my-study.toml ARGS="--port 8080"
STUDY ?=
ARGS ?=
# Processes that share the tests; each wants up to 3 GB.
JOBS ?= 2

help: ## show these lines
	@grep -E '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

study: ## set up what is missing, then run the study: site and renderer
	@deploy/setup study
	@exec .venv/bin/ocularist run $(STUDY) $(ARGS)

test: ## set up what is missing, then format, lint, types and tests
	@deploy/setup test
	$(PYTHON) -m ruff format --check .
	$(PYTHON) -m ruff check .
	$(PYTHON) -m mypy
	$(PYTHON) -m pytest -m "not long and not peer" -n $(JOBS) --dist loadfile $(ARGS)

test-long: ## long simulations and storms, other browsers, R as a peer; what needs more than make test
	@deploy/setup test-long
	$(PYTHON) -m pytest -m "long or peer" $(ARGS)

test-fresh: ## prove both set-ups in an empty Debian (root and debootstrap)
	@deploy/fresh

pictures: ## draw every page anew into docs/pictures/pages
	@deploy/setup test
	PICTURES=docs/pictures/pages $(PYTHON) -m pytest tests/site/test_every_page.py

lock: ## make the lock files anew from pyproject.toml
	@deploy/lock

clean: ## remove what was built; studies' data stay
	rm -rf .venv out build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
