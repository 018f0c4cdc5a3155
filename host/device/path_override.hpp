// Overrides of a running path: separate ones for feeds and rapids, as shares of the planned speed.
#pragma once

#include <algorithm>

namespace host {

/// Overrides are at most 100 %, because the plan keeps the axes' limits only at its own speed. A faster feed must be
/// planned beforehand.
class PathOverride {
 public:
  static constexpr int kMost = 1000, kStep = 100, kLeast = 100;  ///< per mille; 0 is a feed hold

  /// + and - change the feeds by a step, > and < the rapids. Any other key changes nothing.
  void press(char key) {
    if (key == '+') change(feed_, kStep);
    if (key == '-') change(feed_, -kStep);
    if (key == '>') change(rapid_, kStep);
    if (key == '<') change(rapid_, -kStep);
  }

  /// Override of the present motion of the path, per mille.
  int permille(bool is_rapid) const { return is_rapid ? rapid_ : feed_; }

 private:
  static void change(int& share, int by) { share = std::clamp(share + by, kLeast, kMost); }

  int feed_ = kMost, rapid_ = kMost;
};

}  // namespace host
