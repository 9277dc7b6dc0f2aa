# Everything that Demoscope needs is set up the first time, in .venv; later calls start at once.

ARGS ?=
PYTHON ?=
python := .venv/bin/python
side-by-side := --numprocesses auto --maxprocesses 4 --dist loadfile
extras-test := [test]
extras-bench := [bench]

.PHONY: help run test bench pictures clean libraries

help:
	@echo "make run     open Demoscope; with no display, write one picture of every scene and say where"
	@echo "             make run ARGS=rippling_sphere opens one scene, make run ARGS='list' lists them"
	@echo "make test    check style and types, then run the tests; ARGS go to pytest"
	@echo "make bench   measure speed, beside other viewers; ARGS='panels --rounds 3' for a part of it"
	@echo "make pictures   draw the README's pictures again"
	@echo "make clean   remove .venv and whatever was built; pictures in captures/ stay"
	@echo "PYTHON=...   the Python to use, 3.11 or newer (default: the first one found)"

run: libraries .venv/.ready-run
	@$(python) -m viewer $(ARGS)

# Mesa then offers no more than OpenGL 3.3, so that newer functions fail here and not on a lecturer's laptop.
# All three run, whatever fails, and pytest's summary comes last.
test: libraries .venv/.ready-test
	@status=0; \
	$(python) -m ruff check . || status=1; \
	$(python) -m mypy --strict viewer scenes || status=1; \
	MESA_GL_VERSION_OVERRIDE=3.3 MESA_GLSL_VERSION_OVERRIDE=330 $(python) -m pytest $(side-by-side) $(ARGS) || status=1; \
	exit $$status

bench: libraries .venv/.ready-bench
	@$(python) -m tests.benchmarks $(ARGS)

pictures: libraries .venv/.ready-run
	@.ci/pictures $(python) assets/pictures

clean:
	rm -rf .venv build dist tests/failures .mypy_cache .pytest_cache .ruff_cache
	find viewer scenes tests -name __pycache__ -prune -exec rm -rf {} +

libraries: $(python)
	@.ci/system-libraries $(python)

$(python):
	@.ci/virtualenv $(PYTHON)

.venv/.ready-%: $(python) pyproject.toml
	@echo "Installing Demoscope$(extras-$*) and what it needs into .venv; the first time takes a minute or two"
	@$(python) -m pip install --quiet --disable-pip-version-check --editable '.$(extras-$*)'
	@$(python) -m compileall -q viewer
	@touch $@ .venv/.ready-run
