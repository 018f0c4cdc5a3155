// The image that the boot code starts, and the image that the program accepts: damage, refusals, failing flash.
#include "firmware/app/update/image_update.hpp"

#include <gtest/gtest.h>

#include "firmware/app/update/boot_choice.hpp"
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
using hal::FlashResult;

/// Sectors may refuse to be changed.
class FailingFlash : public hal::pc::SimulatedFlash {
 public:
  FailingFlash() : SimulatedFlash(3, 1024, 4) {}
  FlashResult program(std::size_t sector, std::size_t offset, std::span<const std::byte> in) {
    return refuses[sector] ? FlashResult::hardware_error : SimulatedFlash::program(sector, offset, in);
  }
  FlashResult erase(std::size_t sector) {
    return refuses[sector] ? FlashResult::hardware_error : SimulatedFlash::erase(sector);
  }
  std::array<bool, 3> refuses{};
};

class ImageUpdate : public testing::Test {
 protected:
  using Slots = firmware::ImageSlots<FailingFlash>;
  static constexpr std::size_t kProgram = 0, kA = 1, kB = 2;
  const Bytes kOld = made_image("1", 1), kNew = made_image("2", 2), kThird = made_image("3", 3);

  void write(std::size_t sector, const Bytes& image) {
    flash.contents()[sector].assign(flash.sector_size(), std::byte{0xFF});
    std::ranges::copy(image, flash.contents()[sector].begin());
  }
  bool boot() { return firmware::BootChoice(flash).prepare() != firmware::BootResult::nothing; }
  bool runs(const Bytes& image) const {
    return std::ranges::equal(slots.memory(kProgram).first(image.size()), image) && slots.is_whole(kProgram);
  }
  UpdateResult begin(const Bytes& image) { return update.begin(announcement_of(image), refusal, kAtOnce); }
  UpdateResult send(const Bytes& image) {
    UpdateResult result = UpdateResult::ok;
    for (std::size_t at = 0; at < image.size() && result == UpdateResult::ok; at += firmware::kUpdateBlock)
      result = update.take(block_of(image, at), kAtOnce);
    return result;
  }
  UpdateResult finish() { return update.finish(refusal, kAtOnce); }
  /// Up to the confirmed run.
  void install(const Bytes& image) {
    ASSERT_EQ(begin(image), UpdateResult::ok);
    ASSERT_EQ(send(image), UpdateResult::ok);
    ASSERT_EQ(finish(), UpdateResult::ok);
    ASSERT_TRUE(boot());
    ASSERT_TRUE(runs(image));
    ASSERT_TRUE(update.is_on_trial());
    ASSERT_EQ(update.confirm(kAtOnce), UpdateResult::ok);
    ASSERT_FALSE(update.is_on_trial());
  }

  FailingFlash flash;
  const Slots slots{flash};
  const firmware::ImageHeader own = header_of(kOld);
  firmware::ImageUpdate<FailingFlash> update{flash, own};
  ImageRefusal refusal = ImageRefusal::none;
};

TEST_F(ImageUpdate, TakesTheSlotsInTurns) {
  write(kProgram, kOld);
  ASSERT_TRUE(boot());
  EXPECT_TRUE(slots.is_program_flashed());
  EXPECT_EQ(slots.state(kA), SlotState::empty);
  install(kNew);
  EXPECT_EQ(slots.state(kA), SlotState::healthy) << "the old image, kept";
  EXPECT_EQ(slots.running_slot(), kB);
  EXPECT_EQ(slots.number(kB), 2u);
  install(kThird);
  EXPECT_EQ(slots.running_slot(), kA);
  EXPECT_EQ(slots.number(kA), 3u);
  EXPECT_EQ(header_of(kNew).crc, slots.header(kB).crc);
  EXPECT_TRUE(boot());
  EXPECT_TRUE(runs(kThird));
}

