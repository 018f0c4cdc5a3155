#include "host/evidence/coming_back.hpp"

#include <algorithm>

namespace host {

bool comes_back(const Record& record) {
  if (!record.has_position()) return false;
  double lowest = record.x.front(), highest = record.x.front(), up = 0.0, down = 0.0;
  for (const double x : record.x) {
    lowest = std::min(lowest, x);
    highest = std::max(highest, x);
    up = std::max(up, x - lowest);
    down = std::max(down, highest - x);
  }
  constexpr double kHalf = 0.5;
  return std::min(up, down) >= kHalf * (highest - lowest) && highest > lowest;
}

}  // namespace host
