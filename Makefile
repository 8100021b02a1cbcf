# Opal. `make render` draws the showcase, `make test` proves the rest; both start from a fresh clone.
#
# make dev         the C++ libraries, incrementally, into kernels/opal_kernels/lib/: run with PYTHONPATH=kernels

.DEFAULT_GOAL := help
DEV_BUILD ?= build/dev
JOBS ?= 2
CMAKE := $(or $(shell command -v cmake),.venv/bin/cmake)
NINJA := $(or $(shell command -v ninja),.venv/bin/ninja)

.PHONY: help dev

help:
	@sed -n 's/^# \(make .*\)/\1/p' Makefile

# One build at a time in one folder: ninja itself does not lock. `install` replaces a library that a running process has mapped.
LOCK = $(shell command -v flock >/dev/null && echo flock $(DEV_BUILD)/.lock)
dev: | $(CMAKE) $(NINJA)
	@mkdir -p $(DEV_BUILD) kernels/opal_kernels/lib
	@$(LOCK) sh -ec '\
	  [ -f $(DEV_BUILD)/build.ninja ] || $(CMAKE) -S kernels -B $(DEV_BUILD) -G Ninja -DCMAKE_MAKE_PROGRAM=$(NINJA) \
	    -DCMAKE_BUILD_TYPE=Release >$(DEV_BUILD)/configure.log || { cat $(DEV_BUILD)/configure.log; exit 1; }; \
	  $(NINJA) -C $(DEV_BUILD) -j$(JOBS); \
	  for library in $(DEV_BUILD)/libopal_*; do \
	    cmp -s $$library kernels/opal_kernels/lib/$${library##*/} || install -m 755 $$library kernels/opal_kernels/lib/; done'
