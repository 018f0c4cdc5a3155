// Reads a log by a third-party library without trusting that library.
#pragma once

#include <string>
#include <string_view>

#include "host/import/log_file.hpp"

namespace host {

/// Runs `read` on the file at `path` in a separate process, which can neither write files nor use more than a gigabyte
/// nor run for long, and returns its result. `library`: its name in messages; load it before. Throws Failure
/// (bad_input): that of `read`, or the way in which the process ended.
///
/// Why a fork and no program of its own: the Python module and installed copies of the library have no such program
/// beside them. Why it is safe although callers have several threads: the C library makes its heap, its streams and its
/// loader usable in the child, `read` uses nothing else that a thread of the caller may have locked, and the libraries
/// are used in children only, so that their own states are as they were loaded. One exception remains: a program that
/// uses the same libsqlite3 in another thread at that instant. Its child would wait for ever; the time limit ends it.
/// A filter of system calls alone (seccomp) would not survive a crash of the library, and an interpreter of each format
/// of our own would be ten times this code.
Log read_confined(const std::string& path, std::string_view library, Log (*read)(const std::string& path));

}  // namespace host
