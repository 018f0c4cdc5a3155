// Windows that are simulated side by side.
#include "host/compare/prediction.hpp"

#include <gtest/gtest.h>

#include "tests/host/evidence/hand_made_record.hpp"

namespace {

TEST(Prediction, OfAWindowIsTheSameInAnyCompany) {
  const host::Record record = HandMade::record(3.0);
  sim::DriveDescription model = HandMade::model();
  model.effects.push_back({"input_delay", {{"delay", 0.0025}}, {}, {}});
  const sim::Drive drive(model);
  const host::PreparedRecord prepared = host::prepare(record, model);
  ASSERT_GT(prepared.windows.size(), 2 * host::kSideBySide);
  for (const std::size_t stride : {1, 3}) {
    host::Prediction together;
    host::predict(drive, prepared, together, stride);
    const std::vector<sim::DriveState> states = host::restart_states(drive, prepared, stride);
    for (std::size_t index = 0; index < prepared.windows.size(); index += stride) {
      const host::Window& window = prepared.windows[index];
      std::vector<double> x(window.length), w(window.length);
      host::WindowRun alone{&window, states[index / stride], x.data(), w.data()};
      host::run_side_by_side(drive, prepared, {&alone, 1});
      for (std::size_t k = 0; k < window.length; ++k) {
        ASSERT_EQ(together.x[window.begin + 1 + k], x[k]) << "window " << index;
        ASSERT_EQ(together.w[window.begin + 1 + k], w[k]) << "window " << index;
      }
    }
  }
}

}  // namespace
