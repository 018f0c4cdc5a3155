// Effects between the motor's encoder and a sensor on the table, selected by Bayesian evidence alone, and their sizes.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/scale/table_terms.hpp"

namespace host {

/// A value with its 95 % interval.
struct TableSize {
  std::string name, unit;  ///< "gap", "um"
  double value = 0.0;
  std::array<double, 2> ci95{};
};

struct TablePoint {
  double x_mm = 0.0, um = 0.0, deviation_um = 0.0;
};

/// One effect that is certain.
struct TableEffect {
  std::vector<std::string> group;    ///< one kind, or kinds that these rows cannot tell apart, most probable first
  std::string place;                 ///< of a cyclic error: "motor", "scale", "scale or motor"
  double probability = 0.0;          ///< probability that one of the group is present
  double before = 0.0, after = 0.0;  ///< RMS without it and with all effects, um
  bool worth_naming = false;         ///< by the limits in infer/posterior.hpp
  std::vector<TableSize> sizes;
  std::vector<TablePoint> curve;  ///< curve of a pitch error
  sim::EffectEntry entry;         ///< entry for a model; without parameters if a model cannot contain it
  std::string words;

  const std::string& kind() const { return group.front(); }
};

struct TableStudy {
  TableRows rows;
  double before_um = 0.0, left_um = 0.0;  ///< RMS with offsets and delay only; with all effects
  double noise_um = 0.0;
  double delay_s = 0.0;                                     ///< delay of the table's reading after the motor's
  std::vector<TableEffect> effects;                         ///< in the order of discovery
  std::vector<std::pair<std::string, double>> absent_odds;  ///< probability of each kind that was not found
  Eigen::VectorXd left;                                     ///< residual of every row, um

  bool empty() const { return rows.size() == 0; }
  const TableEffect* find(std::string_view kind) const;
  /// Probability that this kind is missing from the model, 0..1; empty if these records cannot show it.
  std::optional<double> probability(std::string_view kind) const;
};

/// Kinds that the model already has are not searched. Empty if no record has a second position, or if the axis does not
/// move in both directions. Bayesian evidence needs no held-back records, so every command uses the same rows. Throws
/// Failure(bad_input) if constants of the drive are missing.
TableStudy study_table(const sim::DriveDescription& model, const std::vector<const Record*>& records);

/// "backlash 12.3 um (95 %: 12.0 to 12.6); …": sentences, with the residual.
std::string table_words(const TableStudy& study);

/// {"rms_um": …, "noise_um", "left_um", "found": [{"kinds", "place", "probability", "sizes": {…}, "curve": […]}]}
nlohmann::json table_json(const TableStudy& study);

}  // namespace host
