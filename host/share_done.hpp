// Progress of a long computation.
#pragma once

#include <functional>

namespace host {

/// Called from any thread with the finished share of the work, 0..1.
using ShareDone = std::function<void(double)>;

/// Maps the progress of one part of the work to the range `from` to `to`.
inline ShareDone part_of(const ShareDone& progress, double from, double to) {
  if (!progress) return {};
  return [progress, from, to](double share) { progress(from + share * (to - from)); };
}

}  // namespace host
