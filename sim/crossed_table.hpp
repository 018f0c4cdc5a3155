// The table of two crossed axes, and a ballbar on it. Their errors concern both axes together, so no encoder shows
// them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace sim {

/// Errors of one axis's guideway. The other axis is the one across it.
struct GuidewayErrors {
  double scale_ppm = 0.0;  ///< the travel is longer by this share
  double bow_um = 0.0;     ///< displacement across at 100 mm from the centre: a parabola
  double play_um = 0.0;    ///< lateral play: the carriage leans to one side by half of it, by direction of motion
  double coupling_um_s2_m = 0.0;  ///< displacement across for each m/s^2 of acceleration
};

struct CrossedTableErrors {
  std::array<double, 2> centre_mm{};  ///< of the guideways' bows; the ballbar's pivot is meant to be here
  double squareness_um_m = 0.0;       ///< x moves by this for each metre of y
  std::array<GuidewayErrors, 2> axis{};
};

/// Point of the table, mm.
using TablePoint = std::array<double, 2>;

class CrossedTable {
 public:
  explicit CrossedTable(const CrossedTableErrors& errors) : errors_(errors) {}

  /// Position of the table after the axes have moved to these travels, mm, `period_s` after the last call.
  TablePoint moved_to(const TablePoint& travel_mm, double period_s) {
    if (!has_moved_) seat_ = last_ = before_ = travel_mm;
    has_moved_ = true;
    TablePoint table = travel_mm;
    table[0] += 1e-6 * errors_.squareness_um_m * travel_mm[1];
    for (std::size_t i = 0; i < 2; ++i) {
      const GuidewayErrors& own = errors_.axis[i];
      const double from_centre_mm = travel_mm[i] - errors_.centre_mm[i];
      const double acceleration_mm_s2 = (travel_mm[i] - 2.0 * last_[i] + before_[i]) / (period_s * period_s);
      table[i] += 1e-6 * own.scale_ppm * travel_mm[i];
      table[1 - i] += 1e-3 * own.bow_um * std::pow(from_centre_mm / kBowReach_mm, 2) +
                      1e-3 * own.play_um * lean(i, travel_mm[i]) + 1e-6 * own.coupling_um_s2_m * acceleration_mm_s2;
    }
    before_ = last_;
    last_ = travel_mm;
    return table;
  }

 private:
  static constexpr double kBowReach_mm = 100.0;
  static constexpr double kTakenUp_mm = 0.01;  ///< travel after a reversal in which the carriage leans over

  /// -0.5 to 0.5, by direction of motion.
  double lean(std::size_t i, double travel_mm) {
    const double half_mm = kTakenUp_mm / 2.0;
    if (travel_mm > seat_[i] + half_mm) seat_[i] = travel_mm - half_mm;
    if (travel_mm < seat_[i] - half_mm) seat_[i] = travel_mm + half_mm;
    return (travel_mm - seat_[i]) / kTakenUp_mm;
  }

  CrossedTableErrors errors_;
  TablePoint seat_{}, last_{}, before_{};
  bool has_moved_ = false;
};

/// A ballbar between a pivot and the table: errors of its setting and its own noise.
struct BallbarSetting {
  std::array<double, 2> off_centre_um{};  ///< position of the pivot from the table's centre
  double length_um = 0.0;                 ///< error of its calibrated length
  double noise_um = 0.0;                  ///< standard deviation
};

class Ballbar {
 public:
  Ballbar(const BallbarSetting& setting, const TablePoint& centre_mm, std::uint64_t seed)
      : setting_(setting), centre_mm_(centre_mm), random_(seed) {}

  /// Its length, mm.
  double read(const TablePoint& table_mm) {
    return std::hypot(table_mm[0] - centre_mm_[0] - 1e-3 * setting_.off_centre_um[0],
                      table_mm[1] - centre_mm_[1] - 1e-3 * setting_.off_centre_um[1]) +
           1e-3 * (setting_.length_um + setting_.noise_um * normal_(random_));
  }

 private:
  BallbarSetting setting_;
  TablePoint centre_mm_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_{0.0, 1.0};
};

}  // namespace sim
