# The targets that people type; everything else is CMake's (cmake/CMakeLists.txt). `make help` lists them.
# Each target first installs the Debian packages that it lacks; the lists are in cmake/packages/.
BUILD   ?= build
CHECKED ?= $(BUILD)/checked
JOBS    ?= $(shell nproc)
NEED     = @cmake/packages/install.sh
SOURCES  = $(shell find firmware hal host sim tests -name '*.[ch]pp' 2>/dev/null)

# Configures the build tree $1 with the options $2. A new tree for programs compiles many sources together, which
# is faster. UNITY=OFF compiles each separately, for work on single files. Without UNITY an existing tree keeps its
# setting.
configure = cmake -S cmake -B $1 -G Ninja --log-level=WARNING -DAXIS_PACKAGES=$(abspath $(BUILD))/packages \
  $(if $(filter $(BUILD) $(CHECKED),$1),$(addprefix -DAXIS_UNITY=,$(or $(UNITY),$(if $(wildcard $1/CMakeCache.txt),,ON)))) $2

# Builds the microcontroller's images, then checks and reports their size, stack and symbols.
define firmware
$(call configure,$(BUILD)/firmware,-DCMAKE_TOOLCHAIN_FILE=$(CURDIR)/cmake/toolchains/arm-none-eabi.cmake)
ninja -C $(BUILD)/firmware -j $(JOBS)
ninja -C $(BUILD)/firmware image_report
endef

.DEFAULT_GOAL := all
.DELETE_ON_ERROR:

.PHONY: all
all: ## Build the program, build/bin/axistool, and nothing else
	$(NEED) build
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool

.PHONY: python
python: ## Build the Python package into build/python
	$(NEED) build python
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axis_python

PREFIX ?= /usr/local

.PHONY: install
install: ## Install program, Python package, manual, completions and udev rule below PREFIX (now /usr/local); DESTDIR stages it
	$(NEED) build python
	$(call configure,$(BUILD),-DCMAKE_INSTALL_PREFIX=$(PREFIX) -UAXIS_ZSH_DIR -UAXIS_PYTHON_DIR)
	ninja -C $(BUILD) -j $(JOBS) axistool axistool_documents axis_python
	cmake --install $(BUILD) --component axistool --prefix $(PREFIX) --strip
	cmake --install $(BUILD) --component python --prefix $(PREFIX) --strip

.PHONY: install-cpp
install-cpp: ## Install the library, its headers and its CMake package (find_package(axis)) below PREFIX
	$(NEED) build
	$(call configure,$(BUILD),-DCMAKE_INSTALL_PREFIX=$(PREFIX))
	ninja -C $(BUILD) -j $(JOBS) axis_host axis_computing
	cmake --install $(BUILD) --component development --prefix $(PREFIX)

