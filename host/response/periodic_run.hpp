// What one record of a multisine holds at the frequencies of its lines.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "host/record/record.hpp"

namespace host {

/// A multisine as a record's header tells it (host/device/excitation.hpp writes it there).
struct MultisineHeader {
  std::size_t period = 0;            ///< samples
  std::vector<std::size_t> lines;    ///< multiples of 1/period, increasing
  std::vector<double> phases_turns;  ///< as many, or none
  bool is_closed_loop = false;
  bool is_at_reference = false;  ///< it was added to the reference, not to the command
};

/// Empty where the header tells of none. Throws Failure(bad_input) for one that makes no sense.
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
  /// The same at the odd lines between them that are not excited, and at the even ones.
  std::vector<std::size_t> odd_lines, even_lines;
  std::vector<std::vector<Sample>> odd, even;
};

/// The steady part is the longest in which the lines have their full size and the jog beneath keeps its speed; a
/// straight line is taken off the position. Throws Failure(refused) where fewer than two periods are left.
PeriodicRun periodic_run(const Record& record, const MultisineHeader& excitation);

}  // namespace host
