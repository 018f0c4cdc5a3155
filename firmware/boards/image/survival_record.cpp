#include "firmware/boards/image/survival_record.hpp"

#include <span>

#include "firmware/app/crc32.hpp"
#include "firmware/boards/image/fault_handler.hpp"

namespace firmware::boards {

namespace {

constexpr std::uint32_t kMagic = 0x53555256;  // "SURV"

// Uninitialised on purpose: the type's initialisers would need start-up to write it.
alignas(SurvivalRecord) [[gnu::section(".noinit")]] std::byte storage[sizeof(SurvivalRecord)];

bool fault_is_intact(const SurvivalRecord& record) {
  return record.fault_crc == crc32(std::as_bytes(std::span(&record.fault, 1)));
}

}  // namespace

SurvivalRecord& survival_record() { return *reinterpret_cast<SurvivalRecord*>(storage); }

void seal_fault() {
  SurvivalRecord& record = survival_record();
  record.fault_crc = crc32(std::as_bytes(std::span(&record.fault, 1)));
  record.ended_by_fault = 1;
}

LastRun take_over_survival_record(ResetCause hardware_cause) {
  SurvivalRecord& record = survival_record();
  LastRun last_run;
  last_run.survived = record.magic == kMagic && hardware_cause != ResetCause::power_on;
  last_run.cause = hardware_cause;
  if (last_run.survived) {
    last_run.resets = record.resets + 1;
    last_run.last = record.running;
    if (record.ended_by_fault == 1 && fault_is_intact(record)) {
      last_run.cause = ResetCause::fault;
      last_run.fault = record.fault;
    } else if (record.reset_requested == 1) {
      last_run.cause = ResetCause::software;
    } else if (hardware_cause == ResetCause::unknown) {
      last_run.cause = record.watchdog_armed == 1 ? ResetCause::watchdog : ResetCause::reset_pin;
    }
  } else if (hardware_cause == ResetCause::unknown) {
    last_run.cause = ResetCause::power_on;
  }
  record = SurvivalRecord{};
  record.magic = kMagic;
  record.resets = last_run.resets;
  return last_run;
}

}  // namespace firmware::boards