TEST_F(ImageUpdate, AnImageThatNobodyConfirmsIsLeftForTheOldOne) {
  write(kProgram, kOld);
  const Bytes before(flash.contents()[kProgram].begin(), flash.contents()[kProgram].begin() + 900);
  ASSERT_EQ(begin(kNew), UpdateResult::ok);
  ASSERT_EQ(send(kNew), UpdateResult::ok);
  ASSERT_EQ(finish(), UpdateResult::ok);
  EXPECT_EQ(slots.state(kB), SlotState::offered);
  ASSERT_TRUE(boot());
  ASSERT_TRUE(runs(kNew));
  EXPECT_EQ(slots.state(kB), SlotState::tried);
  for (int resets = 0; resets < 3; ++resets) {
    ASSERT_TRUE(boot());
    EXPECT_TRUE(std::ranges::equal(slots.memory(kProgram).first(900), before)) << "bit for bit";
    EXPECT_FALSE(update.is_on_trial());
  }
  EXPECT_EQ(slots.state(kB), SlotState::tried) << "failed: info can tell";
}

TEST_F(ImageUpdate, WhatAProbeFlashedRunsWhateverTheSlotsHold) {
  write(kProgram, kOld);
  install(kNew);
  for (const Bytes& image : {kOld, kThird}) {  // one that is also in a slot, and one that is in no slot
    write(kProgram, image);
    ASSERT_TRUE(boot());
    EXPECT_TRUE(runs(image));
    EXPECT_TRUE(slots.is_program_flashed());
  }
  install(kNew);
  EXPECT_EQ(header_of(kThird).crc, slots.header(kA).crc) << "the slot now keeps the flashed image";
}

TEST_F(ImageUpdate, WithoutAWholeProgramTheNewestWholeSlotRuns) {
  write(kProgram, kOld);
  install(kNew);
  const FailingFlash before = flash;
  for (const std::size_t damaged : {kProgram, kB}) {
    for (std::size_t offset = 0; offset < kNew.size(); offset += 13) {
      flash = before;
      flash.contents()[kProgram][offset] ^= std::byte{0x10};
      flash.contents()[damaged][offset] ^= damaged == kB ? std::byte{0x04} : std::byte{0};
      ASSERT_TRUE(boot()) << offset;
      ASSERT_TRUE(runs(damaged == kB ? kOld : kNew)) << "byte " << offset << " of sector " << damaged;
    }
  }
  flash = before;
  write(kProgram, {});
  write(kA, {});
  write(kB, {});
  EXPECT_FALSE(boot());
}

/// Each bit of the marks of the slot that runs: the board still boots, into one of its images.
TEST_F(ImageUpdate, DamagedMarksLeaveABoardThatBoots) {
  write(kProgram, kOld);
  install(kNew);
  const FailingFlash before = flash;
  for (const std::size_t sector : {kProgram, kA, kB}) {
    for (std::size_t offset = slots.capacity(); offset < flash.sector_size(); ++offset) {
      for (int bit = 0; bit < 8; ++bit) {
        flash = before;
        flash.contents()[sector][offset] ^= static_cast<std::byte>(1 << bit);
        ASSERT_TRUE(boot()) << sector << " " << offset;
        ASSERT_TRUE(runs(kNew) || runs(kOld)) << sector << " " << offset;
      }
    }
  }
}

TEST_F(ImageUpdate, AFlashThatFailsKeepsTheOldImage) {
  write(kProgram, kOld);
  ASSERT_EQ(begin(kNew), UpdateResult::ok);
  ASSERT_EQ(send(kNew), UpdateResult::ok);
  ASSERT_EQ(finish(), UpdateResult::ok);
  flash.refuses[kB] = true;
  ASSERT_TRUE(boot());
  EXPECT_TRUE(runs(kOld)) << "an image that cannot be marked as tried must not start: it would be tried at each boot";
  flash.refuses = {true, false, false};
  ASSERT_TRUE(boot());
  EXPECT_TRUE(runs(kOld)) << "the program area cannot be written, so it keeps its image";
  flash.refuses = {};
  ASSERT_TRUE(boot());
  flash.refuses[kA] = true;
  EXPECT_EQ(begin(kThird), UpdateResult::flash_failed);
  EXPECT_EQ(send(kThird), UpdateResult::out_of_order);
}

