// Any bytes as a scenario: read or refused with a message; its paths likewise.
#include <cstdint>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/hil/scenario.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const host::Scenario scenario = host::parse_scenario({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    const sim::DataSheet &x = scenario.axes[0].drive.data, &y = scenario.axes[1].drive.data;
    constexpr double kLongest_s = 20.0;  // of motion: fast enough to try many
    for (const host::ScenarioMove& move : scenario.moves)
      if (move.path && move.path->length() / move.path_limits.feed < kLongest_s)
        host::follow_path(*move.path, move.path_limits, x.sample_period_s,
                          {x.encoder_resolution, y.encoder_resolution});
  } catch (const host::Failure&) {
    return 0;
  }
  return 0;
}
