// Lines of the fault log: faults of axes, and programs that ended by the watchdog or a processor fault.
#include "host/device/fault_log.hpp"

#include <gtest/gtest.h>

namespace {

TEST(FaultLog, TellsHowAProgramEnded) {
  firmware::LoggedFault of_axis, of_watchdog, of_processor;
  of_axis.number = 1;
  of_axis.fault = 1;
  of_watchdog.number = 2;
  of_watchdog.run_s = 7200;
  of_watchdog.reset = 4;
  of_processor.number = 3;
  of_processor.reset = 5;
  of_processor.second_fault = 3;
  of_processor.counts_low = 0x0800A210;
  of_processor.counts_high = static_cast<std::int32_t>(0x82000000);
  of_processor.activity = 3;
  const host::FaultLog log{2.0, {of_processor, of_watchdog, of_axis}};
  const std::string text = host::fault_log_text(log, nullptr);
  EXPECT_NE(text.find("#2         2.00 h  -  reset by watchdog, no axis enabled\n"), std::string::npos) << text;
  EXPECT_NE(text.find("hard fault of the processor at 0x0800a210 (CFSR 0x82000000), enabled: x, y\n"),
            std::string::npos)
      << text;
  const nlohmann::json entries = host::fault_log_json(log, nullptr);
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[0]["reset"], "fault");
  EXPECT_EQ(entries[0]["exception"], "hard fault");
  EXPECT_EQ(entries[0]["address"], 0x0800A210u);
  EXPECT_EQ(entries[1]["reset"], "watchdog");
  EXPECT_FALSE(entries[1].contains("exception"));
  EXPECT_FALSE(entries[2].contains("reset"));
  EXPECT_EQ(entries[2]["axis"], "x");
}

}  // namespace
