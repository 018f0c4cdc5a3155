// The first controller on an axis that falls without current.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/commission/steps.hpp"
#include "host/model/model_file.hpp"
#include "tests/host/commission/own_machine.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

/// Message of the refusal; empty if the step was done. 3 Nm of weight against 2 Nm of friction.
std::string refusal(bool has_tachometer, double weight_Nm, bool& has_controller) {
  const TemporaryFolder disk;
  OwnBoard board;
  host::BoardClient client = board.client();
  host::CommissionFolder folder(disk.path("x"));
  host::CommissionOptions options = own_options();
  if (!has_tachometer) options.sheet.data.tach_noise_variance.reset();
  host::CommissionSession session(client, options, host::CommissionTalk{}, folder);
  sim::DriveDescription model = options.sheet;
  model.effects = {{"inertia", {{"J", 0.008}}, {}, {}},
                   {"viscous", {{"B", 0.03}}, {}, {}},
                   {"coulomb", {{"positive", 2.0}, {"negative", -2.0}}, {}, {}},
                   {"constant_torque", {{"torque", weight_Nm}}, {}, {}}};
  host::write_model(model, folder.path("identified.toml"));
  session.give_scales();
  std::string message;
  try {
    host::control_first(session);
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::refused) << failure.what();
    message = failure.what();
  }
  has_controller = client.read_values().axis(0).get<"feedback.k1">() != 0.0F;
  return message;
}

TEST(ControlFirst, NeedsASensorThatShowsADeadEncoderBeforeTheAxisFalls) {
  bool has_controller = true;
  EXPECT_THAT(refusal(false, 3.0, has_controller), testing::HasSubstr("encoder.fault_input"));
  EXPECT_FALSE(has_controller) << "nothing is downloaded";
  EXPECT_EQ(refusal(true, 3.0, has_controller), "");
  EXPECT_TRUE(has_controller);
  EXPECT_EQ(refusal(false, 1.0, has_controller), "") << "friction holds it";
}

}  // namespace
