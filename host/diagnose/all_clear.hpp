// Decides whether a model that no known effect improves is complete: the residual must be no more than
// noise, and the records must be able to show each effect that was not found.
#pragma once

#include <optional>
#include <string>

#include "host/compare/residual_tests.hpp"
#include "host/diagnose/diagnosis.hpp"

namespace host {

/// Largest error over noise floor of a complete model: simulated cases without an effect give 0.8 to 1.05.
inline constexpr double kSmall = 1.2;

/// The reason why the model is not called complete, or why an effect is not claimed.
struct Objection {
  Status status;            ///< unexplained, or insufficient_data if the records cannot show an effect
  std::string explanation;  ///< sentences
  std::string next_experiment;
};

/// The objection to claiming an effect, if a base fitted to both sets needs no effect; empty otherwise.
std::optional<Objection> objection_to_claim(const Diagnosis& diagnosis);

/// The objection to calling the refitted base complete, if any.
std::optional<Objection> objection_to_all_clear(const Diagnosis& diagnosis);

/// Whether the base fails to predict the speed channel but predicts the position.
bool speed_channel_alone_fails(const Diagnosis& diagnosis);

/// The coordinate on which the residual depends most, and the range of it with the largest residual, in words. The
/// residual is that of the torque or force (`of_motion`), or of the speed channel if only that channel fails. If the
/// residual depends on no coordinate, the region with the largest error is named.
struct Trace {
  std::string coordinate, where;
};
Trace strongest_trace(const Diagnosis& diagnosis, const ResidualTests& of_motion);

}  // namespace host
