# Each target runs in .venv, which tools/bootstrap.py makes on the first use.
PYTHON ?= python3
RUN = $(PYTHON) tools/bootstrap.py
# a recorded flight for the second part of the demo; without one it is the closed-form cruise
RECORDING ?= $(firstword $(wildcard ../shared/data/flights/cruise*.csv.gz))

.PHONY: help setup demo test test-slow test-kilted docs words figures bench bits fuzz soak lint lock clean

help:
	@echo 'make setup      make .venv and install the package with what it needs'
	@echo 'make demo       run the three nodes and show predicted against measured errors'
	@echo 'make test       run the tests'
	@echo 'make test-slow  run the slow tests'
	@echo 'make test-kilted  run the live tests on the wheels of ROS 2 Kilted'
	@echo 'make figures    compute the long studies and render docs/explanation/validation.md'
	@echo 'make docs       build the site into build/docs; warnings are errors'
	@echo 'make words      check spelling and wording of docs and docstrings'
	@echo 'make bench      run the benchmarks; AGAINST=CHECKOUT compares with another checkout'
	@echo 'make bits       compare the bits of runs between processors and versions of NumPy'
	@echo 'make fuzz       try 50000 hostile files and two million hostile messages; takes hours'
	@echo 'make soak       run the live chain and the recorder at 1 kHz for an hour'
	@echo 'make lint       check the style and the types'
	@echo 'make lock       write requirements.lock again (UPGRADE=--upgrade: newest versions)'
	@echo 'make clean      remove .venv, builds and caches'

setup:
	$(RUN)

demo:
	$(RUN) ins_sim demo $(if $(RECORDING),--recording $(RECORDING))

test:
	$(RUN) python tools/run_tests.py fast

test-slow:
	$(RUN) python tools/run_tests.py slow

# The newest wheels, in an environment beside; docs/how_to/distributions.md.
KILTED = build/kilted/bin/python
SMOKE = $(addprefix test/ros/, test_graph.py test_repairs.py test_services.py test_bag.py one_process \
	stack adapter recording/test_recorder.py recording/test_player.py aiding/test_aided.py)
test-kilted: $(KILTED)
	$(KILTED) -m pytest -q -m 'live and not slow' $(SMOKE)

$(KILTED):
	$(PYTHON) -m venv build/kilted
	$(KILTED) -m pip install --quiet 'ros-kilted-rclpy[fastrtps]' ros-kilted-common-interfaces \
		--editable '.[test]'

docs:
	$(RUN) python -m sphinx -W --keep-going -q -b html docs build/docs
	@echo 'open build/docs/index.html'

words:
	$(RUN) python tools/check_words.py

figures:
	$(RUN) python tools/run_tests.py figures
	$(RUN) python tools/render_validation.py --take build/figures.json

bench:
	$(RUN) python benchmarks/run.py $(if $(AGAINST),--against $(AGAINST))

bits:
	$(RUN) python tools/bits.py

fuzz:
	$(RUN) python tools/fuzz_files.py
	$(RUN) python tools/fuzz_nodes.py

soak:
	$(RUN) python tools/soak.py

lint:
	$(RUN) python -m flake8
	$(RUN) python -m mypy

# Needs uv.  The file holds versions, markers and hashes for every supported Python, and no index.
lock:
	uv pip compile --universal --python-version 3.10 --generate-hashes --no-emit-index-url \
		--no-header --no-annotate --quiet $(UPGRADE) --extra ros --extra test \
		--output-file requirements.lock setup.py

clean:
	rm -rf docs/reference/generated .venv .venv.lock build dist install log *.egg-info .pytest_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
