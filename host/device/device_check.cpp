#include "host/device/device_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "firmware/core/supervision/fault_table.hpp"
#include "host/device/board_report.hpp"
#include "host/link/usb_polling.hpp"

namespace host {

namespace {

using Clock = std::chrono::steady_clock;

class Examination {
 public:
  explicit Examination(BoardClient& board) : board_(board) {}

  std::vector<DeviceCheck> run() {
    board_.timing(true);
    const firmware::IdentityPayload identity = board_.identify();
    table(identity);
    const BoardState status = board_.status();
    store(status);
    reset(status);
    brown_out(status);
    faults(status);
    exchange();
    stream();
    loop();
    return std::move(list_);
  }

 private:
  void add(bool is_good, CheckResult otherwise, std::string what, std::string found, std::string remedy) {
    list_.push_back(
        {is_good ? CheckResult::good : otherwise, std::move(what), std::move(found), is_good ? "" : std::move(remedy)});
  }

  void table(const firmware::IdentityPayload& identity) {
    same_table_ = identity.schema_hash == firmware::kSchemaHash;
    add(same_table_, CheckResult::bad, "parameter table",
        fmt::format("board {:#010x}, axistool {:#010x}", identity.schema_hash, firmware::kSchemaHash),
        "use the axistool that was built with the firmware, or flash this one's: `axistool flash`");
  }

  void store(const BoardState& status) {
    const auto problem = store_problem(status);
    add(!problem, CheckResult::bad, "saved parameters", store_text(status.store_state), problem.value_or(""));
    add((status.flags & firmware::kBoardUnsaved) == 0, CheckResult::attention, "unsaved changes",
        (status.flags & firmware::kBoardUnsaved) == 0 ? "none" : "the board would forget them at power-off",
        "`axistool save` keeps them");
    constexpr std::uint32_t kEndurance = 2 * 10'000;  // erases of both sectors, STM32F405 datasheet, table 42
    add(status.store_erases < kEndurance / 2, CheckResult::attention, "flash wear",
        fmt::format("{} of some {} erases", status.store_erases, kEndurance),
        "save less often: no program should save by itself");
  }

  void reset(const BoardState& status) {
    const std::string cause = reset_text(status.reset_cause);
    const bool is_bad = cause == "watchdog" || cause == "fault" || cause == "brown-out";
    add(!is_bad, CheckResult::attention, "last reset", fmt::format("{}, {} since power on", cause, status.resets),
        cause == "brown-out" ? "check the supply of the board"
                             : "the service port (115200 baud) prints registers and address of the fault: report them");
  }

  void brown_out(const BoardState& status) {
    const bool is_off = (status.flags & firmware::kBoardBrownOutOff) != 0;
    add(!is_off, CheckResult::bad, "brown-out reset", is_off ? "off" : "set", brown_out_problem());
  }

  void faults(const BoardState& status) {
    for (std::size_t axis = 0; axis < status.axis.size(); ++axis) {
      const auto& fault = firmware::fault_info(static_cast<firmware::AxisFault>(status.axis[axis].fault));
      add(status.axis[axis].fault == 0, CheckResult::bad, fmt::format("axis {}", firmware::kAxisNames[axis]),
          status.axis[axis].fault == 0 ? state_text(status.axis[axis]) : fmt::format("fault: {}", fault.cause),
          std::string(fault.remedy));
    }
  }

  /// Measures the exchange time: 2 or 3 ms for a full-speed endpoint polled every millisecond.
  void exchange() {
    constexpr int kExchanges = 100;
    std::vector<double> times;
    for (int i = 0; i < kExchanges; ++i) {
      const auto begin = Clock::now();
      board_.heartbeat();
      times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    }
    std::ranges::sort(times);
    const double median = times[times.size() / 2];
    add(median < 5.0, CheckResult::attention, "exchange",
        fmt::format("median {:.2f} ms, worst {:.2f} ms", median, times.back()),
        "above 5 ms the endpoint is polled too rarely: use a port of the computer itself, not a hub, and another "
        "cable");
  }

  void stream() {
    constexpr std::uint16_t kFour = 0xF;
    board_.start_capture({{kFour}, 1, 0});
    const auto begin = board_.now();
    std::uint32_t next_row = 0, lost = 0;
    const auto take = [&](const BoardClient::Samples& samples) {
      lost += samples.first_row - next_row;
      next_row = samples.first_row + static_cast<std::uint32_t>(samples.words.size() / 4);
    };
    while (board_.now() - begin < std::chrono::seconds(1))
      if (const auto samples = board_.next_samples(std::chrono::milliseconds(20))) take(*samples);
    const std::uint32_t taken = board_.stop_capture().rows;
    while (const auto samples = board_.next_samples(std::chrono::milliseconds(50))) take(*samples);
    lost += taken - std::min(next_row, taken);
    add(lost == 0, CheckResult::bad, "samples", fmt::format("{} rows in a second, {} lost", taken, lost),
        "close programs that load the computer; use a port of the computer itself");
  }

  void loop() {
    const firmware::TimingPayload timing = board_.timing(false);
    const double period_us =
        same_table_ ? 1e6 / board_.read_values().get<"control.rate">() : static_cast<double>(timing.shortest_us);
    add(timing.longest_us < 1.5 * period_us && timing.periods > 1, CheckResult::bad, "control periods",
        fmt::format("{} to {} us of {:.0f}, work up to {} us", timing.shortest_us, timing.longest_us, period_us,
                    timing.busiest_us),
        "lower control.rate; on a simulated board: the computer is too busy");
    for (std::size_t axis = 0; axis < board_.axis_count(); ++axis) {
      const bool is_taken_back = (timing.friction_taken_back >> axis & 1u) != 0;
      add(!is_taken_back, CheckResult::attention,
          fmt::format("friction feed-forward of {}", firmware::kAxisNames[axis]),
          is_taken_back ? "taken back: the axis followed worse with it" : "as set",
          "friction has changed: identify it anew (`axistool friction`), then `design` and `set-params`");
    }
    add(timing.rejected_reports == 0, CheckResult::attention, "damaged reports",
        fmt::format("{} of {}", timing.rejected_reports, timing.reports), "another cable, away from the motor's");
    if (timing.stack_size > 0)
      add(timing.stack_used * 4 < timing.stack_size * 3, CheckResult::attention, "stack of the board",
          fmt::format("{} of {} bytes", timing.stack_used, timing.stack_size), "report this");
  }

  BoardClient& board_;
  bool same_table_ = false;
  std::vector<DeviceCheck> list_;
};

}  // namespace

DeviceCheck check_opening() {
  if (usb_polls_always()) return {CheckResult::good, "opening", "at once: Linux polls boards permanently", ""};
  return {CheckResult::attention, "opening", "each command waits 50 ms before it may talk to the board over hidraw",
          "`sudo axistool udev-rule --poll-always --install`, then restart the computer"};
}

std::vector<DeviceCheck> check_device(BoardClient& board) { return Examination(board).run(); }

}  // namespace host
