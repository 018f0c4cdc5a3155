// Overrides of a path that runs: feeds and rapids apart, as shares of what was planned.
#pragma once

#include <algorithm>

namespace host {

/// The plan holds the limits at its own speed, so nothing here is faster: a feed above 100 % is planned so beforehand.
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

  /// For the motion that the path is in, per mille.
  int permille(bool is_rapid) const { return is_rapid ? rapid_ : feed_; }

 private:
  static void change(int& share, int by) { share = std::clamp(share + by, kLeast, kMost); }

  int feed_ = kMost, rapid_ = kMost;
};

}  // namespace host
