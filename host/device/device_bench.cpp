#include "host/device/device_bench.hpp"

#include <algorithm>
#include <chrono>
#include <vector>

namespace host {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

template <typename Work>
double time_ms(Work work) {
  const auto begin = Clock::now();
  work();
  return ms_since(begin);
}

/// Captures as many channels as a report holds, so that each control period needs one report.
void run_capture(BoardClient& board, DeviceBench& bench, const std::function<void(double)>& progress) {
  constexpr std::uint16_t kAllOfX = (1u << firmware::kChannels) - 1;
  firmware::CaptureRequest request{{kAllOfX}, 1, 0};
  if (board.axis_count() > 1) request.channels[1] = 1;
  board.start_capture(request);
  const auto begin = Clock::now();
  std::uint32_t next_row = 0;
  const auto take = [&](const BoardClient::Samples& samples) {
    ++bench.capture_reports;
    ++bench.capture_rows;
    bench.lost_rows += samples.first_row - next_row;
    next_row = samples.first_row + 1;
  };
  while (ms_since(begin) < 1e3 * bench.capture_s) {
    if (const auto samples = board.next_samples(std::chrono::milliseconds(20))) take(*samples);
    if (progress) progress(1e-3 * ms_since(begin));
  }
  const std::uint32_t taken = board.stop_capture().rows;
  while (const auto samples = board.next_samples(std::chrono::milliseconds(50))) take(*samples);
  bench.lost_rows += taken - next_row;
}

}  // namespace

DeviceBench bench_device(const std::function<std::unique_ptr<ReportLink>()>& open, double capture_s,
                         const std::function<void(double)>& progress) {
  constexpr int kExchanges = 500;
  DeviceBench bench;
  const auto begin = Clock::now();
  auto link = open();
  bench.open_ms = ms_since(begin);
  BoardClient board(std::move(link));
  board.require_same_table();
  board.status();
  bench.connect_ms = ms_since(begin);
  firmware::ParameterValues values(board.axis_count());
  bench.read_all_ms = time_ms([&] { values = board.read_values(); });
  bench.parameters = values.size();
  bench.set_all_ms = time_ms([&] { board.write_values(values, true); });
  std::vector<double> exchanges;
  for (int i = 0; i < kExchanges; ++i) exchanges.push_back(time_ms([&] { board.heartbeat(); }));
  std::ranges::sort(exchanges);
  bench.exchange_median_ms = exchanges[exchanges.size() / 2];
  bench.exchange_worst_ms = exchanges.back();
  bench.capture_s = capture_s;
  if (capture_s > 0.0) run_capture(board, bench, progress);
  return bench;
}

}  // namespace host
