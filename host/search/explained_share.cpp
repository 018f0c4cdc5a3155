#include "host/search/explained_share.hpp"

#include <algorithm>

namespace host {

double explained_share(double before, double after) {
  const double there_is = before * before - kComplete * kComplete;
  return there_is > 0.0 ? std::clamp((before * before - after * after) / there_is, 0.0, 1.0) : 0.0;
}

}  // namespace host
