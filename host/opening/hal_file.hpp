// LinuxCNC: halsampler writes columns without names; the .hal file that loads it gives the names.
#pragma once

#include <string>

#include "host/import/log_file.hpp"

namespace host {

/// Names the columns of a halsampler log by the `net` lines of a .hal file, and states the thread's period. Throws
/// Failure(bad_input) where the file has no sampler with as many pins as the log has columns.
void name_by_hal(Log& log, const std::string& hal_path);

}  // namespace host
