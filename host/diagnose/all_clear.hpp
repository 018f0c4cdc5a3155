// Whether a model that nothing in the catalogue improves deserves an all-clear: what is left must be small, must depend
// on nothing, and the records must have been able to show what they did not show.
#pragma once

#include <optional>
#include <string>

#include "host/compare/residual_tests.hpp"
#include "host/diagnose/diagnosis.hpp"

namespace host {

/// An error over floor up to which a model may be complete: made cases without any effect leave 0.8 to 1.05.
inline constexpr double kSmall = 1.2;

/// Why there is no all-clear, or no claim.
struct Objection {
  Status status;            ///< unexplained, or insufficient_data where the records could not have shown an effect
  std::string explanation;  ///< sentences
  std::string next_experiment;
};

/// The objection to claiming an effect: a base fitted to both sets needs none. Empty where there is none.
std::optional<Objection> objection_to_claim(const Diagnosis& diagnosis);

/// The objection to calling the re-fitted base complete; empty where there is none.
std::optional<Objection> objection_to_all_clear(const Diagnosis& diagnosis, const ResidualTests& tests);

/// Whether the base fails at the speed channel, and not at the motion that the position shows.
bool speed_channel_alone_fails(const Diagnosis& diagnosis);

/// What is left as the coordinate that carries most of it, and where along it, in words: of the effort (`of_motion`),
/// or of the speed channel where that alone fails. Falls back on the regions of the error where it depends on nothing.
struct Trace {
  std::string coordinate, where;
};
Trace strongest_trace(const Diagnosis& diagnosis, const ResidualTests& of_motion);

}  // namespace host
