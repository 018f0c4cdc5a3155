// A board's background: protocol, supervision, service port. Nothing here waits, so the watchdog is fed in time.
#include <optional>

#include "firmware/app/protocol/server.hpp"
#include "firmware/boards/image/boot_report.hpp"
#include "firmware/boards/image/fault_handler.hpp"
#include "firmware/boards/image/reset_entry.hpp"
#include "firmware/boards/image/stack_use.hpp"
#include "firmware/boards/program/application.hpp"

namespace firmware::boards {

namespace {

std::optional<ProtocolServer<Application>> server;  ///< not on the stack, which is short

/// Shows the state of the axes; only the control interrupt acts on them.
void supervise() {
  bool fault = board.emergency_stop().is_pressed() || !application.store_is_usable();
  for (std::size_t i = 0; i < Application::kAxes; ++i)
    fault = fault || application.axes()[i].fault() != AxisFault::none;
  board.show(true, fault);
  board.watch(!application.any_enabled());
  liveness.supervisor_ran();
}

/// Letters on the service port: 'r' repeats the boot report, 'u' prints the use of stack and time. The answer to an
/// earlier letter is sent first.
void serve(const LastRun& last_run, ImageState image) {
  board.serial().poll();
  std::byte letter{};
  if (!board.serial().is_empty() || !board.serial().receive(letter)) return;
  TextWriter out(board.serial());
  switch (static_cast<char>(letter)) {
    case 'r':
      report_boot(board.serial(), last_run, image);
      board.report(out);
      break;
    case 'u':
      out << "stack: used " << stack_used_bytes() << " of " << stack_size_bytes() << " bytes, control periods "
          << liveness.control_periods() << "\ncontrol: cycles " << control_cycles.average() << " on average, "
          << control_cycles.worst() << " at worst\n";
      board.report(out);
      break;
    default:
      out << "r report, u use of stack and time\n";
  }
}

/// For a board that must not control: outputs stay safe, and the service port gives the reason.
[[noreturn]] void stay_safe(const LastRun& last_run, ImageState image) {
  make_outputs_safe();
  for (;;) serve(last_run, image);
}

}  // namespace

}  // namespace firmware::boards

extern "C" void usb_interrupt() { firmware::boards::board.usb().handle_interrupt(); }

extern "C" [[noreturn]] void run_board() {
  using namespace firmware::boards;
  const bool periphery_works = board.start();
  const LastRun last_run = take_over_survival_record(read_reset_cause());
  arm_fault_detection();
  control_cycles.start();
  using firmware::ImageState;
  const ImageState image = verify_this_image();
  report_boot(board.serial(), last_run, image);
  TextWriter out(board.serial());
  board.report(out);
  if (!periphery_works) out << "periphery: the clock or the D/A converter does not start\n";
  if (!periphery_works || image != ImageState::whole) stay_safe(last_run, image);
  survival_record().watchdog_armed = 1;
  application.start();
  if (const auto ended = entry_of(last_run)) application.log_end_of_last_run(*ended);
  const firmware::BootFacts boot{static_cast<std::uint8_t>(last_run.cause), static_cast<std::uint16_t>(last_run.resets),
                                 Board::kIsSimulated, board.lacks_brown_out_reset()};
  server.emplace(application, this_image(), boot);
  if (!board.start_usb()) out << "periphery: the USB controller does not answer\n";
  board.start_control();
  board.start_watchdogs();
  for (;;) {
    supervise();
    if (liveness.may_feed()) board.feed_watchdog();
    board.usb().poll();
    server->poll(board.usb(), {stack_used_bytes(), stack_size_bytes(), control_cycles.average(), control_cycles.worst(),
                               board.processor_Hz()});
    serve(last_run, image);
  }
}
