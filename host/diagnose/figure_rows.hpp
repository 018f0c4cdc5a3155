// The rows of the records on which every model of a diagnosis is measured, with the same error figures as compare.
#pragma once

#include <vector>

#include "host/compare/error_figures.hpp"
#include "host/fit/prepared_sets.hpp"
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
  sim::DataSheet data;  ///< as given, without the sensor properties found in the records

  /// Error of each set as compare reports it. The time offset of a logged current is estimated for this model. Throws
  /// as figure_set() does.
  ErrorOnSets error_of(sim::DriveDescription model) const;
};

/// All windows of the records. Without a validation record, the held-back windows are the validation data. `split`: the
/// records of this model already split into the usual windows, if available.
FigureRows figure_rows(const sim::DriveDescription& given, const Measurements& measured,
                       const PreparedSets* split = nullptr);

/// Whether a model with `error` predicts held-back records worse than one with `given`: its error over noise floor and
/// the RMS error of a channel are larger, or the RMS errors of all channels are larger, even if its error over noise
/// floor is not.
bool is_worse(const ErrorFigures& error, const ErrorFigures& given);

}  // namespace host
