// Any bytes as a record, through reading, identification, comparison and prediction: a result or a refusal.
#include <cstdint>
#include <string_view>

#include "host/compare/model_comparison.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/identification.hpp"
#include "host/model/model_file.hpp"
#include "host/record/read_record.hpp"

namespace {

/// Effects with memory before a window, or that change the readings.
constexpr std::string_view kModel = R"(format = "axis-model/1"
[drive]
kind = "rotary"
amplifier_gain_A_per_V = 6.4898
torque_constant_Nm_per_A = 0.4769
lead_mm_per_rad = 1.5915494309189535
sample_period_s = 0.001
[drive.dac]
resolution_V = 0.00030517578125
[drive.encoder]
resolution_mm = 0.00244140625
[drive.tach]
noise_variance_rad2_s2 = 0.05
[[effect]]
kind = "inertia"
J_kg_m2 = 0.00765
[[effect]]
kind = "viscous"
B_Nm_s_per_rad = 0.0296
[[effect]]
kind = "coulomb"
positive_Nm = 2.205
negative_Nm = -1.656
[[effect]]
kind = "cogging"
cosine_Nm = 0.3
sine_Nm = 0.1
period_mm = 2.5
[[effect]]
kind = "input_delay"
delay_s = 0.002
[[effect]]
kind = "encoder_cyclic_error"
cosine_mm = 0.01
sine_mm = 0.0
period_mm = 2.0
)";

void try_out(const host::Measurements& measured, const sim::DriveDescription& model) {
  try {
    host::identify_drive(measured, model, host::default_method(measured.training()));
  } catch (const host::Failure&) {
  }
  try {
    const host::RecordSet set = host::compare_on(measured.training_records(), model);
    host::compare_model(model, measured, set);
    host::predictions_csv(model, set.records.front().prepared);
  } catch (const host::Failure&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kLongest = 1 << 16;  // some thousand rows: fast enough to try many
  if (size > kLongest) return 0;
  static const sim::DriveDescription model = host::parse_model(kModel, "model.toml");
  try {
    const host::GateOptions as_logged{.accepted = {}, .as_logged = true};
    std::vector<host::Record> records{host::parse_record({reinterpret_cast<const char*>(data), size}, "fuzz.csv")};
    try_out(host::MeasurementGate(model, as_logged).admit(std::move(records)), model);
  } catch (const host::Failure&) {
  }
  return 0;
}
