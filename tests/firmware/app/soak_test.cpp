// A day of motion: no false fault, and no drift. AXIS_SOAK_HOURS (default: a minute) and AXIS_SOAK_SEED set duration
// and seed; `make soak` takes 24 hours.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "tests/firmware/app/board_on_a_bench.hpp"
#include "tests/firmware/app/noisy_board.hpp"

namespace {

using firmware::AxisFault;
using firmware::MessageType;
using firmware::Status;
using firmware_test::NoisyBoard;
using Application = firmware::BoardApplication<float, NoisyBoard>;

constexpr std::size_t kAxes = Application::kAxes;
constexpr double kPerCount_mm = firmware_test::kEncoderResolution_mm;

double number_from(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atof(text) : otherwise;
}

firmware::ParameterValues values() {
  auto wanted = firmware_test::paper_values();
  firmware_test::fit_axis(wanted, "y", firmware_test::kPaperY);
  for (const std::string axis : {"x.", "y."}) {
    const auto put = [&](const char* name, double value) { firmware_test::set(wanted, axis + name, value); };
    put("homing.mode", 3);
    put("homing.velocity", 50.0);
    put("homing.creep_velocity", 2.0);
    put("homing.travel", 300.0);
    put("homing.index_travel", 11.0);
    put("homing.position", 30.0);
    put("encoder.index_spacing", NoisyBoard::AxisType::kSpacing);
    put("monitor.travel_min", -120.0);
    put("monitor.travel_max", 120.0);
    put("amplifier.ready_input", 1);
    put("amplifier.ready_time", 0.5);
    put("brake.fitted", 1);
  }
  return wanted;
}

/// Results of a cycle of motion.
struct Spread {
  double error_sum = 0.0;
  std::uint64_t samples = 0;
  double largest_disturbance_V = 0.0;
  double mean_error() const { return error_sum / static_cast<double>(samples); }
};

/// A host with irregular requests: 1 to 180 ms apart; the board's time-out is 200 ms.
class Day {
 public:
  explicit Day(std::uint64_t seed)
      : board_({firmware_test::paper_machine(firmware_test::kPaperX),
                firmware_test::paper_machine(firmware_test::kPaperY)},
               seed),
        random_(seed) {
    board_.usb().plug_in();
    application_.start();
  }

  void run(double hours) {
    fit();
    for (std::size_t axis = 0; axis < kAxes; ++axis) find_home(axis);
    const auto all = static_cast<std::uint64_t>(hours * 3.6e6);
    const std::uint64_t begin = periods_;
    while (periods_ - begin < all && !HasFailure()) {
      const bool is_early = periods_ - begin<all / 4, is_late = periods_ - begin> all - all / 4;
      spread_ = is_early ? &early_ : (is_late ? &late_ : &between_);
      cycle();
    }
  }

  const Spread& early() const { return early_; }
  const Spread& late() const { return late_; }
  std::uint64_t periods() const { return periods_; }
  std::uint64_t moves() const { return moves_; }
  double farthest_counts() const { return farthest_counts_; }

 private:
  static bool HasFailure() { return testing::Test::HasFailure(); }

  void period() {
    constexpr double kSixHours = 6.0 * 3.6e6;
    const double creep = 40.0 * std::sin(2.0 * std::numbers::pi * static_cast<double>(periods_) / kSixHours);
    for (std::size_t i = 0; i < kAxes; ++i) {
      const bool flickers = random_() % 16u == 0;
      board_.axis(i).encoder().creep = std::lround(i == 0 ? creep : -creep) + (flickers ? 1 : 0);
    }
    application_.control_period();
    board_.advance();
    ++periods_;
    if (spread_ == nullptr) return;
    for (std::size_t i = 0; i < kAxes; ++i) {
      const auto& seen = application_.axes()[i].telemetry();
      spread_->error_sum += std::abs(static_cast<double>(seen.tracking_error));
      spread_->largest_disturbance_V =
          std::max(spread_->largest_disturbance_V, std::abs(static_cast<double>(seen.estimate.disturbance)));
    }
    spread_->samples += kAxes;
  }

  template <typename... Payload>
  Status ask(MessageType type, const Payload&... payload) {
    firmware::Message request, reply;
    request.type = type;
    request.client = 1;
    (request.put(payload), ...);
    EXPECT_EQ(firmware::decode(server_.answer(firmware::encode(request)), reply), firmware::Status::ok);
    return reply.status;
  }

  void wait(int periods) {
    for (int k = 0; k < periods; ++k) period();
  }
  /// Runs until the axes rest, with a live host; false: it took too long, or a fault occurred.
  bool wait_for_rest() {
    for (int rounds = 0; rounds < 5000; ++rounds) {
      wait(1 + static_cast<int>(random_() % 180u));
      ask(MessageType::heartbeat);
      bool all_rest = true;
      for (std::size_t i = 0; i < kAxes; ++i) {
        const auto status = application_.axis_status(i);
        if (status.fault != 0 && status.fault != static_cast<std::uint8_t>(AxisFault::other_axis_stopped)) {
          ADD_FAILURE() << firmware::fault_info(static_cast<AxisFault>(status.fault)).name << " on axis " << i
                        << " after " << static_cast<double>(periods_) / 3.6e6 << " h";
          return false;
        }
        all_rest = all_rest && (status.flags & firmware::kAxisAtRest) != 0;
      }
      if (all_rest) return true;
    }
    ADD_FAILURE() << "a motion does not end";
    return false;
  }

