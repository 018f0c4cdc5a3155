// Figures that the reports of a diagnosis and of an improvement share.
#pragma once

#include "host/diagnose/diagnosis.hpp"
#include "host/diagnose/found_effect.hpp"
#include "host/report/report.hpp"

namespace host {

/// The winning panels: each of the effects, its residual and its own fitted curve (effect_plot). `rivals`: the records
/// cannot tell them apart.
void add_found(Report& report, const std::vector<FoundEffect>& found, bool rivals);

/// In the place of the winning panel: the residual over the coordinate that carries most of what nothing explains.
void add_unexplained(Report& report, const Diagnosis& diagnosis);

/// RMS errors of one channel on validation data, in its own unit.
struct ChannelError {
  std::string name;
  double before_validate = 0.0, after_validate = 0.0, floor_validate = 0.0;
};
std::vector<ChannelError> channel_errors(const ErrorFigures& before, const ErrorFigures& after,
                                         const std::optional<EffortError>& effort);

/// Position, speed, and torque or force where that is the measure: the errors on validation data in the units of the
/// machine. Where nothing was added, `before` alone is shown.
Table error_table(const std::vector<ChannelError>& channels, bool added);

/// "On validation data: position error 12.3 -> 1.2 µm (-90 %), ..."; empty where nothing was judged.
std::string errors_in_words(const std::vector<ChannelError>& channels);

/// What "noise floor" means, in one sentence, for where it first stands.
inline constexpr const char* kNoiseFloorMeans =
    "The noise floor is the error that a perfect model would still leave: sensor noise, quantisation and the restart "
    "of the prediction.";

/// The residual on validation data over the coordinates in which effects show: of the base, fitted again, and where
/// effects were added, of `best`.
void add_residuals(Report& report, const Diagnosis& diagnosis, const sim::DriveDescription& best, bool added);

/// What to do about each of the effects: the catalogue's remedies.
std::vector<std::string> remedies(const std::vector<std::string>& kinds);

/// Whether what is left is noise: its correlation with itself and with the command, with the bounds that a white one
/// keeps, and how much of it depends on each coordinate.
void add_whiteness(Report& report, const Diagnosis& diagnosis);

/// The first validation record: measured, predicted by `best`, and the errors.
void add_traces(Report& report, const Diagnosis& diagnosis, const sim::DriveDescription& best, bool added);

/// Error over noise floor without and with each candidate. What the verdict names stands first, together with what the
/// records cannot tell from it; what changes nothing is folded.
void add_candidates(Report& report, const Diagnosis& diagnosis);

}  // namespace host
