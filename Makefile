# Opal. Two commands do everything on a machine with Python (3.13 or 3.11), a C++20 compiler and make:
#
# make render      draw the showcase of all three materials; prints the path of its PNG last
# make test        prove the rest; ARGS="tests/kernels -k fresnel" runs a part
#
# make zip         the extension in dist/, and .venv/ with bpy and the kernels importable
# make bench       the measurements of benchmarks/
# make lint        formatting, Python's and C++'s warnings
# make sanitize    the kernel tests under AddressSanitizer and UndefinedBehaviorSanitizer
# make dev         the C++ libraries alone, incrementally, into kernels/opal_kernels/lib/: run with PYTHONPATH=kernels
# make format      format every source
# make clean       remove what was built (not the environments); `make distclean` those too
#
# VENV=folder OPAL_PYTHON=/path/to/python take another environment (.ci/run proves Blender 4.5 that way in .venv-4.5).

.DEFAULT_GOAL := help
VENV ?= .venv
PYTHON := $(VENV)/bin/python
DEV_BUILD ?= build/dev
JOBS ?= $(shell nproc 2>/dev/null || echo 2)
ARGS ?=
export PATH := $(PATH):$(abspath $(VENV))/bin
export PIP_DISABLE_PIP_VERSION_CHECK := 1

# One build at a time in one folder, where flock is to be had.
LOCK := $(shell command -v flock >/dev/null && echo flock build/.lock)
SANITIZE_LOCK := $(subst .lock,sanitize.lock,$(LOCK))

.PHONY: help environment render test zip bench lint style warnings sanitized sanitize dev format clean distclean FORCE

help:
	@sed -n 's/^# \(make .*\)/\1/p' Makefile

environment:
	@mkdir -p build
	@$(LOCK) tools/environment.sh $(VENV)

# ---- The wheel, the zip, and the kernels inside the environment ----

# Lists of sources, rewritten only when a file comes or goes, so that a removed file counts as a change.
KERNEL_SOURCES := $(shell find kernels -type f -not -path '*/lib/*' -not -path '*/__pycache__/*' -not -path '*/build/*')
EXTENSION_SOURCES := $(shell find addon operators -type f -not -path '*/__pycache__/*') \
  __init__.py blender_manifest.toml LICENSE $(wildcard README.md) tools/build_extension.py

build/%.list: FORCE
	@mkdir -p build
	@new=$@.$$$$; echo $($*_SOURCES) | tr ' ' '\n' | sort >$$new; cmp -s $$new $@ && rm $$new || mv $$new $@

build/wheel.stamp: $(KERNEL_SOURCES) build/KERNEL.list | environment
	@echo "Building the kernels' wheel"
	@mkdir -p wheels
	@$(LOCK) sh -ec 'rm -f wheels/opal_kernels-*.whl; CMAKE_BUILD_PARALLEL_LEVEL=$(JOBS) $(PYTHON) -m pip wheel --quiet \
	  --no-build-isolation --no-deps --config-settings=build-dir=$(abspath build/wheel) --wheel-dir wheels ./kernels'
	@touch $@

build/zip.stamp: build/wheel.stamp $(EXTENSION_SOURCES) build/EXTENSION.list | environment
	@$(LOCK) $(PYTHON) tools/build_extension.py dist
	@touch $@

$(VENV)/.kernels: build/wheel.stamp | environment
	@$(LOCK) $(PYTHON) -m pip install --quiet --no-deps --force-reinstall wheels/opal_kernels-*.whl
	@touch $@

zip: build/zip.stamp $(VENV)/.kernels

# ---- What they are for ----

render: zip
	@$(PYTHON) tools/with_extension.py examples/opal.py $(ARGS)

test: zip
	@$(PYTHON) -m pytest $(or $(ARGS),tests)

bench: zip
	@$(PYTHON) benchmarks/render.py $(ARGS)

# ---- Care ----

CXX_FILES = $(shell git ls-files 'kernels/*.cpp' 'kernels/*.h')

lint: style warnings
	@echo "lint: clean"

style: | environment
	@$(PYTHON) -m ruff format --check --quiet . || { $(PYTHON) -m ruff format --diff --quiet .; exit 1; }
	@$(PYTHON) -m ruff check --quiet .
	@$(VENV)/bin/clang-format --dry-run -Werror $(CXX_FILES)

warnings: | environment
	@mkdir -p build
	@$(LOCK) sh -ec 'cmake -S kernels -B build/lint -G Ninja -DCMAKE_BUILD_TYPE=Release -DOPAL_LEVELS=v3 -DOPAL_WERROR=ON >build/lint.log \
	  || { cat build/lint.log; exit 1; }; ninja -C build/lint -j$(JOBS) --quiet'

format: | environment
	@$(PYTHON) -m ruff format --quiet .
	@$(PYTHON) -m ruff check --quiet --fix .
	@$(VENV)/bin/clang-format -i $(CXX_FILES)

# The sanitizers' runtime has to be in the process before Python's allocator: hence LD_PRELOAD.
SANITIZER_RUNTIMES = $(shell g++ -print-file-name=libasan.so):$(shell g++ -print-file-name=libubsan.so):$(shell g++ -print-file-name=libstdc++.so)
sanitized: | environment
	@mkdir -p build
	@$(SANITIZE_LOCK) sh -ec 'cmake -S kernels -B build/sanitize -G Ninja -DCMAKE_BUILD_TYPE=Debug -DOPAL_LEVELS=v2 -DOPAL_SANITIZE=ON >build/sanitize.log \
	  || { cat build/sanitize.log; exit 1; }; ninja -C build/sanitize -j$(JOBS) --quiet'

sanitize: zip sanitized
	@LD_PRELOAD=$(SANITIZER_RUNTIMES) OPAL_LIBRARY_DIR=$(abspath build/sanitize) \
	  ASAN_OPTIONS=detect_leaks=0:halt_on_error=1 UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 \
	  $(PYTHON) -m pytest $(or $(ARGS),tests/kernels)

dev:
	@command -v ninja >/dev/null && command -v cmake >/dev/null || $(MAKE) environment
	@mkdir -p $(DEV_BUILD) kernels/opal_kernels/lib
	@$(LOCK) sh -ec '\
	  [ -f $(DEV_BUILD)/build.ninja ] || cmake -S kernels -B $(DEV_BUILD) -G Ninja -DCMAKE_BUILD_TYPE=Release \
	    >$(DEV_BUILD)/configure.log || { cat $(DEV_BUILD)/configure.log; exit 1; }; \
	  ninja -C $(DEV_BUILD) -j$(JOBS); \
	  for library in $(DEV_BUILD)/libopal_*; do \
	    cmp -s $$library kernels/opal_kernels/lib/$${library##*/} || install -m 755 $$library kernels/opal_kernels/lib/; done'

clean:
	rm -rf build dist wheels kernels/opal_kernels/lib .pytest_cache .ruff_cache

distclean: clean
	rm -rf .venv .venv-4.5
