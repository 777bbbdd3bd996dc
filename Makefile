# make demo         install what is missing, then settle a bed and press an elastic tube into it
# make test         run the tests, in two processes
# make test-debian13  run them on Debian 13, in a chroot (as root)
# make bench        measure the speed
# make bench-peers  measure it against other codes
# make validate     compare with the sources' results (long)
# make clean        remove caches; results in runs/ stay
# Arguments go through ARGS, e.g. make test ARGS="-k scene" or ARGS="-n 4" (-n 0: in one), make demo ARGS=--overwrite.

PYTHON := .venv/bin/python

# Open MPI refuses root and more ranks than cores unless it is told that this is meant.
export OMPI_ALLOW_RUN_AS_ROOT := 1
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM := 1
export OMPI_MCA_rmaps_base_oversubscribe := 1

.PHONY: install install-test demo test test-debian13 bench bench-peers validate clean

install:
	@.ci/install

install-test:
	@.ci/install test

# A second call goes on where the first one stopped, or shows what it came to.
demo: install
	@.venv/bin/leito run scenes/elastic_tube.toml $(or $(ARGS),$(if $(wildcard runs/elastic_tube/scene.toml),--resume))

test: install-test
	@$(PYTHON) -m pytest -n 2 --dist loadfile $(ARGS)

# ARGS reaches the script through the environment.
test-debian13:
	@.ci/debian13

bench: install
	@$(PYTHON) benchmarks/run.py $(ARGS)

bench-peers: install
	@$(PYTHON) benchmarks/peers.py $(ARGS)

validate: install-test
	@$(PYTHON) -m pytest -m validate $(ARGS)

clean:
	@find . -name __pycache__ -not -path './.venv/*' -prune -exec rm -rf {} +
	@rm -rf .pytest_cache .hypothesis .import_linter_cache build leito.egg-info
