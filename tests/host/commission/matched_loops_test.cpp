// The common loop at the end of commissioning two unequal axes: its files, the board's parameters and the following
// errors; and the board's parameters after a refusal.
#include "host/commission/matched_loops.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"
#include "host/simulated_board/simulated_link.hpp"
#include "host/simulated_board/usual_wiring.hpp"
#include "tests/host/axes/unlike_axes.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

/// A link that breaks when it is told to.
class FragileLink : public host::ReportLink {
 public:
  FragileLink(std::unique_ptr<host::ReportLink> link, const bool& is_broken)
      : link_(std::move(link)), is_broken_(is_broken) {}
  void send(const hal::HidReport& report) override {
    if (is_broken_) throw host::Failure(host::ExitCode::no_such_device, "the board is gone");
    link_->send(report);
  }
  std::optional<hal::HidReport> receive(std::chrono::milliseconds limit) override { return link_->receive(limit); }
  std::chrono::steady_clock::time_point now() const override { return link_->now(); }
  void wait(std::chrono::milliseconds duration) override { link_->wait(duration); }
  std::string name() const override { return "fragile"; }

 private:
  std::unique_ptr<host::ReportLink> link_;
  const bool& is_broken_;
};

class MatchedLoops : public testing::Test {
 protected:
  MatchedLoops() {
    const host::CommissionTalk silent;
    for (std::size_t i = 0; i < 2; ++i) {
      const sim::DriveDescription& model = axes_test::machine()[i].model;
      folders_[i] = std::make_unique<host::CommissionFolder>(disk_.path(model.name));
      host::write_model(model, folders_[i]->path("improved.toml"));
      folders_[i]->write_json("errors.json", {{"kept", "after"}, {"sets", {{{"name", "after"}, {"rms_um", 7.0}}}}});
      host::CommissionOptions options;
      options.axis = static_cast<std::uint8_t>(i);
      options.axis_name = model.name;
      options.sheet = model;
      options.sheet.effects.clear();
      options.box = {100.0, 200.0, 6.0, 60.0};
      options.modulus = 0.4;
      host::CommissionSession session(board_, options, silent, *folders_[i]);
      session.give_scales();
      session.plan_limits(model);
      axes_.push_back({options, folders_[i].get()});
    }
  }

  host::BoardClient board() {
    std::vector<host::SimulatedDrive> drives;
    for (const host::AxisTask& task : axes_test::machine()) drives.push_back(host::usual_axis(task.model));
    auto link = std::make_unique<host::SimulatedLink>(host::SimulatedDeviceOptions{drives, "", 1});
    return host::BoardClient(std::make_unique<FragileLink>(std::move(link), is_broken_));
  }

  bool is_broken_ = false;
  const TemporaryFolder disk_;
  std::array<std::unique_ptr<host::CommissionFolder>, 2> folders_;
  std::vector<host::CommissionedAxis> axes_;
  host::BoardClient board_ = board();
};

/// Catches axes that get the gains or the loop of another axis, and following errors of another motion.
TEST_F(MatchedLoops, AreOnTheBoardAndInTheFolders) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const nlohmann::json found = host::match_loops(board_, axes_, {});
  const firmware::ParameterValues values = board_.read_values();
  for (std::size_t i = 0; i < 2; ++i) {
    const nlohmann::json& axis = found["matched"]["axes"][i];
    EXPECT_EQ(axis["options"]["fc_Hz"], found["matched"]["axes"][0]["options"]["fc_Hz"]);
    const double k1 = axis["Kc"][0];
    EXPECT_NEAR(values.axis(i).get<"feedback.k1">(), k1, 1e-5 * k1);
    EXPECT_TRUE(folders_[i]->has("matched-params.toml"));
    EXPECT_TRUE(folders_[i]->has("matched.csv"));
    const nlohmann::json& error = found["following_error_um"][axes_[i].options.axis_name];
    EXPECT_EQ(error["own"], 7.0);
    EXPECT_GT(error["matched"], 0.3);  // steps of 2.44 um
    EXPECT_LT(error["matched"], 12.0);
  }
  EXPECT_GT(values.axis(1).get<"feedback.k1">(), 1.7F * values.axis(0).get<"feedback.k1">());
}

/// Catches a machine with only one of its axes matched.
TEST_F(MatchedLoops, ARefusalLeavesTheBoardAsItWas) {
  const firmware::ParameterValues before = board_.read_values();
  host::CommissionTalk talk;
  int asked = 0;
  talk.consents = [&asked](const std::string&) { return ++asked < 2; };
  try {
    host::match_loops(board_, axes_, talk);
    ADD_FAILURE() << "not refused";
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::refused);
  }
  EXPECT_EQ(board_.read_values(), before);
}

/// Catches a failure to restore the board that hides why the loops were not matched.
TEST_F(MatchedLoops, ABoardThatHasGoneIsSaidToBeGone) {
  host::CommissionTalk talk;
  int asked = 0;
  talk.consents = [&](const std::string&) {
    is_broken_ = ++asked == 2;
    return !is_broken_;
  };
  try {
    host::match_loops(board_, axes_, talk);
    ADD_FAILURE() << "not refused";
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::refused) << failure.what();
    EXPECT_THAT(failure.what(), testing::HasSubstr("does not answer"));
  }
}

}  // namespace
