// Settings that change by themselves, one bit at a time.
#include "firmware/app/settings_watch.hpp"

#include <gtest/gtest.h>

#include <array>

namespace {

struct Limits {
  std::uint32_t value = 1;
};
struct Part {
  std::array<std::uint8_t, 100> bytes{};
};

/// Two axes with one large and one small setting.
struct FakeAxes {
  static constexpr std::size_t kAxes = 2;
  struct Watch {
    Limits kept;
    const Limits& limits() const { return kept; }
  };
  struct Axis {
    Watch monitors_;
    Part large;
    Limits small;
    const Watch& monitors() const { return monitors_; }
    const Axis& law() const { return *this; }
    template <typename Visit>
    void each_setting(Visit visit) const {
      visit(large);
      visit(small);
    }
  };
  Watch board_;
  std::array<Axis, kAxes> axes{};
  const Watch& board() const { return board_; }
  const Axis& operator[](std::size_t index) const { return axes[index]; }
};

struct FakeBoard {
  bool kept = true;
  bool are_pins_kept() const { return kept; }
};

class Settings : public testing::Test {
 protected:
  void poll(int times) {
    for (int k = 0; k < times; ++k) watch.poll();
  }
  template <typename Setting>
  void flip(Setting& setting, std::size_t byte) {
    reinterpret_cast<std::uint8_t*>(&setting)[byte] ^= 0x10;
  }

  firmware::ParameterValues values;
  FakeAxes axes;
  FakeBoard board;
  firmware::SettingsWatch<FakeAxes, FakeBoard> watch{values, axes, board};
  static constexpr int kPass = sizeof(firmware::ParameterValues) / 32 + 20;  ///< polls, at most
};

TEST_F(Settings, ThatStayAreNoFault) {
  watch.begin_anew();
  poll(20 * kPass);
  EXPECT_FALSE(watch.has_found());
}

TEST_F(Settings, EveryByteIsWatched) {
  const auto is_found = [&](auto& setting, std::size_t byte) {
    firmware::SettingsWatch<FakeAxes, FakeBoard> fresh(values, axes, board);
    for (int k = 0; k < kPass; ++k) fresh.poll();
    flip(setting, byte);
    for (int k = 0; k < 2 * kPass; ++k) fresh.poll();
    flip(setting, byte);
    return fresh.has_found();
  };
  for (std::size_t byte = 0; byte < sizeof values; ++byte) EXPECT_TRUE(is_found(values, byte)) << byte;
  for (FakeAxes::Axis& axis : axes.axes) {
    for (std::size_t byte = 0; byte < sizeof axis.large; ++byte) EXPECT_TRUE(is_found(axis.large, byte)) << byte;
    EXPECT_TRUE(is_found(axis.small, 3));
    EXPECT_TRUE(is_found(axis.monitors_.kept, 0));
  }
  EXPECT_TRUE(is_found(axes.board_.kept, 2));
}

/// At any moment of a pass.
TEST_F(Settings, ThatAreChangedOnPurposeAreNoFault) {
  for (int moment = 0; moment < kPass; ++moment) {
    poll(2 * kPass + moment);
    flip(axes.axes[1].large, 50);
    flip(values, 0);
    watch.begin_anew();
  }
  poll(3 * kPass);
  EXPECT_FALSE(watch.has_found());
}

TEST_F(Settings, ModesOfPinsToo) {
  poll(5);
  EXPECT_FALSE(watch.has_found());
  board.kept = false;
  poll(1);
  board.kept = true;
  poll(3 * kPass);
  EXPECT_TRUE(watch.has_found()) << "until the program starts again";
}

}  // namespace
