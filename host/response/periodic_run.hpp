// Spectra of one multisine record at the frequencies of its lines.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "host/record/record.hpp"

namespace host {

/// A multisine, from a record's header (written by host/device/excitation.hpp).
struct MultisineHeader {
  std::size_t period = 0;            ///< samples
  std::vector<std::size_t> lines;    ///< multiples of 1/period, increasing
  std::vector<double> phases_turns;  ///< as many as lines, or none
  bool is_closed_loop = false;
  bool is_at_reference = false;  ///< added to the reference instead of the command
};

/// The multisine of a record's header; empty if it has none. Throws Failure(bad_input) if it is inconsistent.
std::optional<MultisineHeader> multisine_of(const Record& record);

/// Spectra of command, position and speed in each whole period of the steady part.
struct PeriodicRun {
  MultisineHeader excitation;
  double sample_period_s = 0.0;
  /// [period][line]: command, position, speed (0 where not recorded).
  struct Sample {
    std::complex<double> u, x, w;
  };
  std::vector<std::vector<Sample>> period;
  /// The same at unexcited lines between them, odd and even.
  std::vector<std::size_t> odd_lines, even_lines;
  std::vector<std::vector<Sample>> odd, even;
};

/// The steady part is the longest range in which the lines have their full size and the jog has a constant speed.
/// Removes a straight line from the position. Throws Failure(refused) if fewer than two periods remain.
PeriodicRun periodic_run(const Record& record, const MultisineHeader& excitation);

}  // namespace host
