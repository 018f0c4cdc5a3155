// All results of `make demo`, in one report and one list of figures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/demo/demo_figure.hpp"
#include "host/report/report.hpp"

namespace host {

struct DemonstrationInput {
  std::string drive_case;                  ///< folder of the shipped record (see show_shipped_drive)
  std::optional<std::string> emps_folder;  ///< folder of the public benchmark; empty: left out
};

struct Demonstration {
  Report report;
  std::vector<DemoFigure> figures;

  bool agrees() const;  ///< every figure agrees with its reference
};

/// Takes some seconds; shows its progress on a terminal. Throws Failure if an input is missing or a step is refused.
Demonstration demonstrate(const DemonstrationInput& input);

/// Figures and their reference values, one row each.
Table figures_table(const std::vector<DemoFigure>& figures);

}  // namespace host