.PHONY: deb
deb: ## Make the Debian packages axistool and python3-axistool (build/*.deb), and let lintian look at them
	$(NEED) build python package
	$(call configure,$(BUILD),-DAXIS_ZSH_DIR=share/zsh/vendor-completions -DAXIS_PYTHON_DIR=lib/python3/dist-packages)
	ninja -C $(BUILD) -j $(JOBS) axistool axistool_documents axis_python
	rm -f $(BUILD)/*axistool_*.deb
	cd $(BUILD) && cpack -G DEB --config CPackConfig.cmake
	lintian --fail-on error,warning $(BUILD)/*axistool_*.deb

.PHONY: deb-check
deb-check: deb ## Install the packages in a fresh Debian 12, use them, remove them (as root; downloads some 150 MB)
	$(NEED) package
	cmake/package/in_fresh_debian.sh $(BUILD)/*axistool_*.deb

.PHONY: wheel
wheel: ## Make a Python wheel that holds all libraries it needs (build/wheel), for pip on any Linux of this age
	$(NEED) build python wheel
	$(call configure,$(BUILD))
	rm -rf $(BUILD)/wheel
	AXIS_BUILD=$(abspath $(BUILD)) /usr/bin/python3 -m pip wheel --no-build-isolation --no-deps --no-index \
	  --wheel-dir $(BUILD)/wheel/plain ./host/python
	cmake/package/wheel.py $(BUILD)/wheel/plain/*.whl $(BUILD)/wheel

.PHONY: wheel-check
wheel-check: wheel ## Install the wheel in a fresh Debian 12 without a compiler, and use it (as root; downloads some 80 MB)
	cmake/package/wheel_check.sh $(BUILD)/wheel/*.whl

.PHONY: demo
demo: ## Identify a real record, control both axes in simulation, show the result (EMPS=DIR adds the public benchmark)
	$(NEED) build
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool
	$(BUILD)/bin/axistool demo --output $(BUILD)/demo $(if $(EMPS),--emps $(EMPS))

.PHONY: test
test: ## Build and run all tests, those of what reads files or a bus with sanitizers too, and a short fuzz run
	$(NEED) build python test firmware
	$(NEED) guest || echo "packages: without these the tests in an emulated PC will skip" >&2
	$(call firmware)
	$(call configure,$(BUILD),-DAXIS_CHECKED_BUILD=$(abspath $(CHECKED)))
	ninja -C $(BUILD) -j $(JOBS)
	CC=clang-14 CXX=clang++-14 $(call configure,$(CHECKED),-DAXIS_SANITIZE=ON -DAXIS_FUZZ=ON -DCMAKE_BUILD_TYPE=Debug -DAXIS_PLAIN_BUILD=$(abspath $(BUILD)))
	ninja -C $(CHECKED) -j $(JOBS)
	ctest --test-dir $(BUILD) --no-tests=error --output-on-failure --parallel $(JOBS)

.PHONY: test-sanitized
test-sanitized: ## Every unit test with sanitizers, of what only computes too (half an hour)
	$(NEED) build test
	CC=clang-14 CXX=clang++-14 $(call configure,$(CHECKED),-DAXIS_SANITIZE=ON -DAXIS_FUZZ=ON -DCMAKE_BUILD_TYPE=Debug -DAXIS_PLAIN_BUILD=)
	ninja -C $(CHECKED) -j $(JOBS)
	ctest --test-dir $(CHECKED) --no-tests=error --output-on-failure --parallel $(JOBS) --tests-regex '^(host|firmware|sim)[a-z_/]*/[A-Z]'

.PHONY: test-usb
test-usb: firmware ## Boards on Linux' own USB and GPIO stack, in an emulated PC (part of `make test`)
	$(NEED) build test guest
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS)
	ctest --test-dir $(BUILD) --output-on-failure --parallel $(JOBS) --tests-regex '^guest/'

.PHONY: test-linuxcnc
test-linuxcnc: ## LinuxCNC drives machines with a hidden effect, before and after the exported component (installs LinuxCNC)
	$(NEED) build test linuxcnc
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool
	ctest --test-dir $(BUILD) --no-tests=error --verbose --tests-regex '^linuxcnc$$'

.PHONY: test-mujoco
test-mujoco: ## MuJoCo replays exported models (installs npm, which fetches MuJoCo)
	$(NEED) build test mujoco
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool
	ctest --test-dir $(BUILD) --no-tests=error --verbose --tests-regex '^mujoco$$'

.PHONY: firmware
firmware: ## Build the board's images (.elf, .bin, .hex in build/firmware/images), with size and stack report
	$(NEED) firmware
	$(call firmware)

SCALAR ?= float
IMAGE_FILE = $(BUILD)/firmware/images/axis-f405$(if $(filter fixed,$(SCALAR)),-fixed).bin

.PHONY: flash
flash: all firmware ## Write the image onto the board by ST-Link (PROBE=serial chooses one, SCALAR=fixed, DRY=1)
	$(NEED) flash
	$(BUILD)/bin/axistool flash $(IMAGE_FILE) --stlink $(if $(PROBE),--probe $(PROBE)) $(if $(DRY),--dry-run)

.PHONY: flash-dfu
flash-dfu: all firmware ## Write the image onto a board that is in its USB bootloader (SCALAR=fixed, DRY=1)
	$(NEED) flash
	$(BUILD)/bin/axistool flash $(IMAGE_FILE) $(if $(DRY),--dry-run)

