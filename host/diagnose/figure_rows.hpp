// The rows of the records that every model of a diagnosis is measured on, in the figures that compare prints.
#pragma once

#include <vector>

#include "host/compare/error_figures.hpp"
#include "host/diagnose/prepared_sets.hpp"
#include "host/record/measurements.hpp"

namespace host {

/// Figures of one model on both sets.
struct ErrorOnSets {
  ErrorFigures train, validate;
};

/// { "train", "validate" }
nlohmann::json to_json(const ErrorOnSets& error);

struct FigureRows {
  std::vector<FigureRecord> train, validate;
  sim::DataSheet data;  ///< as it was given, without what the records show of the sensors

  /// Of each set as compare tells it: with the time at which a logged current acts estimated beside the model. Throws
  /// as figure_set() does.
  ErrorOnSets error_of(sim::DriveDescription model) const;
};

/// All windows of the records; where there is no validation record, those that train and those that are kept back.
/// `split`: the records of this model split into usual windows, where that is at hand.
FigureRows figure_rows(const sim::DriveDescription& given, const Measurements& measured,
                       const PreparedSets* split = nullptr);

/// Whether `error` predicts held-back records worse than `given`: more times the noise floor, and farther off in a
/// channel; or farther off in all of them, whatever the model's own noise floor says.
bool is_worse(const ErrorFigures& error, const ErrorFigures& given);

}  // namespace host
