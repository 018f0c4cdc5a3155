// Table of the faults that can be injected into a machine, for scenario files, random tests and the documentation.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "host/hil/machine.hpp"

namespace host {

struct InjectionInfo {
  std::string_view kind;  ///< name in scenario files
  std::string_view what;
  std::string_view unit;  ///< unit of the value; "" if it has none
  double usual = 0.0;     ///< value if the scenario gives none
  double least = 0.0;     ///< smallest magnitude that must be detected
  bool of_board = false;  ///< affects both axes
  /// Requirement for the fault to be found: an optional part of the machine or a phase, see FaultTrial.
  enum class Needs { nothing, encoder_fault_input, ready_input, brake, open_loop } needs = Needs::nothing;
  /// The faults that identify this cause.
  std::vector<firmware::AxisFault> named_by;
  void (*apply)(Machine& machine, std::size_t axis, double value);
  void (*heal)(Machine& machine, std::size_t axis);
};

std::span<const InjectionInfo> injections();

/// nullptr for an unknown kind.
const InjectionInfo* find_injection(std::string_view kind);

}  // namespace host
