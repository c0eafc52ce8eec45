# Kaustik from an empty Debian 12 machine: `make render` and `make test` need a C++ compiler and
# make, and install the rest. Without this file: cmake --preset release && cmake --build --preset release.

BUILD = build/release
PREFIX ?= /usr/local
program = $(BUILD)/kaustik
scene = scenes/cornell_box/cornell_box.xml
comparisons = $(BUILD)/benchmarks/comparisons
RESULTS ?= out/bench_scenes.jsonl
PEER_RESULTS ?= out/bench_peers.jsonl
bench_scenes_options = $(if $(SCENES),--scenes $(SCENES)) $(if $(INTEGRATORS),--integrators $(INTEGRATORS)) \
  $(if $(SECONDS),--seconds $(SECONDS)) $(if $(SEEDS),--seeds $(SEEDS)) $(if $(REFERENCES),--references $(REFERENCES))
comma = ,
sources = $(shell git ls-files -co --exclude-standard '*.h' '*.cpp')

.PHONY: all setup configure build render test test-long test-cluster coverage thesis bench bench-cluster bench-spectral bench-scenes bench-peers ablation sensitivity comparisons references gallery python wheel notebooks view-test install package package-test docs format clean
all: build

# What is missing comes from Debian's packages (root or sudo); nothing is fetched when all is there.
setup:
	@scripts/install_packages.sh build

# A new folder compiles several sources as one. Who edits sources
# waits less without: cmake --preset release, before the first make.
configure: setup
	@cmake --preset release $(if $(wildcard $(BUILD)/CMakeCache.txt),,-D KAUSTIK_UNITY=ON -D KAUSTIK_PRECOMPILED_HEADERS=ON)

build: configure
	@cmake --build --preset release

# Only the program, to see a picture sooner.
render: configure
	@cmake --build --preset release --target kaustik
	@mkdir -p out
	$(program) render $(scene) -o out/cornell_box.exr -o out/cornell_box.tif -o out/cornell_box.png --tonemap linear --exposure 1

test: build
	ctest --preset release

# Statistics at length, beside the quick tests of the same: before a release, and when an estimator changes.
test-long: build
	ctest --preset thorough
	ctest --preset long

# The page of `kaustik view` in Chromium: on a server of its own, and on the program. Builds both.
view-test: configure
	@scripts/install_packages.sh view
	cd apps/view && npm ci --no-audit --no-fund && npm run build
	@cmake --build --preset release --target kaustik
	cd apps/view && KAUSTIK=$(abspath $(program)) npm test

# Which share of the lines the tests run, of each room and in all.
coverage: setup
	@scripts/install_packages.sh check coverage
	@scripts/coverage.sh

# The thesis's experiments, into docs/thesis: hours; EXPERIMENTS="figure cone" makes only those, anew.
thesis: configure
	@cmake --build --preset release --target kaustik thesis
	$(BUILD)/benchmarks/thesis/thesis $(EXPERIMENTS)

bench: configure
	@cmake --build --preset release --target kaustik benchmarks
	@scripts/install_packages.sh bench
	@scripts/run_benchmarks.sh $(BUILD)

# Spectral mode: colours, cost beside RGB mode, auto beside path. Some minutes.
bench-spectral: configure
	@cmake --build --preset release --target kaustik
	scripts/bench_spectral.py --program $(program)

# Every method on every scene over time, hours; what is in out/bench_scenes.jsonl is not run again.
# Lists have commas: make bench-scenes SCENES=metal_ring,peer_ring INTEGRATORS=path,vcm SECONDS=5,10 SEEDS=1,2
bench-scenes: configure
	@cmake --build --preset release --target bench_scenes comparisons_page
	$(comparisons)/bench_scenes --results $(RESULTS) $(bench_scenes_options)
	$(comparisons)/comparisons_page $(RESULTS) --peers $(PEER_RESULTS)

# What many machines are worth: processes of MPI, merging, adding up films, and a model of up to 10 000 nodes. Ten minutes;
# needs MPI, and root for its test network.
CLUSTER_MEASURED ?= out/cluster.json
bench-cluster: setup
	@scripts/install_packages.sh mpi
	@cmake --preset release $(if $(wildcard $(BUILD)/CMakeCache.txt),,-D KAUSTIK_UNITY=ON -D KAUSTIK_PRECOMPILED_HEADERS=ON) -D KAUSTIK_MPI=ON
	@cmake --build --preset release --target kaustik kaustik-mpi merge_bench adding_bench cluster_model large_map_bench
	@mkdir -p out
	benchmarks/cluster/cluster_bench.py $(program) $(program)-mpi $(BUILD)/benchmarks/merge_bench \
	  $(BUILD)/benchmarks/cluster/adding_bench $(CLUSTER_MEASURED) $(CLUSTER_OPTIONS)
	$(BUILD)/benchmarks/cluster/cluster_model $(CLUSTER_MEASURED)
	$(BUILD)/benchmarks/large_map_bench

# Parts, processes of MPI and engines, with death and slow networks: docs/cluster.md. What needs something that is not
# here is skipped, and says why.
test-cluster: configure
	@scripts/install_packages.sh mpi
	@cmake --preset release -D KAUSTIK_MPI=ON
	@cmake --build --preset release
	ctest --test-dir $(BUILD) --output-on-failure --label-regex cluster

