// Any bytes as readings of a dial gauge: finite figures, or a refusal.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/scale/dial_readings.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 400) return 0;
  try {
    const host::DialStudy study =
        host::study_dial(host::parse_dial_readings({reinterpret_cast<const char*>(data), size}, "fuzz.csv"));
    for (const host::DialValue& one : {study.lost_um, study.lead_um_per_m})
      if (!std::isfinite(one.value) || !(one.ci95[0] <= one.value) || !(one.value <= one.ci95[1]) ||
          !(one.probability >= 0.0) || !(one.probability <= 1.0 + 1e-9))
        std::abort();
  } catch (const host::Failure&) {
  }
  return 0;
}
