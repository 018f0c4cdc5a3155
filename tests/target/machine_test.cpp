// Lines and circles of two unequal axes on the emulated board, before and after matching: the target's arithmetic,
// interrupt and protocol, with drives that the image simulates with code of its own.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "firmware/boards/emulated/report_cable.hpp"
#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/design_file.hpp"
#include "tests/host/axes/machine_paths.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/temporary_folder.hpp"
#include "tests/target/cable_port.hpp"
#include "tests/target/qemu.hpp"

namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

/// The board's time passes only while this program waits for the board, and no faster than the computer's.
class CableLink : public host::ReportLink {
 public:
  explicit CableLink(const TemporaryFolder& folder) : port_(folder.path("to_board"), folder.path("link.in")) {}

  void connect() {
    const auto end = steady_clock::now() + 60s;
    while (!cable_->heard_hello()) {
      if (steady_clock::now() > end) throw std::runtime_error("the emulated board does not start");
      while (cable_->poll()) continue;
      std::this_thread::sleep_for(1ms);
    }
    cable_->set_configured(true);
  }
  void send(const hal::HidReport& report) override {
    for (int round = 0; !cable_->send(report); ++round) {
      if (round > 10'000) throw host::Failure(host::ExitCode::no_such_device, "the emulated board takes no reports");
      pass();
    }
  }
  std::optional<hal::HidReport> receive(std::chrono::milliseconds limit) override {
    hal::HidReport report{};
    for (const auto end = now() + limit;; pass()) {
      poll();
      if (cable_->receive(report)) return report;
      if (now() >= end) return std::nullopt;
    }
  }
  steady_clock::time_point now() const override { return steady_clock::time_point(passed_); }
  void wait(std::chrono::milliseconds duration) override {
    for (const auto end = now() + duration; now() < end;) pass();
  }
  std::string name() const override { return "emulated"; }

 private:
  void pass() {
    constexpr int kUsual = 50;
    std::this_thread::sleep_for(silent_ < kUsual ? 1ms : 20ms);
    cable_->pass_time(1000);
    passed_ += 1ms;
    ++silent_;
    poll();
  }
  void poll() {
    while (cable_->poll()) silent_ = 0;
  }

  target_test::CablePort port_;
  std::unique_ptr<firmware::boards::ComputerEnd<target_test::CablePort>> cable_ =
      std::make_unique<firmware::boards::ComputerEnd<target_test::CablePort>>(port_);
  steady_clock::duration passed_{};
  int silent_ = 0;  ///< ms without a byte: an emulator that is slow on a busy computer has to catch up
};

/// The drives of the emulated board: x, and y after the bench's command W.
axes_test::Tasks drives() {
  sim::DriveDescription x = host::read_model(AXIS_TEST_DATA "/drive-cases/none/case-00/model.toml");
  sim::DriveDescription y = x;
  x.name = "x";
  y.name = "y";
  for (sim::EffectEntry& entry : y.effects)
    for (auto& [id, value] : entry.parameters) value *= 2.0;
  y.effects.push_back(axes_test::effect("input_delay", {{"delay", 1e-3}}));
  return {{x, {}}, {y, {}}};
}

class EmulatedMachine : public testing::Test {
 protected:
  void SetUp() override {
    AXIS_SKIP_WHERE_INSTRUMENTED();
    const std::string why = target_test::obstacle("emulated");
    if (!why.empty()) GTEST_SKIP() << why;
    const host::MachineDesign design = axes_test::designed(drives(), false);
    own_ = files_of(design.own, "own-");
    matched_ = files_of(design.matched, "matched-");
  }

  std::vector<std::string> files_of(const host::LoopSet& set, const std::string& of) const {
    std::vector<std::string> files = {
        folder_.write("patient.toml", "format = \"axis-params/1\"\n[host]\ntimeout = 10.0\n")};
    for (const host::AxisLoop& loop : set.axes)
      files.push_back(folder_.write(of + loop.model.name + ".toml",
                                    host::design_toml(loop.model, loop.design, loop.filters, loop.limits.written)));
    return files;
  }
  /// On a board that has just started, so that its axes stand at 0.
  static guest_test::PathInProcess follow(const std::vector<std::string>& files, const std::string& program) {
    const TemporaryFolder cable;
    auto link = std::make_unique<CableLink>(cable);
    CableLink& connection = *link;
    const target_test::Qemu emulator = target_test::start_program(cable.path(""));
    emulator.send("W");
    connection.connect();
    host::BoardClient board(std::move(link), 5s);
    guest_test::PathInProcess done = guest_test::follow_on(board, 2, files, program);
    EXPECT_EQ(static_cast<firmware::PathEnd>(done.outcome.state.end), firmware::PathEnd::completed);
    EXPECT_EQ(done.capture.lost, 0u);
    return done;
  }

  void check_line(double angle_deg, double feed) const {
    const double angle = angle_deg * std::numbers::pi / 180.0;
    const std::string program = axes_test::line_program(angle, feed);
    const auto own = axes_test::line_errors_um(follow(own_, program), angle);
    const auto matched = axes_test::line_errors_um(follow(matched_, program), angle);
    for (const std::size_t way : {0u, 1u}) {
      std::printf("%3.0f mm/s, %2.0f degrees%s: own %6.2f um, matched %5.2f um\n", feed, angle_deg,
                  way == 1 ? " back" : "", own[way], matched[way]);
      EXPECT_LE(matched[way], angle_deg == 45.0 ? own[way] / 5.0 : own[way] + axes_test::kCount_um)
          << feed << ' ' << angle_deg;
    }
  }

  void check_circle(const char* word, double feed) const {
    constexpr double kRadius = 35.0;
    const std::string program = axes_test::circle_program(word, kRadius, feed);
    const double own = axes_test::ellipse_um(follow(own_, program).capture, kRadius, feed);
    const double matched = axes_test::ellipse_um(follow(matched_, program).capture, kRadius, feed);
    std::printf("%3.0f mm/s, %s: ellipse own %6.2f um, matched %5.2f um\n", feed, word, own, matched);
    EXPECT_LE(matched, 0.5) << feed << ' ' << word;
  }

 private:
  TemporaryFolder folder_;
  std::vector<std::string> own_, matched_;
};

/// Catches an image that mixes up the axes' parameters, or moves them at different times.
TEST_F(EmulatedMachine, KeepsALineStraightAndACircleRoundOnceMatched) {
  check_line(45.0, 100.0);
  check_circle("G3", 100.0);
}

TEST_F(EmulatedMachine, KeepsAllLinesStraightAndAllCirclesRoundOnceMatched) {
  if (std::getenv("AXIS_ALL_PATHS") == nullptr) GTEST_SKIP() << "set AXIS_ALL_PATHS to follow all lines and circles";
  for (const double feed : {50.0, 100.0, 150.0})
    for (const double angle_deg : {15.0, 45.0, 75.0}) check_line(angle_deg, feed);
  for (const double feed : {50.0, 100.0})
    for (const char* word : {"G2", "G3"}) check_circle(word, feed);
}

}  // namespace
