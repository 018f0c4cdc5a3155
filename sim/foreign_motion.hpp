// Motion that something other than the catalogue makes, another simulator say, behind the same converter and sensors.
#pragma once

#include <optional>

namespace sim {

/// What the sensors of such a machine see, in the units of its data sheet.
struct ForeignReading {
  double x = 0.0;           ///< position at the encoder, mm or m, before it is counted
  std::optional<double> w;  ///< what the tachometer shows, rad/s or m/s; empty where there is none
};

/// One axis of it.
class ForeignMotion {
 public:
  virtual ~ForeignMotion() = default;

  /// The converter's voltage from now on; empty: the drive is disabled.
  virtual void command(std::optional<double> u_V) = 0;

  /// Lets the machine run.
  virtual void advance(double duration_s) = 0;

  virtual ForeignReading reading() const = 0;
};

}  // namespace sim
