BUILD ?= build
JOBS  ?= $(shell nproc)

.PHONY: all
all:
	cmake -S cmake -B $(BUILD) -G Ninja
	ninja -C $(BUILD) -j $(JOBS)
