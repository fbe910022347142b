# Two commands do it all: `make run` opens the program, `make test` checks it. Both set up first what they need.
.DEFAULT_GOAL := help
.NOTPARALLEL:
.PHONY: help run test setup setup-test lint types bench fuzz words lock docs docs-pictures package package-numbers setup-package package-test check-windows clean
export PYTHON

python := .venv/bin/python
# What the user guide is built of: where something is newer than site/, make run builds the guide again.
GUIDE := $(shell find docs -type f) CHANGELOG.md THIRD_PARTY.md core/__init__.py app/rendering/palette.py packaging/guide.py \
	$(shell find app/cli resources/sizes -type f -not -name "*.pyc") core/measurements/definitions.py
uv = $(or $(wildcard .venv/bin/uv),$(shell command -v uv))

help:  ## list these targets
	@sed -n 's/^\([a-z-]*\):.*## /\1|/p' Makefile | while IFS='|' read -r name what; do printf '  make %-14s %s\n' "$$name" "$$what"; done

run: setup  ## open the program on the sample body; without a display, do the same session into out/
	@$(MAKE) --no-print-directory --silent site/index.html || echo "busk: the user guide could not be built; the program opens without it." >&2
	@if [ -n "$$DISPLAY$$WAYLAND_DISPLAY" ] || [ "$$(uname)" = Darwin ]; then .venv/bin/busk; \
	else .venv/bin/busk demo --out out; fi

test: setup-test lint types  ## style, types and all tests in two processes, each with a virtual display of its own
	@if command -v Xvfb >/dev/null; then \
		env -u WAYLAND_DISPLAY -u PYTHONDONTWRITEBYTECODE QT_QPA_PLATFORM=xcb LIBGL_ALWAYS_SOFTWARE=1 $(python) -m pytest -n 2 --dist loadfile; \
	else $(python) -m pytest; fi

setup:  ## prepare the system libraries and .venv, nothing else
	@sh packaging/setup.sh run

setup-test:
	@sh packaging/setup.sh test

lint: setup  ## style and import rules: ruff check, ruff format --check, lint-imports
	@$(python) -m ruff check .
	@$(python) -m ruff format --check .
	@.venv/bin/lint-imports --no-cache pyproject.toml

types: setup  ## types: mypy, strict in core
	@$(python) -m mypy

bench: setup  ## measure the speed of the turn and of the deformation
	@for file in benchmarks/bench_*.py; do echo "$$file"; $(python) "$$file" || exit 1; done

SECONDS := 300
fuzz: setup-test  ## damage scans, projects, names and bodies for a while: make fuzz SECONDS=900; failures go to fuzz.jsonl
	@$(python) benchmarks/fuzz.py --seconds $(SECONDS) --keep fuzz.jsonl

words: setup  ## bring the catalogues in resources/locale up to date with the texts of the code
	@$(python) benchmarks/catalogue.py

lock:  ## pin every dependency again (needs uv, which nothing else needs)
	@[ -n "$(uv)" ] || { echo "make lock needs uv: python3 -m pip install uv"; exit 1; }
	$(uv) pip compile --quiet --universal --fork-strategy fewest --python-version 3.11 --generate-hashes \
		--no-emit-index-url --custom-compile-command "make lock" --extra dev --extra fast --extra batch --output-file requirements.lock pyproject.toml

docs: setup  ## build the user guide into site/, without the network
	@$(python) packaging/guide.py

site/index.html: $(GUIDE)
	@$(python) packaging/guide.py

docs-pictures: setup-test  ## draw the pictures of the documentation again
	@$(python) packaging/docs_pictures.py

package: setup-package  ## build the program that is installed: Debian package, portable archive, bill, checksums in dist/
	@$(python) packaging/package.py

package-numbers: setup  ## hold every number of the frozen program to those of the source
	@$(python) packaging/compare_numbers.py

setup-package:
	@sh packaging/setup.sh package

package-test: setup  ## install what make package made in a minimal Debian (as root; else unpack it), use it, remove it
	@sh packaging/linux/try_install.sh

check-windows: setup  ## compile the installer for Windows on a stand-in (needs nsis, p7zip-full), try it in wine64 if there
	@$(python) packaging/windows/try_installer.py

clean:  ## remove caches, builds and out/ (the environment .venv stays)
	rm -rf out build dist site busk.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find . -name __pycache__ -not -path './.venv/*' -prune -exec rm -rf {} +
