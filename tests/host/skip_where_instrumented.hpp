// Skips diagnoses in sanitized builds: they fit some hundred models, which takes many times as long there.
#pragma once

#include <gtest/gtest.h>

#if defined(__SANITIZE_ADDRESS__)
#define AXIS_INSTRUMENTED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define AXIS_INSTRUMENTED 1
#endif
#endif

/// Whether this is compiled with sanitizers: tests that repeat one thing repeat it less often then.
#ifdef AXIS_INSTRUMENTED
inline constexpr bool kInstrumented = true;
#else
inline constexpr bool kInstrumented = false;
#endif

#ifdef AXIS_INSTRUMENTED
#define AXIS_SKIP_WHERE_INSTRUMENTED() GTEST_SKIP() << "takes too long with sanitizers"
#else
#define AXIS_SKIP_WHERE_INSTRUMENTED() static_cast<void>(0)
#endif
