// Skips diagnoses that take minutes each, unless AXIS_ALL_MACHINES is set (make test-machines).
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>

#define AXIS_SKIP_UNLESS_ALL_MACHINES() \
  if (std::getenv("AXIS_ALL_MACHINES") == nullptr) GTEST_SKIP() << "takes minutes: set AXIS_ALL_MACHINES"
