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

/// What a board says of itself and of each of its axes.
struct BoardState : firmware::BoardStatus {
  std::vector<firmware::AxisStatus> axis;
};

/// Newest first.
struct FaultLog {
  double run_h = 0;  ///< that the board has run in all
  std::vector<firmware::LoggedFault> faults;
};

/// Functions throw Failure: no_such_device (board gone), time_out (no answer), protocol (damaged or senseless answer),
/// refused (not in this state), device_fault, bad_input (a value that the board does not take).
class BoardClient {
 public:
  static constexpr std::chrono::milliseconds kPatience{1000};

  /// `patience`: how long an answer may take, as a rule; a board answers within milliseconds.
  explicit BoardClient(std::unique_ptr<ReportLink> link, std::chrono::milliseconds patience = kPatience);

  firmware::IdentityPayload identify();
  BoardState status();
  firmware::TimingPayload timing(bool begin_anew);

  /// Throws Failure(protocol) when the board has another table of parameters than this program.
  void require_same_table();

  /// Says its identity: asked once.
  std::size_t axis_count();

  firmware::ParameterValues read_values(firmware::ValueSet set = firmware::ValueSet::active);
  /// Stages what differs from the active set (or everything), commits, reads back and compares by bits.
  void write_values(const firmware::ParameterValues& values, bool everything = false);
  /// What lies in flash, keys that this program does not know included.
  std::vector<firmware::StoredEntry> read_stored();
  void save();

  void enable(std::uint8_t axes);
  /// False where one of them moves, or its amplifier still reports ready: they stay disabled.
  bool enable_at_rest(std::uint8_t axes);
  void disable(std::uint8_t axes);
  void stop();
  void jog(std::uint8_t axis, double velocity);
  void move(std::uint8_t axis, std::int64_t target_counts);
  void move_by(std::uint8_t axis, std::int64_t counts);
  /// Looks for home; `here`: says that the axis stands there.
  void home(std::uint8_t axis, bool here);
  void clear_faults();
  void heartbeat();
  /// Motion that another program commanded is this one's from now on.
  void take_over();
  void restart();

  void load_excitation(const firmware::ExcitationEntriesRequest& part);
  void start_excitation(const firmware::ExcitationRequest& wanted);
  firmware::ExcitationStatePayload stop_excitation();
  firmware::ExcitationStatePayload excitation_state();

  firmware::OpenPathPayload open_path(const firmware::OpenPathRequest& wanted);
  /// Nodes as they lie in the report; false where the board has no room for them now.
  bool path_nodes(std::span<const std::byte> nodes, firmware::PathStatePayload& state);
  firmware::PathStatePayload start_path();
  firmware::PathStatePayload path_rate(const firmware::PathRateRequest& wanted);
  firmware::PathStatePayload stop_path();
  firmware::PathStatePayload path_state();
  firmware::ProbeStatePayload probe_state();

  void arm_trigger(const firmware::TriggerRequest& wanted);
  firmware::TriggerStatePayload trigger_state();
  /// From this half word on.
  firmware::TriggeredPayload read_triggered(std::uint32_t first);

  void start_capture(const firmware::CaptureRequest& request);
  firmware::CaptureReply stop_capture();
  /// Empty beyond the last row.
  std::optional<firmware::FaultRowPayload> fault_row(std::uint8_t axis, std::uint16_t row);
  /// Empty on a board whose firmware has none.
  FaultLog fault_log();

  /// 0 the program that runs, 1 and 2 the slots of images. Empty on a board that cannot be updated.
  std::optional<firmware::SlotPayload> read_slot(std::uint8_t slot);

  /// The reply to any other request. Throws where its status is not ok.
  firmware::Message exchange(firmware::Message message, std::chrono::milliseconds patience);

  struct Samples {
    std::uint32_t first_row = 0;
    std::vector<std::uint32_t> words;
  };
  std::chrono::milliseconds patience() const { return patience_; }

  /// The board's clock (ReportLink::now): what is waited for on it is waited for with these.
  std::chrono::steady_clock::time_point now() const { return link_->now(); }
  void wait(std::chrono::milliseconds duration) { link_->wait(duration); }

  /// Those that have come, or come within `patience`; empty otherwise.
  std::optional<Samples> next_samples(std::chrono::milliseconds patience);

  std::string name() const { return link_->name(); }
  /// As host::other_users() has it.
  std::string other_users() const;

 private:
  template <typename Payload>
  firmware::Message request(firmware::MessageType type, const Payload& payload);
  firmware::Message request(firmware::MessageType type);
  /// The reply, whatever its status.
  firmware::Message reply_to(firmware::Message message, std::chrono::milliseconds patience);
  std::optional<firmware::Message> receive(std::chrono::steady_clock::time_point deadline);
  void keep_samples(const firmware::Message& message);

  std::unique_ptr<ReportLink> link_;
  std::chrono::milliseconds patience_;
  std::uint16_t client_;  ///< this program among those that talk to the board; never 0
  std::uint8_t pass_;     ///< never comes back from the board, so nobody else learns of it; never 0
  std::uint16_t sequence_ = 0;
  std::size_t axis_count_ = 0;  ///< 0: not asked yet
  std::deque<Samples> samples_;
};

}  // namespace host
