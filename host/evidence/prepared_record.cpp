#include "host/evidence/prepared_record.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "host/exit_codes.hpp"
#include "sim/drive.hpp"

namespace host {

PreparedRecord prepare(const Record& record, const sim::DriveDescription& base, double window_s) {
  const auto length = static_cast<std::size_t>(std::lround(window_s / record.sample_period_s));
  if (length < 2 || record.size() < length + 1)
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: {} samples of {} s are too few for a window of {} s; record longer or choose --window",
                    record.path, record.size(), record.sample_period_s, window_s));
  const sim::EffectEntry* inertia = base.find("inertia");
  const sim::EffectEntry* viscous = base.find("viscous");
  if (inertia == nullptr)
    throw Failure(ExitCode::bad_input,
                  base.name + ": the model has no [[effect]] of kind \"inertia\"; identify the drive first");
  const sim::Drive drive(base);
  const double friction_level = drive.friction[0].coulomb + drive.friction[1].coulomb;
  PreparedRecord prepared{
      &record,
      command_volts(record, base.data),
      MotionSmoother(record, base.data, inertia->at("J"), viscous == nullptr ? 0.0 : viscous->at("B"), friction_level),
      {},
      record.sample_period_s,
      nullptr};
  std::vector<ShiftWeights> weights;
  for (std::size_t begin = 0; begin + length < record.size(); begin += length) {
    prepared.windows.push_back({begin, length});
    weights.push_back(prepared.smoother.shift_weights(begin));
  }
  prepared.shift_weights = std::make_shared<const std::vector<ShiftWeights>>(std::move(weights));
  return prepared;
}

}  // namespace host
