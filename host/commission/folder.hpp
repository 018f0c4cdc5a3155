// The folder of a commissioning: every step's result is a file in it, and commission.json lists them.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/device/excitation.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct CommissionStepText {
  std::string_view name, does;
};

/// The steps in their order.
inline constexpr std::array<CommissionStepText, 15> kCommissionSteps{{
    {"look", "rights and faults, noise at standstill, direction and breakaway by a slow voltage ramp"},
    {"identify", "voltage steps in open loop: inertia, viscous and Coulomb friction"},
    {"control", "a first controller of modest bandwidth, downloaded but not saved"},
    {"home", "homing by switch or index, if the axis has one"},
    {"ladder", "jogs at a series of speeds, in both directions"},
    {"friction", "the friction curve"},
    {"response", "the frequency response, and as much bandwidth as its margins allow"},
    {"validate", "more training motions, and validation motions, one of them twice"},
    {"compare", "prediction error on the validation motions"},
    {"diagnose", "which effect is missing"},
    {"separate", "if several explanations remain: plan and make the run that separates them"},
    {"improve", "significant effects added, all parameters fitted again"},
    {"estimator", "five disturbance variances of the estimator: following error, stiffness, noise of the command"},
    {"compensate", "the same motion with the old and the new parameters; the better set stays"},
    {"page", "one page"},
}};

/// Index of a step in kCommissionSteps. Throws Failure(usage) naming the steps.
std::size_t commission_step(std::string_view name);

/// State kept between steps and between commands. Every change is on disk when its function returns.
class CommissionFolder {
 public:
  /// Opens a folder, or makes it. Throws Failure: permission, bad_input (invalid commission.json).
  explicit CommissionFolder(std::string folder);

  std::string path(std::string_view file) const;
  bool has(std::string_view file) const;
  /// Path of a file; throws Failure(usage) naming the step that writes it if it is missing.
  std::string require(std::string_view file, std::string_view step) const;

  bool is_done(std::size_t step) const;
  std::optional<std::size_t> first_undone() const;
  void begin_at(std::size_t step);  ///< marks this and all later steps, including the page, as not done
  /// `said`: a sentence for the page.
  void finish(std::size_t step, const std::vector<std::string>& files, const std::string& said);

  /// axis-commission/1, with the further fields of the steps.
  const nlohmann::json& document() const { return document_; }
  void put(const std::string& key, const nlohmann::json& value);

  nlohmann::json read_json(std::string_view file) const;
  void write_json(std::string_view file, const nlohmann::json& content) const;

 private:
  void keep() const;

  std::string folder_;
  nlohmann::json document_;
};

}  // namespace host
