// Reads a log by a third-party library without trusting that library.
#pragma once

#include <string>
#include <string_view>

#include "host/import/log_file.hpp"

namespace host {

/// Runs `read` on the file at `path` in a separate process and returns its result. The process cannot write files, use
/// more than a gigabyte of memory, or run for long. `library`: its name in messages; must be loaded before. Throws
/// Failure(bad_input): that of `read`, or a description of how the process ended.
///
/// It is a fork and not a separate program, because the Python module and installed copies of the library have no such
/// program beside them. The fork is safe although callers have several threads: the C library makes its heap, its
/// streams and its loader usable in the child, `read` uses nothing else that a thread of the caller may have locked,
/// and the third-party libraries are used in children only, so that they are in the state in which they were loaded.
/// There is one exception: a program that uses the same libsqlite3 in another thread at that moment. Its child would
/// wait forever; the time limit ends it. A filter of system calls alone (seccomp) would not survive a crash of the
/// library, and own interpreters of all formats would need ten times this code.
Log read_confined(const std::string& path, std::string_view library, Log (*read)(const std::string& path));

}  // namespace host
