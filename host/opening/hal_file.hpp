// LinuxCNC: halsampler writes columns without names; the .hal file that loads it contains the names.
#pragma once

#include <string>

#include "host/import/log_file.hpp"

namespace host {

/// Names the columns of a halsampler log by the `net` lines of a .hal file, and adds the period of the thread. Throws
/// Failure(bad_input) if the file has no sampler with as many pins as the log has columns.
void name_by_hal(Log& log, const std::string& hal_path);

}  // namespace host
