// Watches a board: streams channels into a ring, polls the status, runs triggered captures. Commands no motion, so its
// requests keep no motion alive.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "host/device/board_client.hpp"
#include "host/device/capture.hpp"
#include "host/device/triggered_capture.hpp"
#include "host/live/sample_ring.hpp"
#include "host/live/watched_channel.hpp"

namespace host {

using OpenBoard = std::function<BoardClient()>;

struct WatchedTrigger {
  enum class Phase { idle, waiting, done, failed };
  Phase phase = Phase::idle;
  std::string text;  ///< of `done`: the record's name; of `failed`: the reason
};

/// A copy of what is known.
struct BoardPicture {
  bool is_connected = false;
  std::string message;  ///< why nothing is connected, or why nothing is streamed; otherwise empty
  std::string name;     ///< of the board, for --device
  BoardState status;
  firmware::ParameterValues values{1};
  std::vector<sim::DriveKind> kinds;
  std::vector<WatchedChannel> channels;  ///< of the stream
  double row_period_s = 1e-3;
  std::uint64_t epoch = 0;                                   ///< number of the stream; each begins with row 0
  std::uint64_t begin = 0, end = 0, lost = 0, repeated = 0;  ///< of its rows
  WatchedTrigger trigger;
};

class BoardWatch {
 public:
  /// Opens the board. Throws as `open` does; later failures are in the picture, and it is opened again and again.
  explicit BoardWatch(OpenBoard open);
  BoardWatch(const BoardWatch&) = delete;
  BoardWatch& operator=(const BoardWatch&) = delete;
  ~BoardWatch();

  BoardPicture picture() const;

  /// Streams these channels from now on.
  void choose(std::vector<WatchedChannel> channels);

  /// Ends the stream and starts no other until give_back(), because a board runs one capture at a time. Throws
  /// Failure(refused) while a trigger waits, Failure(time_out) if the stream does not end.
  void lend(const std::string& to);
  void give_back();

  /// Reads the parameters anew, soon. Call it after a change.
  void look_again();

  /// Buckets of complete rows of an epoch (SampleRing::envelope); empty if another epoch has begun.
  std::optional<Envelope> envelope(std::uint64_t epoch, std::uint64_t from, std::uint64_t to, std::size_t rows) const;

  /// The kept rows of [from, to) of one axis as a capture with `settings` for capture_record(). Throws
  /// Failure(refused) if there are none.
  Capture rows(std::uint64_t epoch, std::uint8_t axis, std::uint64_t from, std::uint64_t to,
               CaptureSettings& settings) const;

  /// Arms the board's trigger; `keep` writes the capture and returns the record's name. Throws Failure(refused) while
  /// an earlier one waits.
  using KeepCapture = std::function<std::string(const Capture&, const CaptureSettings&)>;
  void arm(TriggeredSettings settings, KeepCapture keep);
  void disarm();

 private:
  struct Armed {
    TriggeredSettings settings;
    KeepCapture keep;
  };

  void run(const std::stop_token& stop);
  void connect();
  void lose(const std::string& message);
  void step(const std::stop_token& stop);
  void read_values();
  void start_stream();
  void fetch();
  void take(const BoardClient::Samples& samples);
  void poll_status();
  void end_stream();
  void run_armed(const std::stop_token& stop, Armed armed);

  const OpenBoard open_;
  std::optional<BoardClient> board_;  ///< used by the watching thread only, once that runs
  bool fixed_point_ = false;
  std::vector<ChannelScale> scales_;  ///< of each axis
  std::chrono::steady_clock::time_point next_status_, next_values_, next_stream_;

  mutable std::mutex mutex_;  ///< for all below
  std::condition_variable_any ending_;
  BoardPicture picture_;
  std::unique_ptr<SampleRing> ring_;
  std::optional<std::vector<WatchedChannel>> wanted_;
  std::optional<Armed> armed_;
  bool is_disarmed_ = false, is_streaming_ = false, is_lent_ = false;

  std::jthread thread_;  ///< last, because it uses the others
};

}  // namespace host
