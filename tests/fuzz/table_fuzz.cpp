// Any bytes as a table to import, with and without resampling: a record that can be read again, or a refusal.
#include <cstdint>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/import/import_record.hpp"
#include "host/record/read_record.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const host::Log log = host::parse_table({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
    for (const std::optional<double> period_s : {std::optional<double>(), std::optional(0.001)}) {
      host::ImportOptions options;
      options.resample_period_s = period_s;
      if (log.columns[0].name.empty()) options.mappings = host::parse_mappings("t_s=1,u_V=2,x_mm=3*0.5");
      try {
        host::format_record(host::import_record(log, options));
      } catch (const host::Failure&) {
      }
    }
  } catch (const host::Failure&) {
  }
  return 0;
}
