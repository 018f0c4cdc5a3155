// Lines and circles of two unequal axes over the board's protocol, on a simulated board with the parameter files of
// `design`, with each axis's best loop and with one loop for both. Computes the errors from the captured encoder
// positions. Catches parameters that are lost or mixed up between the design and the board, and axes that are not
// synchronised.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "host/parameters/design_file.hpp"
#include "tests/guest/support/path_in_process.hpp"
#include "tests/host/axes/machine_paths.hpp"
#include "tests/host/axes/unlike_axes.hpp"
#include "tests/host/commission/own_machine.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using axes_test::kCount_um;

/// The design of a machine as parameter files, and programs on a simulated board with them.
class BoardWithLoops : public testing::Test {
 protected:
  BoardWithLoops(const axes_test::Tasks& tasks, bool zero_phase) : design_(axes_test::designed(tasks, zero_phase)) {}

  virtual std::vector<host::SimulatedDrive> drives() const = 0;

  guest_test::PathInProcess follow(const std::vector<std::string>& files, const std::string& program) const {
    guest_test::PathInProcess done = guest_test::follow_in_process(drives(), files, program);
    EXPECT_EQ(static_cast<firmware::PathEnd>(done.outcome.state.end), firmware::PathEnd::completed);
    EXPECT_EQ(done.capture.lost, 0u);
    return done;
  }

  void expect_round_circles() const {
    const double radius = 35.0;
    // At 160 mm/s y of the unequal axes reaches its limit of acceleration where it reverses: the path slows down there,
    // and the circle's radius depends on the feed.
    for (const double feed : {50.0, 150.0})
      for (const char* word : {"G2", "G3"}) {
        const std::string program = axes_test::circle_program(word, radius, feed);
        const auto ellipse_um = [&](const std::vector<std::string>& files) {
          return axes_test::ellipse_um(follow(files, program).capture, radius, feed);
        };
        const double own = ellipse_um(own_), matched = ellipse_um(matched_);
        std::printf("%3.0f mm/s, %s: ellipse own %6.2f um, matched %5.2f um\n", feed, word, own, matched);
        EXPECT_LE(matched, 0.5) << feed << ' ' << word;
      }
  }

 private:
  std::vector<std::string> files_of(const host::LoopSet& set, const std::string& of) const {
    std::vector<std::string> files;
    for (const host::AxisLoop& loop : set.axes)
      files.push_back(folder_.write(of + loop.model.name + ".toml",
                                    host::design_toml(loop.model, loop.design, loop.filters, loop.limits.written)));
    return files;
  }

  TemporaryFolder folder_;
  const host::MachineDesign design_;

 protected:
  const std::vector<std::string> own_ = files_of(design_.own, "own-"), matched_ = files_of(design_.matched, "matched-");
};

class MatchedBoard : public BoardWithLoops, public testing::WithParamInterface<bool> {
 protected:
  MatchedBoard() : BoardWithLoops(axes_test::machine(), GetParam()) {}

  std::vector<host::SimulatedDrive> drives() const override {
    return {{axes_test::machine()[0].model}, {axes_test::machine()[1].model}};
  }
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

TEST_P(MatchedBoard, KeepsCirclesRound) { expect_round_circles(); }

INSTANTIATE_TEST_SUITE_P(Feedforward, MatchedBoard, testing::Values(true, false),
                         [](const auto& which) { return which.param ? "ZeroPhase" : "Velocity"; });

struct OwnDrive {
  double inertia, friction_Nm;
  bool is_late;

  sim::DriveDescription model(const char* name) const {
    sim::DriveDescription made = own_sheet();
    made.name = name;
    made.data.amplifier_gain_A_per_V = 6.0;  // the machine's own
    made.effects = {axes_test::effect("inertia", {{"J", inertia}}), axes_test::effect("viscous", {{"B", 0.03}}),
                    axes_test::effect("coulomb", {{"positive", friction_Nm}, {"negative", -friction_Nm}})};
    if (is_late) made.effects.push_back(axes_test::effect("input_delay", {{"delay", made.data.sample_period_s}}));
    return made;
  }
  host::SimulatedDrive machine(const char* name) const {
    auto moves = std::make_shared<OwnMachine>();
    moves->inertia = inertia;
    moves->friction_Nm = friction_Nm;
    moves->is_late = is_late;
    return {model(name), {}, moves};
  }
};

/// Two machines that share no code with the simulator. Inertia and friction of their axes differ by a factor of two;
/// the slower amplifier drives the heavier axis of the first machine and the lighter axis of the second.
class IndependentMachine : public BoardWithLoops, public testing::WithParamInterface<std::array<OwnDrive, 2>> {
 protected:
  IndependentMachine() : BoardWithLoops({{GetParam()[0].model("x"), {}}, {GetParam()[1].model("y"), {}}}, false) {}

  std::vector<host::SimulatedDrive> drives() const override {
    return {GetParam()[0].machine("x"), GetParam()[1].machine("y")};
  }
};

TEST_P(IndependentMachine, KeepsLinesStraight) {
  const double angle = std::numbers::pi / 4.0;
  for (const double feed : {50.0, 100.0, 150.0}) {
    const std::string program = axes_test::line_program(angle, feed);
    const auto own = axes_test::line_errors_um(follow(own_, program), angle);
    const auto matched = axes_test::line_errors_um(follow(matched_, program), angle);
    for (const std::size_t way : {0u, 1u}) {
      std::printf("%3.0f mm/s%s: own %6.2f um, matched %5.2f um\n", feed, way == 1 ? " back" : "", own[way],
                  matched[way]);
      EXPECT_LE(matched[way], own[way] / 5.0) << feed;
    }
  }
}

TEST_P(IndependentMachine, KeepsCirclesRound) { expect_round_circles(); }

INSTANTIATE_TEST_SUITE_P(Made, IndependentMachine,
                         testing::Values(std::array{OwnDrive{0.008, 2.0, false}, OwnDrive{0.016, 4.0, true}},
                                         std::array{OwnDrive{0.012, 3.0, false}, OwnDrive{0.006, 1.5, true}}));

}  // namespace
