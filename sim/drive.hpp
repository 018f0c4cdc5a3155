// The dynamics of a drive, assembled from its description: from the command voltage to the sensor readings. The same
// object is the plant of a simulation and the predictor for recorded data.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "sim/coupling.hpp"
#include "sim/drive_description.hpp"

namespace sim {

/// Friction of one direction of motion, eq. (19): magnitudes, all >= 0.
struct FrictionSide {
  double coulomb = 0.0;    ///< Nm or N
  double breakaway = 0.0;  ///< static friction, Nm or N; equals coulomb without a Stribeck effect
  double omega1 = 0.0;     ///< fading of the static part, rad/s or m/s; 0 means at once
  double omega2 = 0.0;     ///< rise of the Coulomb part
  double viscous = 0.0;    ///< Nm s/rad or N s/m
};

/// Friction magnitude at a speed and its derivative, Nm and Nm s/rad (or N and N s/m).
struct FrictionPoint {
  double effort;
  double slope;
};

/// FrictionSide with reciprocal speeds, for the predictor's innermost loop.
struct SlidingCurve {
  double coulomb, breakaway, viscous;
  double rate1, rate2;  ///< 1/omega, s/rad or s/m; 0 if omega is 0

  /// Eq. (19) without its viscous term, at speed >= 0, with static friction times `breakaway_factor`.
  FrictionPoint dry(double speed, double breakaway_factor = 1.0) const;
};

/// Factor of an asymmetry on the friction of one direction.
struct DirectionFactor {
  double level = 1.0;
  double viscous = 1.0;
};

/// Elastic bristles in the contact (LuGre): effort = sigma0 z + sigma1 dz/dt.
struct Bristles {
  double stiffness = 0.0;  ///< sigma0, Nm/rad or N/m
  double damping = 0.0;    ///< sigma1, Nm s/rad or N s/m
};

/// State of the drive, except for the delayed commands. Speeds in rad/s or m/s, travel in mm or m.
struct DriveMotion {
  double x = 0.0;       ///< travel of the motor side
  double w = 0.0;       ///< speed of the motor
  double load_x = 0.0;  ///< travel of the table, if it is a mass of its own
  double load_w = 0.0;
  double bristle = 0.0;         ///< deflection of the contact, rad or m
  double bristle_doubt = 1.0;   ///< its error while following a known motion, relative to that at rest
  double friction_speed = 0.0;  ///< lagged speed, for friction_lag
  double rest_s = 0.0;          ///< time at rest
  double restuck = 0.0;         ///< evidence that an undetected stop has reset breakaway_gain, -1..1
  double slide_s = 0.0;         ///< time since the last rest, while following a known motion
  double breakaway_gain = 0.0;  ///< relative increase of static friction by the last rest
  double seen_w = 0.0;          ///< measured speed at the last sample, while following a known motion
  double effort = 0.0;          ///< output of the current loop, Nm or N
  double tach = 0.0;            ///< state of the tachometer's filter
  double turned_x = 0.0;        ///< travel at the last reversal, mm or m
  double heading = 0.0;         ///< direction since then, +1 or -1; 0 before the first motion
};

struct DriveState : DriveMotion {
  std::array<double, 128> past_u_V{};  ///< commands before the present one, latest first (only kept for a delay)
};

struct RichContact;

class Drive {
 public:
  /// Throws std::invalid_argument for a kind that the catalogue does not hold.
  explicit Drive(const DriveDescription& description);

  /// A state with this travel and speed, and all hidden states at rest.
  DriveState at(double x, double w) const;

  /// Advances by `duration_s` with `u_V` held; `t_s` is the time at the start of the interval.
  void step(DriveState& state, double u_V, double t_s, double duration_s) const {
    (this->*step_)(state, u_V, t_s, duration_s);
  }

  /// Lets the hidden states follow a known motion from the present state to (x1, w1). Returns the mean torque or force
  /// on the drive's inertia before friction is subtracted, Nm or N.
  double follow(DriveState& state, double u_V, double x1, double w1, double t_s, double duration_s) const;