# What each device of auto is worth, into docs/ablation.md: the time for a given noise without it. A quarter of an hour.
ablation: configure
	@cmake --build --preset release --target kaustik
	scripts/worth.py devices $(if $(SEEDS),--seeds $(SEEDS)) --page docs/ablation.md

# What the constants of the methods are worth, into docs/sensitivity.md: an hour.
sensitivity: setup
	scripts/worth.py constants $(if $(SEEDS),--seeds $(SEEDS)) --page docs/sensitivity.md

# A picture of every material, light, camera, texture, volume, shape, into docs/gallery.md: ten minutes.
gallery: build
	scripts/make_gallery.py --program $(program)

# Beside Blender Cycles and POV-Ray at equal time; fails unless every bar is kept:
# make bench-peers TIME=60 SCENES=metal_ring INTEGRATOR=vcm
bench-peers: configure
	@scripts/install_packages.sh bench
	@cmake --build --preset release --target bench_peers
	$(BUILD)/benchmarks/peers/bench_peers $(if $(SCENES),--scenes $(SCENES)) $(if $(INTEGRATOR),--integrator $(INTEGRATOR)) \
	  $(if $(TIME),--seconds $(TIME)) $(if $(REFERENCES),--references $(REFERENCES)) --results $(PEER_RESULTS)

# docs/comparisons.md, of what bench-scenes and bench-peers have measured, which goes with it.
comparisons: configure
	@cmake --build --preset release --target comparisons_page
	$(comparisons)/comparisons_page $(RESULTS) --peers $(PEER_RESULTS) --docs docs
	cmp -s $(RESULTS) docs/comparisons/measurements.jsonl || cp $(RESULTS) docs/comparisons/measurements.jsonl
	test ! -e $(PEER_RESULTS) || cmp -s $(PEER_RESULTS) docs/comparisons/peers.jsonl || cp $(PEER_RESULTS) docs/comparisons/peers.jsonl

# References that the scenes are compared with, hours; SCENES="atrium museum" makes those, anew.
references: configure
	@cmake --build --preset release --target kaustik add_images_tool bench_peers
	benchmarks/make_references.sh $(subst $(comma), ,$(SCENES))

# `import kaustik` in .venv, its tests, and a picture by it: docs/guides/python.md. PYTHON=… for another one than Debian's.
PYTHON ?= /usr/bin/python3
python: setup
	@scripts/install_packages.sh python
	@test -e .venv/bin/python || $(PYTHON) -m venv --system-site-packages .venv
	.venv/bin/pip install --quiet --disable-pip-version-check --no-deps .
	@cmake --build $(BUILD) --target kaustik kaustik_package
	KAUSTIK_PROGRAM=$(program) .venv/bin/python -m pytest -q -p no:cacheprovider python/tests
	@mkdir -p out
	.venv/bin/python python/examples/first_caustic.py out/first_caustic.png

# A wheel in out/ with the libraries inside, for other distributions; tried here, and by scripts/try_wheel.sh where
# there is nothing but Python.
wheel: setup
	@scripts/install_packages.sh python wheel
	@rm -rf out/wheel && mkdir -p out/wheel
	$(PYTHON) python/portable_wheel.py out/wheel
	$(PYTHON) -m zipfile -e out/wheel/kaustik-*.whl out/wheel/tried
	PYTHONPATH=out/wheel/tried PYTHONDONTWRITEBYTECODE=1 $(PYTHON) python/tests/wheel_trial.py

# Runs docs/notebooks and writes them with what they show; NOTEBOOKS="docs/notebooks/first_caustic.ipynb" only one.
NOTEBOOKS ?= $(wildcard docs/notebooks/*.ipynb)
notebooks: configure
	@scripts/install_packages.sh python notebooks
	@cmake --preset release -D KAUSTIK_PYTHON=ON
	@cmake --build --preset release --target kaustik_package
	PYTHONPATH=$(CURDIR)/$(BUILD)/python $(PYTHON) scripts/make_notebooks.py $(NOTEBOOKS)

install: configure
	@cmake --build --preset release --target kaustik
	cmake --install $(BUILD) --prefix $(PREFIX) --component program

# In build/release, Debian packages (kaustik, libkaustik0, libkaustik-dev, python3-kaustik) and kaustik-….tar.xz, which runs
# where it is unpacked: docs/developer/packages.md.
package: configure
	@scripts/install_packages.sh package python
	@cmake --preset release -D KAUSTIK_PYTHON=ON
	@cmake --build --preset release --target kaustik libkaustik kaustik_package
	cd $(BUILD) && cpack
	scripts/try_python_package.sh $(BUILD)/python3-kaustik_*.deb
	scripts/portable_tarball.py $(BUILD) $(BUILD)

# The same in a bare Debian 12 and a bare Debian 13. Needs root and the network.
package-test: package
	@scripts/install_packages.sh package-test
	scripts/try_packages.sh $(BUILD)

# The generated parts of docs/reference, from the tables in the program; then the documentation as a site, build/site:
# python3 -m http.server --bind 127.0.0.1 --directory build/site 8000
docs: configure
	@cmake --build --preset release --target kaustik
	scripts/reference_pages.py $(program)
	scripts/check_docs.py
	@scripts/install_packages.sh docs
	scripts/build_site.sh

format:
	@scripts/install_packages.sh check
	clang-format -i $(sources)

clean:
	rm -rf build out
