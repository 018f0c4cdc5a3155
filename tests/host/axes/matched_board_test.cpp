// Lines and circles of two unequal axes over the board's protocol, on a simulated board with the parameter files of
// `design`, with each axis's best loop and with one loop for both. Computes the errors from the captured encoder
// positions. Catches parameters that are lost or mixed up between the design and the board, and axes that are not
// synchronised.
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "host/parameters/design_file.hpp"
#include "tests/guest/support/path_in_process.hpp"
#include "tests/host/axes/machine_paths.hpp"
#include "tests/host/axes/unlike_axes.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using axes_test::kCount_um;

class MatchedBoard : public testing::TestWithParam<bool> {
 protected:
  std::vector<std::string> files_of(const host::LoopSet& set, const std::string& of) const {
    std::vector<std::string> files;
    for (const host::AxisLoop& loop : set.axes)
      files.push_back(folder_.write(of + loop.model.name + ".toml",
                                    host::design_toml(loop.model, loop.design, loop.filters, loop.limits.written)));
    return files;
  }

  static guest_test::PathInProcess follow(const std::vector<std::string>& files, const std::string& program) {
    guest_test::PathInProcess done =
        guest_test::follow_in_process({axes_test::machine()[0].model, axes_test::machine()[1].model}, files, program);
    EXPECT_EQ(static_cast<firmware::PathEnd>(done.outcome.state.end), firmware::PathEnd::completed);
    EXPECT_EQ(done.capture.lost, 0u);
    return done;
  }

  TemporaryFolder folder_;
  const host::MachineDesign design_ = axes_test::designed(axes_test::machine(), GetParam());
  const std::vector<std::string> own_ = files_of(design_.own, "own-"), matched_ = files_of(design_.matched, "matched-");
};

TEST_P(MatchedBoard, KeepsLinesStraight) {
  for (const double feed : {50.0, 100.0, 200.0})
    for (const double angle_deg : {15.0, 45.0, 75.0}) {
      const double angle = angle_deg * std::numbers::pi / 180.0;
      const std::string program = axes_test::line_program(angle, feed);
      const auto own = axes_test::line_errors_um(follow(own_, program), angle);
      const auto matched = axes_test::line_errors_um(follow(matched_, program), angle);
      for (const std::size_t way : {0u, 1u}) {
        std::printf("%s, %3.0f mm/s, %2.0f degrees%s: own %6.2f um, matched %5.2f um\n",
                    GetParam() ? "zero phase" : "velocity", feed, angle_deg, way == 1 ? " back" : "", own[way],
                    matched[way]);
        if (!GetParam() && angle_deg == 45.0) {
          EXPECT_LE(matched[way], own[way] / 5.0) << feed;
        }
        EXPECT_LE(matched[way], own[way] + kCount_um) << feed << ' ' << angle_deg;
      }
    }
}

TEST_P(MatchedBoard, KeepsCirclesRound) {
  const double radius = 35.0;
  // At 160 mm/s y reaches its limit of acceleration where it reverses: the path slows down there, and the circle's
  // radius depends on the feed.
  for (const double feed : {50.0, 150.0})
    for (const char* word : {"G2", "G3"}) {
      const std::string program = axes_test::circle_program(word, radius, feed);
      const auto ellipse_um = [&](const std::vector<std::string>& files) {
        return axes_test::ellipse_um(follow(files, program).capture, radius, feed);
      };
      const double own = ellipse_um(own_), matched = ellipse_um(matched_);
      std::printf("%s, %3.0f mm/s, %s: ellipse own %6.2f um, matched %5.2f um\n",
                  GetParam() ? "zero phase" : "velocity", feed, word, own, matched);
      EXPECT_LE(matched, 0.5) << feed << ' ' << word;
    }
}

INSTANTIATE_TEST_SUITE_P(Feedforward, MatchedBoard, testing::Values(true, false),
                         [](const auto& which) { return which.param ? "ZeroPhase" : "Velocity"; });

}  // namespace