  /// Rest after which static friction holds the standing drive under this torque or force, Nm or N: 0 s if it does at
  /// once, HUGE_VAL if only after a long rest or never.
  double rest_to_hold(DriveState state, double effort, double t_s) const;

  /// Static friction of a standing state against this torque or force, >= 0, Nm or N.
  double breakaway_effort(DriveState& state, double effort, double t_s) const;

  /// Friction of a sliding state, signed like its speed; `effort`: transmitted torque or force, Nm or N.
  double sliding_effort(DriveState& state, double effort, double t_s) const;

  /// Encoder reading with the drive's encoder errors, but without quantisation.
  double encoder(const DriveMotion& motion) const {
    return encoder_error.empty() ? motion.x : motion.x + encoder_error_at(motion.x);
  }

  /// Encoder reading minus true travel.
  double encoder_error_at(double x) const;

  /// The travel at which the encoder reads `reading`. There may be no such travel if the slope of the error reaches 1;
  /// the search then ends after its largest number of steps.
  double travel_at_reading(double reading) const;

  /// Travel of the table: travel of the load's side plus the screw's error.
  double table(const DriveMotion& motion, double t_s) const {
    const double travel = second_mass ? motion.load_x : motion.x;
    double sum = travel;
    for (const auto& error : table_error) sum += error(t_s, travel);
    return sum;
  }

  /// Tachometer reading without noise.
  double tachometer(const DriveMotion& motion) const {
    return tach_gain * motion.tach * (tach_ripple.empty() ? 1.0 : tach_ripple_at(motion.x)) + tach_offset;
  }

  /// The motor's effort with the efforts of all loads, at this speed, Nm or N.
  double with_loads(double motor, double w, double t_s, double x) const {
    for (const auto& load : load_effort) motor += load(t_s, x);
    return effort_behind_screw.empty() ? motor : with_effort_behind_screw(motor, w, t_s);
  }

  /// Mean torque or force of the motor over an interval with `u_V` held, Nm or N; advances the states of the command
  /// path (dead time, current loop).
  double deliver_over(DriveState& state, double u_V, double duration_s) const;

  /// Time for which the hidden states depend on an earlier motion, s; 0 if there are no hidden states.
  double memory_s() const;
  /// Whether anything but friction changes the torque or force that is proportional to the command.
  bool shapes_effort() const;
  bool has_second_mass() const { return second_mass.has_value(); }
  /// `friction`, forward and backward, in the form for the innermost loop.
  const std::array<SlidingCurve, 2>& curves() const { return curves_; }

  // The places where an effect can act. Effects fill them; an empty one takes no time.
  double effort_per_volt = 0.0;
  double lead = 1.0;
  double inertia = 0.0;
  std::array<FrictionSide, 2> friction{};  ///< [0] forward, [1] backward
  std::array<DirectionFactor, 2> direction_factor{};
  std::vector<std::function<double(double u_V)>> command;  ///< converter: volts in, volts out
  double delay_s = 0.0;
  double current_lag_s = 0.0;  ///< time constant of the current loop
  std::vector<std::function<double(double effort, double w)>> effort_limit;
  std::vector<std::function<double(double x)>> effort_factor;            ///< torque constant along the travel
  std::vector<std::function<double(double t_s, double x)>> load_effort;  ///< added to the motor's effort
  /// Effort on the table behind a self-locking screw: added while the axis moves. At rest it only takes from the
  /// motor's effort (paper, p. 1494).
  std::vector<std::function<double(double t_s)>> effort_behind_screw;
  std::vector<std::function<double(double t_s, double x)>> level_factor;  ///< on Coulomb and static friction
  std::vector<std::function<double(double t_s)>> viscous_factor;
  /// Further friction of a direction (0 forward, 1 backward) at speed >= 0.
  std::vector<std::function<FrictionPoint(int side, double speed)>> sliding_friction;
  std::vector<std::function<double(double t_s, double x)>> further_level;  ///< of friction, Nm or N
  /// Further friction level by the travel since the last reversal, mm or m.
  std::vector<std::function<double(double travelled)>> friction_after_reversal;
  double transmitted_share = 0.0;  ///< friction per transmitted torque or force
  double friction_memory_s = 0.0;
  double dwell_gain = 0.0;
  double dwell_time_s = 0.0;
  std::optional<Bristles> bristles;
  std::optional<SecondMass> second_mass;
  std::vector<std::function<double(double x)>> encoder_error;
  std::vector<std::function<double(double t_s, double x)>> table_error;  ///< added to the table's travel, mm or m
  double tach_gain = 1.0;
  double tach_offset = 0.0;
  double tach_lag_s = 0.0;
  std::vector<std::function<double(double x)>> tach_ripple;  ///< relative

