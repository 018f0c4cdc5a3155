// Figures that the reports of a diagnosis and of an improvement share.
#pragma once

#include "host/diagnose/diagnosis.hpp"
#include "host/diagnose/found_effect.hpp"
#include "host/report/report.hpp"

namespace host {

/// The first figures: for each effect the residual without it and its fitted curve (effect_plot). `rivals`: the records
/// cannot tell the effects apart.
void add_found(Report& report, const std::vector<FoundEffect>& found, bool rivals);

/// If no effect is named: the residual over the coordinate on which it depends most.
void add_unexplained(Report& report, const Diagnosis& diagnosis);

/// RMS errors of one channel on validation data, in its own unit.
struct ChannelError {
  std::string name;
  double before_validate = 0.0, after_validate = 0.0, floor_validate = 0.0;
};
std::vector<ChannelError> channel_errors(const ErrorFigures& before, const ErrorFigures& after,
                                         const std::optional<EffortError>& effort);

/// Errors on validation data, in the machine's units, of position and speed, and of torque or force if that is the
/// measure. If nothing was added, only `before` is shown.
Table error_table(const std::vector<ChannelError>& channels, bool added);

/// "On validation data: position error 12.3 -> 1.2 µm (-90 %), ..."; empty without validation.
std::string errors_in_words(const std::vector<ChannelError>& channels);

/// Definition of "noise floor" in one sentence, for its first occurrence.
inline constexpr const char* kNoiseFloorMeans =
    "The noise floor is the error that a perfect model would still leave: sensor noise, quantisation and the restart "
    "of the prediction.";

/// The residual on validation data over the coordinates in which effects show: of the refitted base and, if effects
/// were added, also of `best`.
void add_residuals(Report& report, const Diagnosis& diagnosis, const sim::DriveDescription& best, bool added);

/// The catalogue's remedies for each of the effects.
std::vector<std::string> remedies(const std::vector<std::string>& kinds);

/// Whether the residual is noise: its autocorrelation and its correlation with the command, with the bounds for white
/// noise, and the share of it that depends on each coordinate.
void add_whiteness(Report& report, const Diagnosis& diagnosis);

/// The first validation record: measured, predicted by `best`, and the errors.
void add_traces(Report& report, const Diagnosis& diagnosis, const sim::DriveDescription& best, bool added);

/// Error over noise floor without and with each candidate. The named effects come first, together with the effects that
/// the records cannot tell from them. Candidates that change nothing are folded.
void add_candidates(Report& report, const Diagnosis& diagnosis);

}  // namespace host
