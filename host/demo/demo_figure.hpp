// One figure of the demonstration, with its reference value.
#pragma once

#include <string>
#include <vector>

namespace host {

struct DemoFigure {
  std::string what;  ///< for example "inertia J, kg m^2"
  double found = 0.0;
  double lowest = 0.0;    ///< lowest value that agrees with the reference
  double highest = 0.0;   ///< highest value that agrees with the reference
  std::string reference;  ///< source of the reference value

  bool agrees() const { return found >= lowest && found <= highest; }
};

/// Results of one part of the demonstration.
struct DemoPart {
  std::string sentence;  ///< a summary
  std::vector<DemoFigure> figures;
};

/// `found` agrees if it is within `tolerance` (a fraction) of the true value.
DemoFigure within_fraction(std::string what, double found, double truth, double tolerance);

/// `found`, a magnitude, agrees if it does not exceed `limit`.
DemoFigure at_most(std::string what, double found, double limit);

}  // namespace host