  /// Longest step of the integrator inside a sample, s; the constructor derives it from the drive's fastest mode.
  double max_step_s = 0.0;
  /// Shortest period over the travel among the effects on the motion, mm or m; a step spans a small part of it.
  double finest_period = std::numeric_limits<double>::infinity();

 private:
  using Step = void (Drive::*)(DriveState&, double u_V, double t_s, double duration_s) const;
  enum class Mechanics { one_mass, two_masses, bristles };

  void settle();
  double behind_screw(double t_s) const;
  double with_effort_behind_screw(double effort, double w, double t_s) const;
  double tach_ripple_at(double x) const;
  double command_effort(double u_V, double w) const;
  double deliver(DriveMotion& motion, double u_V, double w, double duration_s) const;
  int parts_of(double duration_s, double w) const;
  template <typename Contact>
  Step cheapest_step() const;
  template <Mechanics kMechanics, typename Contact>
  Step cheapest_step_of() const;
  template <Mechanics kMechanics, typename Contact>
  void directly(DriveState& state, double u_V, double t_s, double duration_s) const;
  template <Mechanics kMechanics, typename Contact>
  void delay(DriveState& state, double u_V, double t_s, double duration_s) const;
  template <Mechanics kMechanics, typename Contact>
  void hold(DriveState& state, double u_V, double t_s, double duration_s) const;
  template <Mechanics kMechanics, typename Contact>
  void push(DriveMotion& motion, double effort, double t_s, double duration_s) const;
  template <Mechanics kMechanics, typename Contact>
  void move(DriveMotion& motion, double effort, double t_s, double duration_s) const;
  template <Mechanics kMechanics, typename Contact>
  void move_masses(DriveMotion& motion, double effort, double duration_s, int parts, Contact& contact) const;
  template <Mechanics kMechanics, typename Contact>
  double limiting_speed(const DriveMotion& motion, double u_V, double t_s, double duration_s) const;
  void observe(DriveState& state, double u_V, double x1, double t_s, double duration_s) const;
  /// Rest and breakaway of two masses along the measured motion. `before`: state before observe(); `w1`: measured
  /// speed, exactly 0 at rest.
  void follow_rest_of_two(DriveState& state, const DriveMotion& before, double u_V, double w1, double t_s,
                          double duration_s) const;
  void follow_rest(DriveMotion& motion, double w0, double w1, double contact_effort, double duration_s,
                   const RichContact& contact) const;
  void filter_tach(DriveMotion& motion, double w_before, double duration_s) const;
  void note_reversal(DriveMotion& motion, double x, double w) const;
  std::size_t whole_periods_of_delay(double period_s) const;
  void remember_command(DriveState& state, double u_V, std::size_t whole) const;

  Step step_ = nullptr;                   ///< the fastest step function that the effects allow
  double mobility_ = 0.0;                 ///< 1/inertia
  std::array<SlidingCurve, 2> curves_{};  ///< of `friction`
  bool straight_command_ = false;         ///< torque or force is proportional to the command
  bool remembers_ = false;                ///< there are states besides those of the masses and their contact
  bool bare_ = false;  ///< only the command's torque or force acts, and only masses and their contact have states
  double parts_per_s_ = 0.0;       ///< smallest number of parts for the masses
  double parts_per_travel_ = 0.0;  ///< per mm or m
  std::optional<Coupling> coupling_;
};

}  // namespace sim
