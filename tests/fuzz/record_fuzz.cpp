// Any bytes as a record: read or refused; a record that was read survives writing.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/read_record.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  host::Record record;
  try {
    record = host::parse_record({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
  } catch (const host::Failure&) {
    return 0;
  }
  const std::string text = host::format_record(record);
  const host::Record again = host::parse_record(text, "again.csv");
  if (again.t_s != record.t_s || again.x != record.x || again.x2 != record.x2 || again.w != record.w ||
      again.u_V != record.u_V || host::format_record(again) != text)
    std::abort();
  try {
    sim::DataSheet sheet;
    sheet.encoder_resolution = 0.001;
    host::adapt_to(record, sheet);
    host::check_units(record, sheet);
  } catch (const host::Failure&) {
  }
  return 0;
}
