// Measures records for a frequency response on a board: multisines at the controller's output, during a slow jog.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "firmware/core/axis_parameters.hpp"
#include "host/device/excitation.hpp"
#include "host/record/record.hpp"

namespace host {

/// Limits and frequency range of the runs. The box's time is the total of all runs.
struct ResponsePlan {
  ExcitationLimits box;
  double from_Hz = 2.0;
  double to_Hz = 0.0;            ///< 0: a quarter of the control rate, 250 Hz at most
  std::size_t realisations = 4;  ///< minimum number of realisations of the phases in each band; more if time allows
  unsigned seed = 1;
  double share = 1.0;  ///< share of the usual amplitude: below 1 if an axis responds more than expected
};

/// Plans the runs in order: bands of at most kExcitationEntries lines, the lowest first, realisations alternately
/// forward and backward. The amplitude is reduced below the box's volts so that friction keeps its sign (the response's
/// speed stays below the jog's) and the following error stays away from its limit. `parameters`: the board's, from
/// which the response is predicted. Throws Failure(refused) if the box has too little travel or time.
std::vector<Excitation> plan_response(const ResponsePlan& plan, const ExcitationScale& scale,
                                      const firmware::AxisParameters<float>& parameters);

/// The same for one band around a resonance, with all odd lines.
std::vector<Excitation> plan_resonance(const ResponsePlan& plan, double f_Hz, const ExcitationScale& scale,
                                       const firmware::AxisParameters<float>& parameters);

/// Closes the loop if it is open, makes the runs and opens it again; appends each record as it is made. Throws what
/// run_excitation() throws, Failure(refused) if a run leaves the box or is interrupted, Failure(device_fault) with
/// cause and remedy.
void make_response_runs(BoardClient& board, std::uint8_t axis, const std::vector<Excitation>& runs,
                        const firmware::ParameterValues& values, const ExcitationScale& scale,
                        const std::function<bool()>& stop, std::vector<Record>& records,
                        const std::function<void(std::size_t done, std::size_t of)>& progress = {});

/// Makes the whole measurement: the bands, then more lines around each resonance found, as far as the box's time allows
/// (half of the bands' time each). Appends each record to `records` as it is made, so that they are kept after a
/// failure.
void measure_axis(BoardClient& board, std::uint8_t axis, const ResponsePlan& plan,
                  const firmware::ParameterValues& values, const ExcitationScale& scale,
                  const std::function<bool()>& stop, std::vector<Record>& records,
                  const std::function<void(std::size_t done, std::size_t of)>& progress = {});

}  // namespace host
