# Short verbs for people. Each installs what it needs first (Debian packages, through apt).
.PHONY: demo test build package model bench experiments faults format dependencies help

build_dir := build/release

help:
	@echo "make demo    see it work: a table of objects, a short conversation, a task for the robot"
	@echo "make test    build and run every test"
	@echo "make build   release binaries in $(build_dir)/bin"
	@echo "make package  Debian packages in $(build_dir)/packages; docs/deployment says what to do with them"
	@echo "make model   the shipped model of categories, from its seed (five minutes)"
	@echo "make bench   milliseconds per stage, as a table and JSON"
	@echo "make experiments  how good questions, fits, segments and categories are, as docs/experiments (half an hour)"
	@echo "make faults  kills, partitions, loss, forgeries, floods: the real services in a lab of hosts (hours; FAULT_FLAGS)"
	@echo "make format  clang-format on every source file"

dependencies:
	@deploy/install-deps

$(build_dir)/build.ninja: | dependencies
	cmake --preset release

build: dependencies $(build_dir)/build.ninja
	cmake --build --preset release

demo: build
	$(build_dir)/bin/beckon demo --sessions 3 $(DEMO_FLAGS)

test: build
	ctest --preset release --parallel 2

package: build
	cd $(build_dir) && cpack

model: build
	tools/make-model

bench: build
	bench/run

# EXPERIMENT_FLAGS="--quick": a small run; "--only pose": one of the four reports; see tools/experiments/run --help
experiments: build
	deploy/install-deps python3-matplotlib python3-numpy python3-opencv python3-pil python3-scipy
	tools/experiments/run $(EXPERIMENT_FLAGS)

# FAULT_FLAGS="--quick", "--scale 0.01", "--only kills"; see tests/faults/run --help
faults: build
	tests/faults/run $(FAULT_FLAGS)

format: dependencies
	git ls-files '*.h' '*.cpp' | xargs clang-format -i
