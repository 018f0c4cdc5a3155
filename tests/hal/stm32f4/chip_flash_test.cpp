// The sectors of parameters and of images on flash that takes its time.
#include "hal/stm32f4/chip_flash.hpp"

#include <array>
#include <vector>

#include "tests/hal/stm32f4/on_chip.hpp"

namespace {

using hal::FlashResult;
using hal::stm32f4::flash_interface;

class Flash : public driver_test::OnRunningChip {
 protected:
  void SetUp() override {
    OnRunningChip::SetUp();
    flash_interface().ACR = 5u | 7u << 8;  // as start-up leaves it: caches on
  }
  std::byte cell(std::size_t sector, std::size_t offset) { return chip.flash.sector(8)[sector * kSector + offset]; }

  static constexpr std::size_t kSector = 128 * 1024;
  static constexpr std::array<std::byte, 8> kWords{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4},
                                                   std::byte{5}, std::byte{6}, std::byte{7}, std::byte{8}};
  hal::stm32f4::ParameterFlash flash{flash_interface(), chip.flash.sector(8)};
};

TEST_F(Flash, ProgramsWordsAndReadsThemBack) {
  EXPECT_EQ(flash.program(1, 8, kWords), FlashResult::ok);
  EXPECT_EQ(cell(1, 8), std::byte{1});
  EXPECT_EQ(cell(1, 15), std::byte{8});
  EXPECT_EQ(cell(1, 16), std::byte{0xFF});
  std::array<std::byte, 8> back{};
  EXPECT_EQ(flash.read(1, 8, back), FlashResult::ok);
  EXPECT_EQ(back, kWords);
  EXPECT_TRUE(chip.flash.is_locked());
  EXPECT_EQ(flash.program(1, 16, kWords), FlashResult::ok) << "a second time too";
}

TEST_F(Flash, ErasesOneSectorAndWaitsUntilItIsDone) {
  flash.program(0, 0, kWords);
  flash.program(1, 0, kWords);
  const double began_ns = chip.bus.now_ns();
  EXPECT_EQ(flash.erase(1), FlashResult::ok);
  EXPECT_GE(chip.bus.now_ns() - began_ns, chip.flash.erase_ns);
  EXPECT_EQ(cell(1, 0), std::byte{0xFF});
  EXPECT_EQ(cell(0, 0), std::byte{1}) << "not its neighbour";
  EXPECT_TRUE(chip.flash.is_locked());
  EXPECT_FALSE(chip.flash.cache_is_stale()) << "the data cache was reset after the erase";
  EXPECT_EQ(flash_interface().ACR & (7u << 8), 7u << 8) << "the caches are on as before";
}

TEST_F(Flash, KeepsToTheRulesOfFlash) {
  EXPECT_EQ(flash.program(0, 0, kWords), FlashResult::ok);
  constexpr std::array<std::byte, 4> kMore{std::byte{0xFF}, std::byte{2}, std::byte{3}, std::byte{4}};
  EXPECT_EQ(flash.program(0, 0, kMore), FlashResult::not_erased);
  EXPECT_EQ(cell(0, 0), std::byte{1});
  EXPECT_EQ(flash.program(4, 0, kWords), FlashResult::out_of_range);
  EXPECT_EQ(flash.program(0, kSector - 4, kWords), FlashResult::out_of_range);
  EXPECT_EQ(flash.program(0, 2, kWords), FlashResult::misaligned);
  EXPECT_EQ(flash.erase(4), FlashResult::out_of_range);
}

TEST_F(Flash, ProtectedSectorsAreAHardwareError) {
  chip.flash.is_protected = true;
  EXPECT_EQ(flash.program(0, 0, kWords), FlashResult::hardware_error);
  EXPECT_EQ(flash.erase(0), FlashResult::hardware_error);
  chip.flash.is_protected = false;
  EXPECT_EQ(flash.program(0, 0, kWords), FlashResult::ok) << "an earlier error does not count";
}

/// Each sector of the chip has its number at its beginning and its end, so the test sees which sectors are erased.
TEST_F(Flash, ImagesHaveTheSectorsBetweenBootCodeAndParameters) {
  hal::stm32f4::ImageFlash images{flash_interface(), chip.flash.sector(1)};
  const auto mark_all = [&] {
    for (unsigned number = 1; number < 12; ++number)
      *chip.flash.sector(number) = *(chip.flash.sector(number + 1) - 1) = static_cast<std::byte>(number);
  };
  const auto erased = [&] {
    std::vector<unsigned> list;
    for (unsigned number = 1; number < 12; ++number)
      if (*chip.flash.sector(number) == std::byte{0xFF} && *(chip.flash.sector(number + 1) - 1) == std::byte{0xFF})
        list.push_back(number);
    return list;
  };
  const std::vector<unsigned> expected[] = {{1, 2, 3, 4}, {5}, {6}};
  const unsigned begins[] = {1, 5, 6};
  for (std::size_t sector = 0; sector < 3; ++sector) {
    mark_all();
    EXPECT_EQ(images.erase(sector), FlashResult::ok);
    EXPECT_EQ(erased(), expected[sector]);
    EXPECT_EQ(images.view(sector).data(), chip.flash.sector(begins[sector]));
    EXPECT_EQ(images.program(sector, 112 * 1024 - 8, kWords), FlashResult::ok);
    EXPECT_EQ(chip.flash.sector(begins[sector])[112 * 1024 - 1], std::byte{8});
    EXPECT_EQ(images.program(sector, 112 * 1024 - 4, kWords), FlashResult::out_of_range);
  }
  EXPECT_EQ(images.erase(3), FlashResult::out_of_range);
  EXPECT_EQ(chip.flash.sector(5) - chip.flash.sector(1), 112 * 1024) << "the place for programs";
  chip.flash.is_protected = true;
  EXPECT_EQ(images.erase(0), FlashResult::hardware_error);
}

}  // namespace
