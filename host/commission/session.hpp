// Common to the steps of a commissioning: board, box, folder, dialogue with the user, and motions.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/core/motion/homing.hpp"
#include "host/commission/folder.hpp"
#include "host/device/board_client.hpp"
#include "host/device/excitation.hpp"
#include "host/diagnose/diagnosis.hpp"
#include "host/identify/axis_design.hpp"
#include "host/parameters/board_parameters.hpp"
#include "host/parameters/control_filters.hpp"
#include "host/plan/run_plan.hpp"
#include "host/record/record.hpp"

namespace host {

/// Homing mode of an axis with a switch or an index pulse.
struct CommissionHoming {
  firmware::HomingMode mode = firmware::HomingMode::none;
  double position = 0.0;     ///< position of the home point, mm (m)
  bool is_backward = false;  ///< the switch is on the negative side
};

struct CommissionOptions {
  std::uint8_t axis = 0;
  std::string axis_name;        ///< x, y, …
  sim::DriveDescription sheet;  ///< data sheet; its effects, if any, define only the form of the base model
  /// Travel on both sides of the axis's initial position; volts in open loop, and for planning motions in closed loop;
  /// time of all motion together.
  ExcitationLimits box;
  double bandwidth_Hz = 20.0;  ///< of the closed loop: below the paper's 30 Hz, because delays are not known yet
  double modulus = 0.5;        ///< modulus margin to keep when the bandwidth is raised on the measured response
  std::optional<CommissionHoming> homing = {};  ///< empty: the board's own homing.mode
  /// Amplitude of the process force on the table that the axis has to bear, N; empty: unknown.
  std::optional<double> force_N = {};
  std::optional<double> overtravel = {};  ///< free beyond the box up to the hard stops, mm (m); empty: unknown
  bool save = false;                      ///< save the better parameters in the board's flash
};

/// Dialogue with the user.
struct CommissionTalk {
  std::function<bool(const std::string&)> consents = [](const std::string&) { return true; };
  std::function<bool()> stop = [] { return false; };
  std::function<void(const std::string&)> tell = [](const std::string&) {};
  /// Called before (true) and after (false) work during which the axis is disabled and `stop` is not checked.
  std::function<void(bool)> computes = [](bool) {};
};

/// A motion and the file of its record.
struct CommissionRun {
  std::string file;
  std::string kind;  ///< kind of `axistool excite`
  ExcitationNumbers numbers;
  std::string loop;  ///< "", "reference", "output"
  double time_s = 0.0;
};

/// A controller for a model: design and filters.
struct CommissionLoop {
  AxisDesign design;
  ControlFilterChoice filters;
  std::optional<double> modulus = {};  ///< margin on the measured response
};

/// Result of the diagnosis for the following steps of the same command.
struct CommissionFinding {
  Measurements measured;  ///< the diagnosis refers to these data
  Diagnosis diagnosis;
};

/// Functions throw what BoardClient throws, and Failure(refused) when the user stops.
class CommissionSession {
 public:
  CommissionSession(BoardClient& board, CommissionOptions options, CommissionTalk talk, CommissionFolder& folder);

  BoardClient& board() { return board_; }
  const CommissionOptions& options() const { return options_; }
  const CommissionTalk& talk() const { return talk_; }
  CommissionFolder& folder() { return folder_; }
  std::uint8_t mask() const { return static_cast<std::uint8_t>(1u << options_.axis); }

  /// Throws Failure(refused) if the user declines the motions of this step.
  void ask(const std::string& what);

  /// Makes the motion within the rest of the box, and writes its record even after a failure. An axis in closed loop
  /// first returns to its initial position. Throws Failure(refused), with cause and remedy, for a motion that did not
  /// end by itself.
  Record record(const CommissionRun& run);

  /// The same; empty, with the reason, if the axis stopped with a fault, which is then cleared.
  std::optional<Record> try_record(const CommissionRun& run, std::string& stopped_because);

  /// The same for a planned run.
  Record record_plan(const RunPlan& run, const std::string& file);

  /// Sets the data sheet's scales and control rate on an unfitted axis. Throws Failure(refused) if a fitted axis has
  /// other scales than the data sheet.
  void give_scales();

  /// The board's parameters, replaced by those of a file as far as it contains them.
  firmware::ParameterValues with_file(const std::string& path);
  /// Disables the axis and downloads a set of parameters, unless the board already has it.
  void download(const firmware::ParameterValues& values);
  /// Writes the file of a controller for `model`, and returns its parameters on this board, with the planned limits.
  firmware::ParameterValues design(const sim::DriveDescription& model, const CommissionLoop& loop,
                                   const std::string& file);
  /// A controller of modest bandwidth, because delays and resonances are not known yet.
  CommissionLoop first_loop(const sim::DriveDescription& model) const;
  DesignOptions first_options() const;
  /// The first options with the estimator that was chosen on the machine, if one was.
  DesignOptions tuned_options() const;
  /// The tuned options if the last comparison kept them; otherwise the first options.
  DesignOptions kept_options() const;
  /// Plans limits of motion from `model` and the box and stores them in the folder. They are equal for all sets of
  /// parameters, so that the motions are the same. Throws Failure(refused) if friction needs all of the box's volts.
  void plan_limits(const sim::DriveDescription& model);
  firmware::ParameterValues with_planned_limits(firmware::ParameterValues values) const;

  /// After a fault of an oscillating loop: halves the bandwidth of the next design and slows its estimator. False at
  /// the lowest bandwidth.
  bool calm_down();

  /// Whether this axis has a switch or an index for homing.
  bool can_home();
  bool is_homed();
  /// Enables the axis and homes it. The box stays in place.
  void find_home();

  /// Stops and disables the axis; ignores failures.
  void leave_standing() noexcept;
  void disable();
  /// Clears faults caused by a discarded controller.
  void recover();

  std::shared_ptr<CommissionFinding> found;

  double motion_s() const { return motion_s_; }
  /// The box of a motion of this duration around the command's initial position, to which the axis moves first.
  ExcitationLimits room_for(double time_s, const std::string& what, const firmware::ParameterValues& values);
  ExcitationScale scale(const firmware::ParameterValues& values) const;
  /// Counts the time since `begin` as motion.
  void spend(std::chrono::steady_clock::time_point begin);
  ReferenceLimits limits() const;
  /// Volts that the planned limits leave for the feedback.
  double feedback_V() const { return folder_.document().at("feedback_V"); }
  /// Highest speeds of motions in this box, mm/s (m/s): held for a second; reached briefly.
  double steady_speed() const;
  double top_speed() const;

 private:
  std::int64_t counts();
  void enable();
  void go_back();
  std::vector<CompensationParameter> homing_parameters() const;
  Record keep(const ExcitationOutcome& outcome, const std::map<std::string, std::string>& header,
              const std::string& file);

  BoardClient& board_;
  CommissionOptions options_;
  CommissionTalk talk_;
  CommissionFolder& folder_;
  std::int64_t origin_;  ///< position in counts when the command began
  double motion_s_ = 0.0;
};

/// Marks a computation, for the lifetime of this object: the axis is disabled, and Ctrl-C ends the program.
class Computing {
 public:
  explicit Computing(const CommissionSession& session) : talk_(session.talk()) { talk_.computes(true); }
  ~Computing() { talk_.computes(false); }
  Computing(const Computing&) = delete;
  Computing& operator=(const Computing&) = delete;

 private:
  const CommissionTalk& talk_;
};

}  // namespace host
