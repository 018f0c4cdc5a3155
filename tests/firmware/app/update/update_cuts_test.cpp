// Updates of the program, from the first block to the confirmed run: power cut at every operation of the flash.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <optional>

#include "firmware/app/update/boot_choice.hpp"
#include "firmware/app/update/image_update.hpp"
#include "hal/pc/simulated_flash.hpp"
#include "tests/firmware/app/update/made_image.hpp"

namespace {

using firmware::ImageRefusal;
using firmware::SlotState;
using firmware::UpdateResult;
using firmware_test::announcement_of;
using firmware_test::block_of;
using firmware_test::Bytes;
using firmware_test::header_of;
using firmware_test::kAtOnce;
using firmware_test::made_image;
using hal::pc::kTornStates;
using hal::pc::PowerCut;
using hal::pc::SimulatedFlash;
using hal::pc::TornState;

/// The smallest flash for an image; the program's place is erased in parts, as on the chip.
SimulatedFlash blank_flash() { return SimulatedFlash(3, 1024, 4, 4); }

/// A board: its flash of programs, the boot code, and a program that takes updates.
struct Board {
  using Slots = firmware::ImageSlots<SimulatedFlash>;

  SimulatedFlash flash = blank_flash();
  std::optional<Bytes> running;  ///< after boot(): what the boot code started

  /// Writes the program as a probe does.
  void flash_by_probe(const Bytes& image) {
    flash.contents()[Slots::kProgram].assign(flash.sector_size(), std::byte{0xFF});
    std::ranges::copy(image, flash.contents()[Slots::kProgram].begin());
  }

  bool boot() {
    running.reset();
    if (firmware::BootChoice(flash).prepare() == firmware::BootResult::nothing) return false;
    const Slots slots(flash);
    const auto memory = slots.memory(Slots::kProgram).first(slots.header(Slots::kProgram).image_size);
    running.emplace(memory.begin(), memory.end());
    return true;
  }

  firmware::ImageHeader own() const { return header_of(*running); }

  /// By the running program.
  UpdateResult update(const firmware::BeginUpdateRequest& announced, const Bytes& sent) {
    const firmware::ImageHeader header = own();
    firmware::ImageUpdate update(flash, header);
    UpdateResult result = update.begin(announced, refusal, kAtOnce);
    for (std::size_t offset = 0; offset < sent.size() && result == UpdateResult::ok; offset += firmware::kUpdateBlock)
      result = update.take(block_of(sent, offset), kAtOnce);
    return result == UpdateResult::ok ? update.finish(refusal, kAtOnce) : result;
  }
  UpdateResult update(const Bytes& image) { return update(announcement_of(image), image); }

  bool is_on_trial() const {
    SimulatedFlash copy = flash;
    const firmware::ImageHeader header = own();
    return firmware::ImageUpdate(copy, header).is_on_trial();
  }
  void confirm() {
    const firmware::ImageHeader header = own();
    ASSERT_EQ(firmware::ImageUpdate(flash, header).confirm(kAtOnce), UpdateResult::ok);
  }

