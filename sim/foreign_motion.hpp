// Motion from another source, such as another simulator, in place of the catalogue's drive; converter and sensors stay.
#pragma once

#include <optional>

namespace sim {

/// Sensor readings of such a machine, in the units of its data sheet.
struct ForeignReading {
  double x = 0.0;           ///< position at the encoder, mm or m, before rounding to counts
  std::optional<double> w;  ///< reading of the tachometer, rad/s or m/s; empty without one
};

/// One axis of such a machine.
class ForeignMotion {
 public:
  virtual ~ForeignMotion() = default;

  /// The converter's voltage from now on; empty: the drive is disabled.
  virtual void command(std::optional<double> u_V) = 0;

  /// Advances the machine.
  virtual void advance(double duration_s) = 0;

  virtual ForeignReading reading() const = 0;
};

}  // namespace sim
