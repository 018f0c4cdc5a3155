// Records for a frequency response, made on a board: multisines at the controller's output, on a slow jog.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "firmware/core/axis_parameters.hpp"
#include "host/device/excitation.hpp"
#include "host/record/record.hpp"

namespace host {

/// What the runs may use and should show. The box's time is that of all runs together.
struct ResponsePlan {
  ExcitationLimits box;
  double from_Hz = 2.0;
  double to_Hz = 0.0;            ///< 0: a quarter of the control rate, 250 Hz at most
  std::size_t realisations = 4;  ///< of the phases, in each band, at least; more where the time allows
  unsigned seed = 1;
  double share = 1.0;  ///< of the amplitude that is otherwise chosen: less where an axis answers more than expected
};

/// One run after the other: bands of at most kExcitationEntries lines, the lowest first, each realisation by turns
/// forward and backward. The amplitude is less than the box's volts where friction would change its sign (the answer's
/// speed stays below the jog's) or the following error would come near to what is watched. `parameters`: what the board
/// runs; they tell how far the axis answers. Throws Failure(refused) where travel or time of the box is too little.
std::vector<Excitation> plan_response(const ResponsePlan& plan, const ExcitationScale& scale,
                                      const firmware::AxisParameters<float>& parameters);

/// Likewise one band about a resonance, all odd lines there.
std::vector<Excitation> plan_resonance(const ResponsePlan& plan, double f_Hz, const ExcitationScale& scale,
                                       const firmware::AxisParameters<float>& parameters);

/// Closes the loop if it is open, makes the runs and opens it again; appends their records as they come. Throws what
/// run_excitation() throws, Failure(refused) where a run leaves the box or is interrupted, Failure(device_fault) with
/// cause and remedy.
void make_response_runs(BoardClient& board, std::uint8_t axis, const std::vector<Excitation>& runs,
                        const firmware::ParameterValues& values, const ExcitationScale& scale,
                        const std::function<bool()>& stop, std::vector<Record>& records,
                        const std::function<void(std::size_t done, std::size_t of)>& progress = {});

/// All of it: the bands, then a closer look at each resonance that they show, as long as the box's time lasts (each
/// gets half as much as the bands). Records are appended to `records` as they come, so that they are there when it
/// fails.
void measure_axis(BoardClient& board, std::uint8_t axis, const ResponsePlan& plan,
                  const firmware::ParameterValues& values, const ExcitationScale& scale,
                  const std::function<bool()>& stop, std::vector<Record>& records,
                  const std::function<void(std::size_t done, std::size_t of)>& progress = {});

}  // namespace host
