// The dynamics of a drive, assembled from its description: from the command voltage to what the sensors would read.
// The same object is the plant of a simulation and the predictor that a record is compared with.
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
  double breakaway = 0.0;  ///< static friction, Nm or N; equals coulomb where there is no Stribeck effect
  double omega1 = 0.0;     ///< fading of the static part, rad/s or m/s; 0 means at once
  double omega2 = 0.0;     ///< rise of the Coulomb part
  double viscous = 0.0;    ///< Nm s/rad or N s/m
};

/// Friction magnitude at a speed and its derivative, Nm and Nm s/rad (or N and N s/m).
struct FrictionPoint {
  double effort;
  double slope;
};

/// The same with rates in place of speeds, for the predictor's innermost loop.
struct SlidingCurve {
  double coulomb, breakaway, viscous;
  double rate1, rate2;  ///< 1/omega, s/rad or s/m; 0 where omega is 0

  /// Eq. (19) without its viscous term, at speed >= 0, with so many times the static friction.
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

/// Everything of the drive that moves or remembers, but for the commands of its dead time. Speeds in rad/s or m/s,
/// travel in mm or m.
struct DriveMotion {
  double x = 0.0;       ///< travel of the motor side
  double w = 0.0;       ///< speed of the motor
  double load_x = 0.0;  ///< travel of the table, where it is a mass of its own
  double load_w = 0.0;
  double bristle = 0.0;         ///< deflection of the contact, rad or m
  double bristle_doubt = 1.0;   ///< its error while following a known motion, over that at rest
  double friction_speed = 0.0;  ///< the speed that the friction remembers
  double rest_s = 0.0;          ///< time at rest
  double restuck = 0.0;         ///< evidence that an unseen stop has taken the rest's gain away, -1..1
  double slide_s = 0.0;         ///< time since the last rest, while following a known motion
  double breakaway_gain = 0.0;  ///< what the last rest added to the static friction, relative
  double effort = 0.0;          ///< what the current loop delivers, Nm or N
  double tach = 0.0;            ///< what the tachometer's filter holds
  double turned_x = 0.0;        ///< where the motion last turned over, mm or m
  double heading = 0.0;         ///< the way it has gone since, +1 or -1; 0 before it has moved
};

struct DriveState : DriveMotion {
  std::array<double, 128> past_u_V{};  ///< commands before the present one, latest first (only kept for a delay)
};

struct RichContact;

class Drive {
 public:
  /// Throws std::invalid_argument for a kind that the catalogue does not hold.
  explicit Drive(const DriveDescription& description);

  /// A state at rest in all that is hidden.
  DriveState at(double x, double w) const;

  /// Advances by `duration_s` with `u_V` held; `t_s` is the time at the start of the interval.
  void step(DriveState& state, double u_V, double t_s, double duration_s) const {
    (this->*step_)(state, u_V, t_s, duration_s);
  }

  /// Lets the hidden states follow a motion that is known, from the state's to (x1, w1). Returns the mean effort that
  /// reaches the drive's inertia before friction is taken off, Nm or N.
  double follow(DriveState& state, double u_V, double x1, double w1, double t_s, double duration_s) const;

  /// Friction of a sliding state, signed like its speed; `effort` is what is transmitted, Nm or N.
  double sliding_effort(DriveState& state, double effort, double t_s) const;

  /// What an ideal encoder reads, with the errors that belong to the drive but without quantisation.
  double encoder(const DriveMotion& motion) const {
    return encoder_error.empty() ? motion.x : motion.x + encoder_error_at(motion.x);
  }

  /// What the encoder's reading adds to the true travel.
  double encoder_error_at(double x) const;

  /// The travel at which the encoder reads `reading`. An error whose slope over the travel reaches 1 has no such
  /// travel; the search then ends after its most steps.
  double travel_at_reading(double reading) const;