  ImageRefusal refusal = ImageRefusal::none;
};

const Bytes kOld = made_image("1", 1), kNew = made_image("2", 2, 925), kNewer = made_image("3", 3, 700);

/// A host's update with one image: sends it, restarts the board, and confirms it if the image runs and is healthy.
void do_update(Board& board, const firmware::BeginUpdateRequest& announced, const Bytes& sent, bool is_healthy) {
  if (board.update(announced, sent) != UpdateResult::ok) return;
  ASSERT_TRUE(board.boot());
  if (is_healthy) board.confirm();
  ASSERT_TRUE(is_healthy || board.boot());
}

struct Trial {
  const char* what;
  firmware::BeginUpdateRequest announced;
  Bytes sent;
  bool is_healthy;
  Bytes kept;  ///< the image that runs in the end
};

std::vector<Trial> trials() {
  const Bytes other = made_image("2", 2, 925, "another");
  Bytes truncated = kNew;
  truncated.resize(700);
  return {{"good", announcement_of(kNew), kNew, true, kNew},
          {"truncated", announcement_of(kNew), truncated, true, kOld},
          {"for another board", announcement_of(other), other, true, kOld},
          {"of another board under a false name", announcement_of(kNew), other, true, kOld},
          {"never healthy", announcement_of(kNew), kNew, false, kOld}};
}

/// After a power cut the board always boots into one of the two images; into the old one unless the new one is
/// confirmed.
void check_after_cut(Board& board, const Trial& trial, std::uint32_t seed, const std::string& where) {
  // Power is also cut during the boot code.
  board.flash.cut_power_after(seed % 300, kTornStates[seed / 300 % 4], seed);
  try {
    board.boot();
  } catch (const PowerCut&) {
  }
  board.flash.restore_power();
  ASSERT_TRUE(board.boot()) << where << ": the board does not answer";
  const bool is_new = board.running == kNew;
  ASSERT_TRUE(is_new || board.running == kOld) << where << ": neither the old image nor the new one";
  const bool is_refused = trial.kept == kOld && trial.is_healthy;
  ASSERT_FALSE(is_new && is_refused) << where << ": a refused image runs";
  const bool is_on_trial = board.is_on_trial();
  ASSERT_TRUE(!is_on_trial || is_new) << where << ": the old image on trial";
  ASSERT_TRUE(!is_new || is_on_trial || trial.is_healthy) << where << ": nobody confirmed it";
  ASSERT_TRUE(board.boot());
  ASSERT_EQ(board.running, is_on_trial ? kOld : is_new ? kNew : kOld) << where << ": at the next reset";
  // The update can be repeated.
  do_update(board, announcement_of(kNewer), kNewer, true);
  ASSERT_EQ(board.running, kNewer) << where;
  ASSERT_FALSE(board.is_on_trial()) << where;
  ASSERT_TRUE(board.boot());
  ASSERT_EQ(board.running, kNewer) << where;
}

/// History of a board that finally runs the old image.
enum class Past { flashed_by_a_probe, updated, flashed_after_updates };

class UpdateCuts : public testing::TestWithParam<Past> {
 protected:
  static Board before() {
    Board board;
    board.flash_by_probe(GetParam() == Past::flashed_by_a_probe ? kOld : kNewer);
    EXPECT_TRUE(board.boot());
    if (GetParam() == Past::updated) do_update(board, announcement_of(kOld), kOld, true);
    if (GetParam() == Past::flashed_after_updates) {
      const Bytes foreign = made_image("4", 4);
      do_update(board, announcement_of(foreign), foreign, true);
      board.flash_by_probe(kOld);
      EXPECT_TRUE(board.boot());
    }
    EXPECT_EQ(board.running, kOld);
    return board;
  }
};

TEST_P(UpdateCuts, LeaveTheOldImageOrTheNewOne) {
  for (const Trial& trial : trials()) {
    const Board start = before();
    Board whole = start;
    do_update(whole, trial.announced, trial.sent, trial.is_healthy);
    ASSERT_TRUE(whole.boot());
    ASSERT_EQ(whole.running, trial.kept) << trial.what;
    const std::size_t operations = whole.flash.operations() - start.flash.operations();
    std::size_t cuts = 0;
    for (std::size_t operation = 0; operation < operations; ++operation) {
      for (const TornState torn : kTornStates) {
        const std::string where = std::string(trial.what) + ", operation " + std::to_string(operation) +
                                  ", torn state " + std::to_string(static_cast<int>(torn));
        Board board = start;
        const auto seed = static_cast<std::uint32_t>(4 * operation + cuts % 4);
        board.flash.cut_power_after(operation, torn, seed);
        try {
          do_update(board, trial.announced, trial.sent, trial.is_healthy);
          ADD_FAILURE() << where << ": no cut";
        } catch (const PowerCut&) {
        }
        board.flash.restore_power();
        check_after_cut(board, trial, seed * 2654435761u >> 8, where);
        if (HasFatalFailure()) return;
        ++cuts;
      }
    }
    std::printf("%s: %zu operations, %zu cuts\n", trial.what, operations, cuts);
  }
}

std::string name_of_past(const testing::TestParamInfo<Past>& given) {
  constexpr std::array kNames{"FlashedByAProbe", "Updated", "FlashedAfterUpdates"};
  return kNames[static_cast<std::size_t>(given.param)];
}

INSTANTIATE_TEST_SUITE_P(Boards, UpdateCuts,
                         testing::Values(Past::flashed_by_a_probe, Past::updated, Past::flashed_after_updates),
                         name_of_past);

}  // namespace
