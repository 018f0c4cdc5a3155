// Experiments on an axis: the excitation, the box that the board enforces, and the record of all samples.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/core/excitation/excitation_plan.hpp"
#include "host/device/board_client.hpp"
#include "host/device/capture.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Limits that the board itself enforces, relative to the axis's initial position. Every value is > 0.
struct ExcitationLimits {
  double travel = 0.0;  ///< width of the window, centred on the initial position, mm (m)
  double speed = 0.0;   ///< mm/s (m/s)
  double volts = 0.0;   ///< of the command in open loop, or of the part added to a controller's output
  double time_s = 0.0;
};

/// "travel=20,speed=100,volts=3,time=5"; a value may carry its unit (mm, m, um, mm/s, m/s, V, s). Throws
/// Failure(usage), and Failure(refused) for a box that lacks a limit.
ExcitationLimits parse_box(std::string_view text, sim::DriveKind kind);

/// Values by name, e.g. "amplitude=2", "hold=0.3", and numbers without a name, in their order.
struct ExcitationNumbers {
  std::vector<double> list;
  std::map<std::string, double> named;
};
ExcitationNumbers parse_numbers(const std::vector<std::string>& words);

/// Factors from physical units to the board's counts, converter steps and samples.
struct ExcitationScale {
  sim::DriveKind kind = sim::DriveKind::rotary;
  double encoder_resolution = 0.0;  ///< mm (m) per count
  double dac_resolution_V = 0.0;
  double lead = 0.0;  ///< mm/rad; 1 for a linear drive; 0 if unknown
  double rate_Hz = 0.0;
  bool has_tachometer = true;
  double table_resolution = 0.0;          ///< mm (m) per count of the scale on the table, if there is one
  double acceleration = 0.0, jerk = 0.0;  ///< limits of references in closed loop, mm/s^2, mm/s^3 (m)
};

/// From the board's parameters; without lead and limits if the axis is not fitted.
ExcitationScale excitation_scale(const firmware::ParameterValues& values, std::uint8_t axis, sim::DriveKind kind);

struct Excitation {
  firmware::ExcitationRequest request;
  std::vector<firmware::ExcitationEntriesRequest::Entry> entries;
  std::map<std::string, std::string> header;  ///< header of the record: data for the analysis
  std::string summary;                        ///< a line for the user
};

/// Requests that load the entries into a board before the excitation starts.
std::vector<firmware::ExcitationEntriesRequest> entry_requests(const Excitation& excitation, std::uint8_t axis);

/// The kinds of `axistool excite`, with description and numbers.
struct ExcitationKindText {
  std::string_view name, does, numbers;
};
extern const std::array<ExcitationKindText, 8> kExcitationKindTexts;

/// Makes an excitation of a kind that fits its box. `closed_loop`: "" or "reference" or "output". Throws Failure(usage)
/// for unknown kinds and numbers, and Failure(refused) if the numbers do not fit the box.
Excitation design_excitation(std::string_view kind, const ExcitationNumbers& numbers, const ExcitationLimits& box,
                             const ExcitationScale& scale, std::string_view closed_loop = {}, unsigned seed = 1);

struct ExcitationOutcome {
  Capture capture;
  CaptureSettings settings;
  firmware::ExcitationStatePayload state;
};

/// The reason for the end, in words.
std::string_view end_name(firmware::ExcitationStatePayload state);

/// Runs an excitation and captures every sample, from shortly before the start until the axis stands. For closed loop
/// an axis whose loop is open is enabled first and disabled afterwards. `values`: parameters with the scales of the
/// drive. Throws as BoardClient does; the board is then stopped.
ExcitationOutcome run_excitation(BoardClient& board, std::uint8_t axis, const Excitation& excitation,
                                 const firmware::ParameterValues& values, const ExcitationScale& scale,
                                 const std::function<bool()>& stop,
                                 const std::function<void(std::size_t)>& progress = {});

/// Runs several excitations one after the other in one capture, until one does not complete. `make(index, offset)`: the
/// excitation for an axis that stands at `offset` (mm or m) from its initial position. The returned state is that of
/// the last one, with the total time and the largest distance from the initial position.
ExcitationOutcome run_excitations(BoardClient& board, std::uint8_t axis, std::size_t count,
                                  const std::function<Excitation(std::size_t, double)>& make,
                                  const firmware::ParameterValues& values, const ExcitationScale& scale,
                                  const std::function<bool()>& stop,
                                  const std::function<void(std::size_t)>& progress = {});

}  // namespace host
