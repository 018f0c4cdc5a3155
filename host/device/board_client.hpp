// The host's end of the protocol (firmware/app/protocol/README.md).
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware/app/parameters/parameter_values.hpp"
#include "firmware/app/protocol/excitation_messages.hpp"
#include "firmware/app/protocol/fault_log_messages.hpp"
#include "firmware/app/protocol/path_messages.hpp"
#include "firmware/app/protocol/report.hpp"
#include "firmware/app/protocol/trigger_messages.hpp"
#include "firmware/app/protocol/update_messages.hpp"
#include "firmware/app/store/stored_set.hpp"
#include "host/link/report_link.hpp"

namespace host {

/// A board's description of itself and of each of its axes.
struct BoardState : firmware::BoardStatus {
  std::vector<firmware::AxisStatus> axis;
};

/// Newest first.
struct FaultLog {
  double run_h = 0;  ///< total running time of the board
  std::vector<firmware::LoggedFault> faults;
};

/// Functions throw Failure: no_such_device (board gone), time_out (no answer), protocol (damaged or impossible answer),
/// refused (not in this state), device_fault, bad_input (a value that the board does not accept).
class BoardClient {
 public:
  static constexpr std::chrono::milliseconds kPatience{1000};

  /// `patience`: time-out for most answers; a board usually answers within milliseconds.
  explicit BoardClient(std::unique_ptr<ReportLink> link, std::chrono::milliseconds patience = kPatience);

  firmware::IdentityPayload identify();
  BoardState status();
  firmware::TimingPayload timing(bool begin_anew);

  /// Throws Failure(protocol) if the board's table of parameters differs from this program's.
  void require_same_table();

  /// The board's identity, requested once.
  std::size_t axis_count();

  firmware::ParameterValues read_values(firmware::ValueSet set = firmware::ValueSet::active);
  /// Stages the values that differ from the active set (or all), commits, reads back and compares bit by bit.
  void write_values(const firmware::ParameterValues& values, bool everything = false);
  /// The values in flash, including keys that this program does not know.
  std::vector<firmware::StoredEntry> read_stored();
  void save();

  void enable(std::uint8_t axes);
  /// False if an axis moves or its amplifier still reports ready; then all axes stay disabled.
  bool enable_at_rest(std::uint8_t axes);
  void disable(std::uint8_t axes);
  void stop();
  void jog(std::uint8_t axis, double velocity);
  void move(std::uint8_t axis, std::int64_t target_counts);
  void move_by(std::uint8_t axis, std::int64_t counts);
  /// Homes the axis; `here`: without motion, the present position becomes home.
  void home(std::uint8_t axis, bool here);
  void clear_faults();
  void heartbeat();
  /// Takes control of motion that another program commanded.
  void take_over();
  void restart();

  void load_excitation(const firmware::ExcitationEntriesRequest& part);
  void start_excitation(const firmware::ExcitationRequest& wanted);
  firmware::ExcitationStatePayload stop_excitation();
  firmware::ExcitationStatePayload excitation_state();

  firmware::OpenPathPayload open_path(const firmware::OpenPathRequest& wanted);
  /// Sends nodes in the format of the report; false if the board has no room for them now.
  bool path_nodes(std::span<const std::byte> nodes, firmware::PathStatePayload& state);
  firmware::PathStatePayload start_path();
  firmware::PathStatePayload path_rate(const firmware::PathRateRequest& wanted);
  firmware::PathStatePayload stop_path();
  firmware::PathStatePayload path_state();
  firmware::ProbeStatePayload probe_state();

  void arm_trigger(const firmware::TriggerRequest& wanted);
  firmware::TriggerStatePayload trigger_state();
  /// Reads the triggered capture from the half word `first` on.
  firmware::TriggeredPayload read_triggered(std::uint32_t first);

  void start_capture(const firmware::CaptureRequest& request);
  /// The same; a workbench that streams this board's channels ends its stream for it (CaptureWish).
  void take_capture(const firmware::CaptureRequest& request);
  firmware::CaptureReply stop_capture();
  /// Empty beyond the last row.
  std::optional<firmware::FaultRowPayload> fault_row(std::uint8_t axis, std::uint16_t row);
  /// Empty on a board whose firmware has no fault log.
  FaultLog fault_log();

  /// 0: the running program; 1 and 2: the slots of images. Empty on a board that cannot be updated.
  std::optional<firmware::SlotPayload> read_slot(std::uint8_t slot);

  /// The reply to any other request. Throws if its status is not ok.
  firmware::Message exchange(firmware::Message message, std::chrono::milliseconds patience);

  struct Samples {
    std::uint32_t first_row = 0;
    std::vector<std::uint32_t> words;
  };
  std::chrono::milliseconds patience() const { return patience_; }

  /// The board's clock (ReportLink::now); time-outs of the board's actions use these functions.
  std::chrono::steady_clock::time_point now() const { return link_->now(); }
  void wait(std::chrono::milliseconds duration) { link_->wait(duration); }

  /// Samples that have arrived, or arrive within `patience`; otherwise empty.
  std::optional<Samples> next_samples(std::chrono::milliseconds patience);

  std::string name() const { return link_->name(); }
  /// The text of host::other_users() for this board.
  std::string other_users() const;

 private:
  template <typename Payload>
  firmware::Message request(firmware::MessageType type, const Payload& payload);
  firmware::Message request(firmware::MessageType type);
  /// The reply, whatever its status.
  firmware::Message reply_to(firmware::Message message, std::chrono::milliseconds patience);
  /// Throws Failure if the board refuses; names the programs that control the motion.
  void require_accepted(const firmware::Message& reply) const;
  std::optional<firmware::Message> receive(std::chrono::steady_clock::time_point deadline);
  void keep_samples(const firmware::Message& message);

  std::unique_ptr<ReportLink> link_;
  std::chrono::milliseconds patience_;
  std::uint16_t client_;  ///< identifies this program among those that talk to the board; never 0
  std::uint8_t pass_;     ///< never sent by the board, so other programs cannot learn it; never 0
  std::uint16_t sequence_ = 0;
  std::size_t axis_count_ = 0;  ///< 0: not requested yet
  std::deque<Samples> samples_;
};

}  // namespace host
