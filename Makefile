# Kaustik from an empty Debian 12 machine: `make render` and `make test` need a C++ compiler and
# make, and install the rest. Without this file: cmake --preset release && cmake --build --preset release.

BUILD = build/release
PREFIX ?= /usr/local
program = $(BUILD)/kaustik
scene = scenes/cornell_box/cornell_box.xml
sources = $(shell git ls-files -co --exclude-standard '*.h' '*.cpp')

.PHONY: all setup configure build render test thesis bench install package docs format clean
all: build

# What is missing comes from Debian's packages (root or sudo); nothing is fetched when all is there.
setup:
	@scripts/install_packages.sh build

configure: setup
	@cmake --preset release

build: configure
	@cmake --build --preset release

# Only the program, to see a picture sooner.
render: configure
	@cmake --build --preset release --target kaustik
	@mkdir -p out
	$(program) render $(scene) -o out/cornell_box.exr -o out/cornell_box.tif -o out/cornell_box.png --tonemap linear --exposure 1

test: build
	ctest --preset release

# The thesis's experiments, into docs/thesis: hours; EXPERIMENTS="figure cone" makes only those, anew.
thesis: build
	$(BUILD)/benchmarks/thesis/thesis $(EXPERIMENTS)

bench: build
	@scripts/install_packages.sh bench
	@scripts/run_benchmarks.sh $(BUILD)

install: configure
	@cmake --build --preset release --target kaustik
	cmake --install $(BUILD) --prefix $(PREFIX)

package: configure
	@scripts/install_packages.sh package
	@cmake --build --preset release --target kaustik
	cd $(BUILD) && cpack

# docs/parameters.md, from the tables in the program.
docs: configure
	@cmake --build --preset release --target kaustik
	scripts/make_parameters_page.sh $(program) >docs/parameters.md

format:
	@scripts/install_packages.sh check
	clang-format -i $(sources)

clean:
	rm -rf build out