  /// The loops close once the axes stand.
  bool wait_for_enabled() {
    constexpr int kLongest = 1000;  // periods, a second
    const auto is_enabled = [this](std::size_t i) {
      return application_.axes()[i].state() == firmware::SupervisorState::enabled;
    };
    for (int k = 0; k < kLongest && !(is_enabled(0) && is_enabled(1)); ++k) period();
    for (std::size_t i = 0; i < kAxes; ++i)
      if (!is_enabled(i))
        ADD_FAILURE() << "axis " << i << " in state " << static_cast<int>(application_.axes()[i].state()) << ", fault "
                      << static_cast<int>(application_.axis_status(i).fault);
    return is_enabled(0) && is_enabled(1);
  }

  void fit() {
    const auto wanted = values();
    application_.staged() = wanted;
    ASSERT_EQ(ask(MessageType::commit, firmware::CommitRequest{firmware::set_crc(wanted)}), Status::ok);
    wait(200);
    ASSERT_EQ(ask(MessageType::enable, firmware::AxesRequest{3}), Status::ok);
    wait(150);
  }

  void find_home(std::size_t axis) {
    ASSERT_EQ(ask(MessageType::home, firmware::HomeRequest{static_cast<std::uint8_t>(axis), 0}), Status::ok);
    ASSERT_TRUE(wait_for_rest());
    ASSERT_TRUE(application_.axes()[axis].is_homed());
    home_[axis] = board_.axis(axis).encoder().counts() - application_.axes()[axis].telemetry().encoder_counts;
  }

  /// Moves of both axes, sometimes a jog, now and then a pause with the axes off.
  void cycle() {
    std::array<std::int64_t, kAxes> target{};
    for (std::size_t i = 0; i < kAxes; ++i) {
      target[i] = std::llround(std::uniform_real_distribution<double>(-100.0, 100.0)(random_) / kPerCount_mm);
      ASSERT_EQ(ask(MessageType::move, firmware::MoveRequest::to(static_cast<std::uint8_t>(i), target[i])), Status::ok);
    }
    ++moves_;
    ASSERT_TRUE(wait_for_rest());
    wait(50);
    for (std::size_t i = 0; i < kAxes; ++i) expect_at(i, target[i]);
    switch (random_() % 8u) {
      case 0: {
        const float velocity = target[0] > 0 ? -150.0F : 150.0F;
        ASSERT_EQ(ask(MessageType::jog, firmware::JogRequest{0, {}, velocity}), Status::ok);
        wait(150);
        ASSERT_EQ(ask(MessageType::stop), Status::ok);
        ASSERT_TRUE(wait_for_rest());
        break;
      }
      case 1:
        ASSERT_EQ(ask(MessageType::disable, firmware::AxesRequest{3}), Status::ok);
        wait(400);
        ASSERT_EQ(ask(MessageType::enable, firmware::AxesRequest{3}), Status::ok);
        ASSERT_TRUE(wait_for_enabled());
        break;
      default:
        break;
    }
  }

  /// Checks that the axis is at its target, and that its counts are unchanged relative to home.
  void expect_at(std::size_t i, std::int64_t target) {
    const auto& seen = application_.axes()[i].telemetry();
    ASSERT_EQ(seen.reference.counts, target);
    ASSERT_EQ(seen.reference.fraction, 0);
    const auto off = static_cast<double>(seen.encoder_counts - target);
    farthest_counts_ = std::max(farthest_counts_, std::abs(off));
    ASSERT_LE(std::abs(off), 8.0) << "axis " << i;
    ASSERT_LE(std::abs(board_.axis(i).encoder().counts() - seen.encoder_counts - home_[i]), 3);
    ASSERT_TRUE(application_.axes()[i].is_homed());
  }

  NoisyBoard board_;
  Application application_{board_};
  firmware::ImageHeader image_;
  firmware::ProtocolServer<Application> server_{application_, image_, {}};
  std::mt19937 random_;
  std::array<std::int64_t, kAxes> home_{};
  Spread early_, between_, late_;
  Spread* spread_ = nullptr;
  std::uint64_t periods_ = 0, moves_ = 0;
  double farthest_counts_ = 0.0;
};

TEST(Soak, NothingTripsAndNothingDrifts) {
  const double hours = number_from("AXIS_SOAK_HOURS", 1.0 / 60.0);
  const auto seed = static_cast<std::uint64_t>(number_from("AXIS_SOAK_SEED", 1.0));
  Day day(seed);
  const auto begin = std::chrono::steady_clock::now();
  day.run(hours);
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::printf(
      "seed %llu: %.3f h of two axes, %llu moves, in %.0f s; standing within %.0f counts; mean error %.2f um in "
      "the first quarter, %.2f um in the last; disturbance within %.2f and %.2f V\n",
      static_cast<unsigned long long>(seed), static_cast<double>(day.periods()) / 3.6e6,
      static_cast<unsigned long long>(day.moves()), took_s, day.farthest_counts(), 1e3 * day.early().mean_error(),
      1e3 * day.late().mean_error(), day.early().largest_disturbance_V, day.late().largest_disturbance_V);
  EXPECT_GT(day.moves(), static_cast<std::uint64_t>(hours * 600.0));
  EXPECT_NEAR(day.late().mean_error() / day.early().mean_error(), 1.0, hours < 1.0 ? 0.3 : 0.05);
  EXPECT_LT(day.late().largest_disturbance_V, 1.2 * day.early().largest_disturbance_V);
}

}  // namespace