  /// Travel of the table: of the load's side, with what the screw adds to it.
  double table(const DriveMotion& motion, double t_s) const {
    const double travel = second_mass ? motion.load_x : motion.x;
    double sum = travel;
    for (const auto& error : table_error) sum += error(t_s, travel);
    return sum;
  }

  /// What the tachometer reads without its noise.
  double tachometer(const DriveMotion& motion) const {
    return tach_gain * motion.tach * (tach_ripple.empty() ? 1.0 : tach_ripple_at(motion.x)) + tach_offset;
  }

  /// The mean effort that the motor is given over an interval with `u_V` held, Nm or N; moves what the command path
  /// remembers (dead time, current loop).
  double deliver_over(DriveState& state, double u_V, double duration_s) const;

  /// How far back a motion still shows in the hidden states, s; 0 where there are none.
  double memory_s() const;
  /// Whether anything but friction adds to or takes from the effort that the command asks for.
  bool shapes_effort() const;
  bool has_second_mass() const { return second_mass.has_value(); }
  /// `friction`, forward and backward, as the motion uses it.
  const std::array<SlidingCurve, 2>& curves() const { return curves_; }

  // The places where an effect can act. Effects fill them; an empty one costs nothing.
  double effort_per_volt = 0.0;
  double lead = 1.0;
  double inertia = 0.0;
  std::array<FrictionSide, 2> friction{};  ///< [0] forward, [1] backward
  std::array<DirectionFactor, 2> direction_factor{};
  std::vector<std::function<double(double u_V)>> command;  ///< converter: volts in, volts out
  double delay_s = 0.0;
  double current_lag_s = 0.0;  ///< time constant of the current loop
  std::vector<std::function<double(double effort, double w)>> effort_limit;
  std::vector<std::function<double(double x)>> effort_factor;             ///< torque constant along the travel
  std::vector<std::function<double(double t_s, double x)>> load_effort;   ///< added to the motor's effort
  std::vector<std::function<double(double t_s, double x)>> level_factor;  ///< on Coulomb and static friction
  std::vector<std::function<double(double t_s)>> viscous_factor;
  /// Further friction of a direction (0 forward, 1 backward) at speed >= 0.
  std::vector<std::function<FrictionPoint(int side, double speed)>> sliding_friction;
  std::vector<std::function<double(double t_s, double x)>> further_level;  ///< of friction, Nm or N
  /// Further friction level by the travel since the last reversal, mm or m.
  std::vector<std::function<double(double travelled)>> friction_after_reversal;
  double transmitted_share = 0.0;  ///< friction per transmitted effort
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
  /// Shortest period over the travel of anything that acts on the motion, mm or m; a step spans a small part of it.
  double finest_period = std::numeric_limits<double>::infinity();

 private:
  using Step = void (Drive::*)(DriveState&, double u_V, double t_s, double duration_s) const;
  enum class Mechanics { one_mass, two_masses, bristles };

  void settle();
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
  void follow_rest(DriveMotion& motion, double w0, double w1, double contact_effort, double duration_s,
                   const RichContact& contact) const;
  void filter_tach(DriveMotion& motion, double w_before, double duration_s) const;
  void note_reversal(DriveMotion& motion, double x, double w) const;
  std::size_t whole_periods_of_delay(double period_s) const;
  void remember_command(DriveState& state, double u_V, std::size_t whole) const;

  Step step_ = nullptr;                   ///< the cheapest that the effects allow
  double mobility_ = 0.0;                 ///< 1/inertia
  std::array<SlidingCurve, 2> curves_{};  ///< of `friction`
  bool straight_command_ = false;         ///< effort in proportion to the command
  bool remembers_ = false;                ///< something but the masses and their contact remembers
  bool bare_ = false;              ///< the command's effort acts alone, and on nothing but masses and their contact
  double parts_per_s_ = 0.0;       ///< that the masses need at least
  double parts_per_travel_ = 0.0;  ///< per mm or m
  std::optional<Coupling> coupling_;
};

}  // namespace sim
