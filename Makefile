# make run    the window on a gallery case; without a display, a picture of it
# make test   lint, types, import contracts and all tests, on all cores
# make docs   the documentation, into build/docs
# make bench  the performance figures beside what they are to be; LARGE=--large measures the largest sizes too (minutes)
# make table  the table of docs/anisotropic.md (minutes); CROSSVIEW_DATA names a folder of surfaces
# make study  100 random configurations made valid, plates improved, scans simplified, the anticube from random starts:
#             the tables of docs/make_valid.md and docs/natural.md (minutes); CROSSVIEW_DATA names a folder of surfaces
# make maps   how many surfaces get their map: the tables of docs/maps.md (an hour); CROSSVIEW_DATA names a folder
# make screenshots  the window in twelve situations, and all on one sheet: build/screenshots
# make keys   the table of case keys in README.md
# make bench-peers  quads beside other meshers, on the same surfaces: the table of docs/quads.md (minutes)
# make fuzz   20 000 damaged files of every format, none of which may do harm (ten minutes)
# make dist   wheel and sdist into dist/, and their tests away from here
# make lock   requirements-lock.txt: the versions that are installed here, which were tested
# make bundle an application that needs no Python, by PyInstaller: dist/crossview/
# make clean  forget the environment and every cache
PYTHON ?= python3
VENV := .venv
CASE := resources/gallery/disk-4.json
PICTURE := crossview.png
# a virtual screen for the window's tests; macOS needs none
XVFB := $(if $(filter Darwin,$(shell uname)),,xvfb-run -a -s "-screen 0 1600x1200x24")
PIP_INSTALL := $(VENV)/bin/python -m pip install --disable-pip-version-check

.PHONY: run test docs bench table study maps screenshots keys bench-peers fuzz dist lock bundle clean

run:
	@sh tools/system-packages.sh window "$(PYTHON)"
	@$(MAKE) --no-print-directory $(VENV)/installed
	@sh tools/run.sh "$(VENV)/bin/crossview" "$(CASE)" "$(PICTURE)"

test:
	@sh tools/system-packages.sh test "$(PYTHON)"
	@$(MAKE) --no-print-directory $(VENV)/installed-test
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .
	$(VENV)/bin/mypy
	$(VENV)/bin/lint-imports
	OPENBLAS_NUM_THREADS=1 $(XVFB) $(VENV)/bin/python -m pytest -n auto

docs:
	@sh tools/system-packages.sh window "$(PYTHON)"
	@$(MAKE) --no-print-directory $(VENV)/installed-docs
	$(VENV)/bin/python -m sphinx --fail-on-warning --keep-going docs build/docs

bench:
	@sh tools/system-packages.sh test "$(PYTHON)"
	@$(MAKE) --no-print-directory $(VENV)/installed-bench
	$(XVFB) $(VENV)/bin/python -m pytest benchmarks $(LARGE)

table:
	@$(MAKE) --no-print-directory $(VENV)/installed
	$(VENV)/bin/python -m benchmarks.table docs/anisotropic.md

study:
	@$(MAKE) --no-print-directory $(VENV)/installed
	$(VENV)/bin/python -m benchmarks.make_valid docs/make_valid.md
	$(VENV)/bin/python -m benchmarks.better_places docs/make_valid.md
	$(VENV)/bin/python -m benchmarks.anticube docs/natural.md

maps:
	@$(MAKE) --no-print-directory $(VENV)/installed
	mkdir -p build && rm -f build/maps.jsonl
	$(VENV)/bin/python -m benchmarks.maps docs/maps.md build/maps.jsonl

screenshots:
	@sh tools/system-packages.sh test "$(PYTHON)"
	@$(MAKE) --no-print-directory $(VENV)/installed
	$(subst 1600x1200,2600x1700,$(XVFB)) $(VENV)/bin/python -m tools.screenshots

keys:
	@$(MAKE) --no-print-directory $(VENV)/installed
	$(VENV)/bin/python -m tools.case_table README.md

bench-peers:
	@$(MAKE) --no-print-directory $(VENV)/installed-peers
	$(VENV)/bin/python -m benchmarks.peers docs/quads.md

fuzz:
	@$(MAKE) --no-print-directory $(VENV)/installed
	OPENBLAS_NUM_THREADS=1 $(VENV)/bin/python -m tools.fuzz 20000

dist:
	@sh tools/system-packages.sh test "$(PYTHON)"
	@$(MAKE) --no-print-directory $(VENV)/bin/python
	$(XVFB) sh tools/archives.sh "$(CURDIR)/$(VENV)/bin/python"

lock:
	@$(MAKE) --no-print-directory $(VENV)/installed-test
	$(VENV)/bin/python tools/lock.py

bundle:
	@sh tools/system-packages.sh window "$(PYTHON)"
	@$(MAKE) --no-print-directory $(VENV)/installed-bundle
	$(VENV)/bin/python tools/bundle.py

$(VENV)/bin/python:
	"$(PYTHON)" -m venv $(VENV)

$(VENV)/installed: pyproject.toml | $(VENV)/bin/python
	$(PIP_INSTALL) --editable .
	@touch $@

$(VENV)/installed-%: pyproject.toml | $(VENV)/bin/python
	$(PIP_INSTALL) --editable ".[$*]"
	@touch $@ $(VENV)/installed

clean:
	rm -rf $(VENV) build dist docs/written *.egg-info .benchmarks .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache $(PICTURE)
	find crossview solvers resources tests -name __pycache__ -prune -exec rm -rf {} +
