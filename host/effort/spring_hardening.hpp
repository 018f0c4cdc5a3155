// Whether what looks like a spring gets stiffer as the motion grows, as a gap does.
#pragma once

#include <optional>
#include <vector>

#include "host/effort/effort_regression.hpp"
#include "host/effort/effort_rows.hpp"
#include "host/effort/effort_terms.hpp"

namespace host {

/// A second mass in the half of the rows where its spring pulls most, against the other half.
struct SpringHardening {
  double frequency_ratio;  ///< of the frequencies that suit either half best
  double pull_ratio;       ///< of the RMS pulls

  /// A spring has one frequency. Behind a gap, whose stiffness on average is that of a dead zone (describing function),
  /// it rises with the motion until the gap is small beside it.
  bool shows_a_gap() const;
};

/// Of a term with `at_frequency`, fitted beside base and `beside`. Empty where a half determines no frequency.
std::optional<SpringHardening> spring_hardening(const sim::DriveDescription& model, const EffortRows& rows,
                                                const std::vector<EffortTerm>& base,
                                                const std::vector<EffortTerm>& beside, const EffortTerm& spring);

}  // namespace host
