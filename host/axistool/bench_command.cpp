// axistool bench: speed and reliability of the connection to a board.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/device/device_bench.hpp"
#include "host/link/open_device.hpp"
#include "host/report/progress.hpp"

namespace axistool {

namespace {

struct BenchArguments : DeviceArguments {
  double seconds = 5.0;
};

void run(const BenchArguments& arguments) {
  host::Progress progress("capture", static_cast<std::size_t>(arguments.seconds) + 1);
  std::size_t shown = 0;
  const host::DeviceBench bench =
      host::bench_device([&] { return host::open_device(arguments.device); }, arguments.seconds,
                         [&](double so_far_s) {
                           const auto seconds = static_cast<std::size_t>(so_far_s);
                           if (seconds > shown) progress.advance(seconds - shown);
                           shown = seconds;
                         });
  if (bench.lost_rows > 0) end_with(host::ExitCode::answer_is_no);
  if (!arguments.json.empty())
    write_json({{"format", "axis-device-bench/1"},
                {"connect_ms", bench.connect_ms},
                {"open_ms", bench.open_ms},
                {"read_all_ms", bench.read_all_ms},
                {"set_all_ms", bench.set_all_ms},
                {"exchange_median_ms", bench.exchange_median_ms},
                {"exchange_worst_ms", bench.exchange_worst_ms},
                {"capture_s", bench.capture_s},
                {"capture_rows", bench.capture_rows},
                {"capture_reports", bench.capture_reports},
                {"lost_rows", bench.lost_rows}},
               arguments.json);
  if (!talks(arguments)) return;
  fmt::print("connect and identify        {:8.2f} ms, {:.2f} of them to find and open it\n", bench.connect_ms,
             bench.open_ms);
  fmt::print("read {} parameters         {:8.2f} ms\n", bench.parameters, bench.read_all_ms);
  fmt::print("set, read back, verify      {:8.2f} ms\n", bench.set_all_ms);
  fmt::print("one exchange, median        {:8.3f} ms, worst {:.3f} ms\n", bench.exchange_median_ms,
             bench.exchange_worst_ms);
  fmt::print("capture of {:g} s           {:8} rows in {} reports, {} lost\n", bench.capture_s, bench.capture_rows,
             bench.capture_reports, bench.lost_rows);
}

}  // namespace

void add_bench(CLI::App& app) {
  auto arguments = std::make_shared<BenchArguments>();
  CLI::App* command = app.add_subcommand("bench", "Time connecting, reading, setting and capturing; count lost rows");
  command->add_option("--for", arguments->seconds, "seconds of capture at loop rate, one report a control period")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 86400.0));
  add_device_options(*command, *arguments);
  command->footer(
      "Example:\n"
      "  axistool bench --for 600\n"
      "Changes nothing. Drives must be disabled. Exit code 1: rows were lost.\n"
      "Linux 6.1 waits 50 ms each time it opens a HID device through hidraw; AXISTOOL_HIDAPI=libusb avoids that.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