TEST_F(ImageUpdate, RefusesByTheAnnouncementBeforeAnythingIsErased) {
  write(kProgram, kOld);
  const auto cause = [&](auto change) {
    firmware::BeginUpdateRequest announced = announcement_of(kNew);
    change(announced);
    EXPECT_EQ(update.begin(announced, refusal, kAtOnce), UpdateResult::bad_image);
    return refusal;
  };
  EXPECT_EQ(cause([](auto& a) { a.board[0] = 'X'; }), ImageRefusal::other_board);
  EXPECT_EQ(cause([](auto& a) { a.board[15] = 'X'; }), ImageRefusal::other_board);
  EXPECT_EQ(cause([](auto& a) { a.chip_id = 0x419; }), ImageRefusal::other_chip);
  EXPECT_EQ(cause([](auto& a) { a.layout = 1; }), ImageRefusal::other_layout);
  EXPECT_EQ(cause([&](auto& a) { a.size = static_cast<std::uint32_t>(slots.capacity() + 1); }),
            ImageRefusal::wrong_size);
  EXPECT_EQ(cause([](auto& a) { a.size = 591; }), ImageRefusal::wrong_size);
  EXPECT_EQ(flash.operations(), 0u);
}

TEST_F(ImageUpdate, RefusesWhatCameAndNamesTheCause) {
  write(kProgram, kOld);
  const auto cause = [&](const Bytes& sent) {
    EXPECT_EQ(begin(kNew), UpdateResult::ok);
    EXPECT_EQ(send(sent), UpdateResult::ok);
    EXPECT_EQ(finish(), UpdateResult::bad_image);
    EXPECT_EQ(finish(), UpdateResult::out_of_order) << "it is over";
    EXPECT_TRUE(boot());
    EXPECT_TRUE(runs(kOld));
    EXPECT_EQ(slots.state(kB), SlotState::incomplete);
    return refusal;
  };
  Bytes sent = kNew;
  sent[firmware::kImageHeaderOffset] ^= std::byte{1};
  EXPECT_EQ(cause(sent), ImageRefusal::no_header);
  EXPECT_EQ(cause(Bytes(kNew.begin(), kNew.begin() + 864)), ImageRefusal::wrong_size) << "one block is missing";
  EXPECT_EQ(cause(kThird), ImageRefusal::not_announced);
  EXPECT_EQ(cause(made_image("2", 2, 880)), ImageRefusal::not_announced) << "shorter";
  for (const std::size_t offset : {std::size_t{0}, firmware::kImageHeaderOffset + 20, kNew.size() - 1}) {
    sent = kNew;
    sent[offset] ^= std::byte{0x40};
    EXPECT_EQ(cause(sent), ImageRefusal::wrong_crc) << offset;
  }
}

TEST_F(ImageUpdate, BlocksComeInOrder) {
  write(kProgram, kOld);
  EXPECT_EQ(update.take(block_of(kNew, 0), kAtOnce), UpdateResult::out_of_order) << "before it began";
  ASSERT_EQ(begin(kNew), UpdateResult::ok);
  EXPECT_EQ(update.take(block_of(kNew, 48), kAtOnce), UpdateResult::out_of_order);
  EXPECT_EQ(update.take(block_of(kNew, 0), kAtOnce), UpdateResult::ok);
  EXPECT_EQ(update.take(block_of(kNew, 0), kAtOnce), UpdateResult::out_of_order) << "twice";
  for (std::size_t at = 48; at < kNew.size(); at += 48)
    EXPECT_EQ(update.take(block_of(kNew, at), kAtOnce), UpdateResult::ok);
  firmware::UpdateBlockRequest beyond;
  beyond.offset = 912;
  EXPECT_EQ(update.take(beyond, kAtOnce), UpdateResult::out_of_order) << "beyond what was announced";
  EXPECT_EQ(finish(), UpdateResult::ok);
}

}  // namespace