.PHONY: pil
pil: firmware ## Processor in the loop: the image under QEMU against the host build, bit for bit (IMAGE=name for one)
	$(NEED) build test
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axis_pil
	$(BUILD)/bin/axis_pil $(IMAGE)

.PHONY: sim
sim: ## Run a simulated board for `axistool --device sim` (OPTIONS, for example OPTIONS='--x my-model.toml')
	$(NEED) build
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool
	$(BUILD)/bin/axistool sim $(OPTIONS)

.PHONY: hil
hil: ## Run the scenarios: the firmware around simulated drives (SCENARIO=files; records and reports in build/hil)
	$(NEED) build
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool
	$(BUILD)/bin/axistool hil $(or $(SCENARIO),host/hil/scenarios/*.toml) -o $(BUILD)/hil

.PHONY: soak
soak: ## A day of motion with sparks, jitter and drift, 10000 random paths, 50 commissionings killed, 20000 trials of faults and of pairs, and all pairs at every moment of enabling and disabling (HOURS=24, TRIALS=n)
	$(NEED) build test
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) test_firmware_app test_host_hil test_host_path test_host_commission
	AXIS_COMMISSION_TRIALS=50 $(BUILD)/bin/test_host_commission --gtest_filter='*AnyMoment*'
	AXIS_SOAK_HOURS=$(or $(HOURS),24) $(BUILD)/bin/test_firmware_app --gtest_filter='Soak.*'
	AXIS_EXCITATION_TRIALS=5000 $(BUILD)/bin/test_firmware_app --gtest_filter='ExcitedBoard.*'
	AXIS_FAULT_TRIALS=$(or $(TRIALS),20000) AXIS_FAULT_MOMENTS=1000000 $(BUILD)/bin/test_host_hil --gtest_filter='AnyFault.*:AnyTwoFaults.*'
	AXIS_PATH_PROGRAMS=10000 $(BUILD)/bin/test_host_path --gtest_filter='*RandomPrograms*:*ThePathClock*'

.PHONY: response
response: ## How often measured frequency responses lie within their own bands, over 200 seeds (SEEDS=n)
	$(NEED) build test
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) test_host_response
	AXIS_COVERAGE_SEEDS=$(or $(SEEDS),200) $(BUILD)/bin/test_host_response --gtest_filter='TwoMasses.*'

.PHONY: pages
pages: ## Write the pages of parameters, faults and data sheets anew; tests compare them
	$(NEED) build
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool
	$(BUILD)/bin/axistool parameters --markdown > firmware/app/parameters/README.md
	$(BUILD)/bin/axistool hil --fault-page > firmware/core/supervision/README.md
	$(BUILD)/bin/axistool sheet --markdown > host/model/README.md

.PHONY: hidden-effect
hidden-effect: ## Worked example: a circle spoilt by an effect that the model lacks; find it, compensate it, run again
	$(NEED) build
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool
	host/hil/hidden_effect.sh $(BUILD)/bin/axistool $(BUILD)/hidden-effect

.PHONY: cost
cost: firmware ## Executed instructions of one control step, by number type and processor
	$(NEED) build test
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axis_cost
	$(BUILD)/bin/axis_cost

.PHONY: bench
bench: ## Measure speed: plant and predictor against real time, identification, diagnosis (FILTER=regex)
	$(NEED) build test bench
	$(call configure,$(BUILD),-DAXIS_BENCH=ON)
	ninja -C $(BUILD) -j $(JOBS) axis_bench
	$(BUILD)/bin/axis_bench $(if $(FILTER),--benchmark_filter='$(FILTER)')

.PHONY: scoreboard
scoreboard: ## How often diagnose is right on cases whose truth is known (CASES=DIR, CUTS=1, NULLS=1000, REWRITTEN=1, SAMPLE=20; REAL=DIR: measured machines)
	$(NEED) build
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool
	$(BUILD)/bin/axistool scoreboard $(if $(REAL),--real $(REAL),$(or $(CASES),tests/data/drive-cases)) $(if $(CUTS),--cuts) \
	  $(if $(REWRITTEN),--rewritten) $(if $(NULLS),--nulls $(NULLS)) $(if $(SAMPLE),--sample $(SAMPLE))

.PHONY: made-machines
made-machines: ## The scoreboard on drives of a plant that shares nothing with the simulator (EFFECTS=2 hidden in each, COUNT=28, SEED=1)
	$(NEED) build test
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool made_machines
	rm -rf $(BUILD)/made
	$(BUILD)/bin/made_machines $(or $(SEED),1) $(or $(COUNT),28) $(or $(EFFECTS),2) $(BUILD)/made
	$(BUILD)/bin/axistool scoreboard $(BUILD)/made

.PHONY: test-machines
test-machines: ## Machines of independent plants that make test leaves out, because each takes minutes (after a change to diagnose)
	$(NEED) build test
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool made_machines test_host_diagnose
	AXIS_ALL_MACHINES=1 ctest --test-dir $(BUILD) --no-tests=error --verbose \
	  --tests-regex '^host/(effects_of_both_kinds|blind_tables|workbench/page_cases|diagnose/(RealCogging|SearchBySteps)[.].*)$$'

.PHONY: plan-bench
plan-bench: ## Plan, run and decide on machines made by independent code, pair by pair (CASES=DIR: the public cases)
	$(NEED) build test
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axis_plan_bench
	$(BUILD)/bin/axis_plan_bench $(or $(CASES),tests/data/drive-cases)

.PHONY: page-bench
page-bench: ## Cases (CASES="folder ...") through the workbench's page and the command: same verdicts, one sheet of winning panels
	$(NEED) build test
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool
	AXISTOOL=$(abspath $(BUILD))/bin/axistool AXIS_SCREENSHOTS=$(abspath $(BUILD))/page-bench tests/host/workbench/page_cases_test.py $(or $(CASES),$(wildcard tests/data/drive-cases/single/*))

.PHONY: commission-bench
commission-bench: ## axistool commission on twenty machines whose hidden effects it is not told (ONLY="01-cogging …"), and two of them on a circle
	$(NEED) build test
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool
	python3 tests/commission/bench.py $(BUILD)/bin/axistool tests/commission/machines.json $(if $(ONLY),--only $(ONLY))
	$(if $(ONLY),,python3 tests/commission/contour.py $(BUILD)/bin/axistool tests/commission/machines.json)

.PHONY: commission-usb
commission-usb: ## axistool commission over Linux' own USB stack, in an emulated PC: minutes of computing
	$(NEED) build test
	$(NEED) guest
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axistool guest_commission
	GUEST_LIMIT=7200 GUEST_FILES=$(abspath $(BUILD))/bin/axistool:$(abspath tests/guest/commission/belt.toml) \
	  tests/guest/run.sh $(abspath $(BUILD))/packages/guest $(BUILD)/bin/guest_commission

.PHONY: mutants
mutants: ## Seed every mistake of tests/hal/mutants.txt into the drivers: each must make its test fail (a few minutes)
	$(NEED) build test
	$(call configure,$(BUILD))
	ninja -C $(BUILD) -j $(JOBS) axis_parts axis_sim
	tests/hal/mutants.sh . "$(BUILD)/tests/libaxis_parts.a $(BUILD)/sim/libaxis_sim.a" c++ all

.PHONY: format
format: ## Format all sources in place
	$(NEED) format
	@clang-format-14 -i $(SOURCES)

.PHONY: lint
lint: ## Static analysis, include rules, formatting, file length; no finding is allowed
	$(NEED) build python test lint
	cmake/checks/file_length.sh .
	cmake/checks/include_rules.sh .
	cmake/checks/local_names.py .
	cmake/checks/page_types.sh .
	@clang-format-14 --dry-run -Werror $(SOURCES)
	$(call configure,$(BUILD)/lint)
	ninja -C $(BUILD)/lint build_version
	cmake/checks/cppcheck.sh . $(JOBS)
	cmake/checks/clang_tidy.sh $(BUILD)/lint $(JOBS)

.PHONY: clean
clean: ## Remove everything that was built
	rm -rf $(BUILD)

.PHONY: help
help: ## This list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-12s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)
	@echo "Variables: BUILD (folder, now $(BUILD)), JOBS (parallel jobs, now $(JOBS))"
