// A board's report at start: its image, whether the image is intact, and why the last run ended.
#pragma once

#include "firmware/boards/image/survival_record.hpp"
#include "firmware/boards/image/text_writer.hpp"
#include "firmware/boards/image/this_image.hpp"

namespace firmware::boards {

constexpr const char* name_of(ResetCause cause) {
  switch (cause) {
    case ResetCause::power_on:
      return "power on";
    case ResetCause::reset_pin:
      return "reset pin";
    case ResetCause::software:
      return "software";
    case ResetCause::watchdog:
      return "watchdog";
    case ResetCause::fault:
      return "fault";
    case ResetCause::brown_out:
      return "brown-out";
    case ResetCause::unknown:
      break;
  }
  return "unknown";
}

constexpr const char* name_of(FaultKind kind) {
  switch (kind) {
    case FaultKind::nmi:
      return "non-maskable interrupt";
    case FaultKind::hard_fault:
      return "hard fault";
    case FaultKind::mem_manage:
      return "memory protection fault";
    case FaultKind::bus_fault:
      return "bus fault";
    case FaultKind::usage_fault:
      return "usage fault";
    case FaultKind::none:
      break;
  }
  return "none";
}

constexpr const char* name_of(ImageState state) {
  switch (state) {
    case ImageState::whole:
      return "whole";
    case ImageState::no_header:
      return "no header";
    case ImageState::wrong_size:
      return "wrong size";
    case ImageState::wrong_crc:
      break;
  }
  return "wrong CRC";
}

template <hal::SerialPort Port>
void report_last_state(TextWriter<Port>& out, const LastState& last) {
  out << "last: control periods " << last.control_periods << ", supervisor rounds " << last.supervisor_rounds << "\n";
  for (std::uint32_t axis = 0; axis < last.axis.size(); ++axis) {
    const LastAxisState& state = last.axis[axis];
    out << "last: axis " << axis << " counts " << static_cast<std::int32_t>(state.encoder_counts) << ", dac "
        << state.dac_code << ", enabled " << state.enabled << ", fault " << state.fault << "\n";
  }
}

template <hal::SerialPort Port>
void report_fault(TextWriter<Port>& out, const FaultRecord& fault) {
  out << "fault: " << name_of(fault.kind);
  if (fault.unexpected_interrupt != 0) out << ", unexpected exception " << fault.unexpected_interrupt;
  if (fault.stack_overflow != 0) out << ", stack overflow";
  (out << "\nfault: outputs made safe " << fault.outputs_made_safe << "\nfault: pc ").hex(fault.pc);
  (out << " lr ").hex(fault.lr);
  (out << " sp ").hex(fault.sp);
  (out << " xpsr ").hex(fault.xpsr) << (fault.frame_valid != 0 ? "\n" : " (no room for the frame)\n");
  (out << "fault: cfsr ").hex(fault.cfsr);
  (out << " hfsr ").hex(fault.hfsr);
  (out << " mmfar ").hex(fault.mmfar);
  (out << " bfar ").hex(fault.bfar) << "\nfault:";
  for (const std::uint32_t value : fault.r) (out << " ").hex(value);
  out << "\n";
  report_last_state(out, fault.last);
}

template <hal::SerialPort Port>
void report_boot(Port& port, const LastRun& last_run, ImageState image) {
  TextWriter out(port);
  const ImageHeader& header = this_image();
  out << "axis board " << header.board.data() << ", version " << header.version.data() << ", " << header.git_hash.data()
      << "\n";
  (out << "image: " << name_of(image) << ", " << header.image_size << " bytes, crc ").hex(header.crc) << "\n";
  out << "reset: " << name_of(last_run.cause) << ", resets since power on " << last_run.resets << "\n";
  if (last_run.cause == ResetCause::fault) report_fault(out, last_run.fault);
  if (last_run.cause == ResetCause::watchdog) report_last_state(out, last_run.last);
}

}  // namespace firmware::boards
