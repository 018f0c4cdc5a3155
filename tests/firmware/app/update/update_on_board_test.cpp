// Updates over the protocol, on the simulated board: accepted requests, the trial, and the data that survive an update
// and a return.
#include <gtest/gtest.h>

#include "firmware/app/update/boot_choice.hpp"
#include "tests/firmware/app/board_on_a_bench.hpp"
#include "tests/firmware/app/update/made_image.hpp"

namespace {

using firmware::ImageRefusal;
using firmware::MessageType;
using firmware::SlotState;
using firmware::Status;
using firmware_test::announcement_of;
using firmware_test::block_of;
using firmware_test::Bytes;
using firmware_test::header_of;
using firmware_test::made_image;
using hal::pc::SimulatedFlash;

class UpdateOnBoard : public testing::Test {
 protected:
  using Bench = firmware_test::BoardOnABench<float>;

  /// Flash as large as the axis board's, in the state in which it was flashed.
  UpdateOnBoard() {
    images_.contents()[0].assign(images_.sector_size(), std::byte{0xFF});
    std::ranges::copy(old_image, images_.contents()[0].begin());
    start();
  }

  /// Runs the boot code, then a program that knows the header of its own image.
  void start() {
    if (bench) {
      images_ = bench->board.image_flash();
      store_ = bench->board.parameter_flash();
    }
    images_.restore_power();
    ASSERT_NE(firmware::BootChoice(images_).prepare(), firmware::BootResult::nothing);
    bench = std::make_unique<Bench>(&store_);
    bench->board.image_flash() = images_;
    bench->image = firmware::ImageSlots(images_).header(0);
    server = std::make_unique<firmware::ProtocolServer<Bench::Application>>(bench->application, bench->image,
                                                                            firmware::BootFacts{});
  }

  template <typename Payload>
  firmware::Message ask(MessageType type, const Payload& payload) {
    firmware::Message request;
    request.put(payload);
    return ask(type, request);
  }
  firmware::Message ask(MessageType type, firmware::Message request = {}) {
    request.type = type;
    request.client = 1;
    firmware::Message reply;
    EXPECT_EQ(firmware::decode(server->answer(firmware::encode(request)), reply), Status::ok);
    return reply;
  }
  /// Asks the server of the running image.
  void run(int periods) {
    for (int k = 0; k < periods; ++k) {
      bench->application.control_period();
      server->poll(bench->board.usb());
      bench->board.advance();
    }
  }

  Status send(const Bytes& image) {
    Status status = ask(MessageType::begin_update, announcement_of(image)).status;
    for (std::size_t at = 0; at < image.size() && status == Status::ok; at += firmware::kUpdateBlock)
      status = ask(MessageType::update_block, block_of(image, at)).status;
    return status == Status::ok ? ask(MessageType::finish_update).status : status;
  }
  firmware::SlotPayload slot(std::uint8_t index) {
    firmware::SlotPayload payload;
    EXPECT_TRUE(ask(MessageType::read_slot, firmware::ReadSlotRequest{index}).get(payload));
    return payload;
  }
  Bytes program() {
    const firmware::ImageSlots slots(bench->board.image_flash());
    const auto memory = slots.memory(0).first(slots.header(0).image_size);
    return {memory.begin(), memory.end()};
  }

  const Bytes old_image = made_image("1", 1, 96 * 1024), new_image = made_image("2", 2, 100 * 1024 + 4);
  std::unique_ptr<Bench> bench;
  std::unique_ptr<firmware::ProtocolServer<Bench::Application>> server;

 private:
  SimulatedFlash images_{3, 112 * 1024, 4}, store_{4, 16384, 4};
};

TEST_F(UpdateOnBoard, RunsOnTrialUntilItIsConfirmed) {
  EXPECT_EQ(slot(0).runs, 0) << "as it was flashed";
  EXPECT_EQ(slot(0).version[0], '1');
  EXPECT_EQ(slot(1).state, static_cast<std::uint8_t>(SlotState::empty));
  ASSERT_EQ(send(new_image), Status::ok);
  EXPECT_EQ(slot(0).runs, 1) << "the old image, now kept in slot A";
  EXPECT_EQ(slot(2).state, static_cast<std::uint8_t>(SlotState::offered));
  EXPECT_EQ(program(), old_image) << "until the restart";
  start();
  EXPECT_EQ(program(), new_image);
  EXPECT_EQ(slot(2).state, static_cast<std::uint8_t>(SlotState::tried));
  EXPECT_EQ(ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::on_trial);
  EXPECT_EQ(ask(MessageType::begin_update, announcement_of(old_image)).status, Status::on_trial);
  EXPECT_EQ(ask(MessageType::confirm_update).status, Status::ok);
  EXPECT_EQ(slot(2).state, static_cast<std::uint8_t>(SlotState::healthy));
  EXPECT_NE(ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::on_trial);
  run(40'000);
  EXPECT_FALSE(bench->board.wants_restart());
  start();
  EXPECT_EQ(program(), new_image);
}

TEST_F(UpdateOnBoard, ReturnsByItselfWhereNobodyConfirms) {
  ASSERT_EQ(send(new_image), Status::ok);
  start();
  run(29'900);
  EXPECT_FALSE(bench->board.wants_restart());
  run(200);
  EXPECT_TRUE(bench->board.wants_restart()) << "30 s at 1 kHz";
  start();
  EXPECT_EQ(program(), old_image) << "bit for bit";
  EXPECT_EQ(slot(2).state, static_cast<std::uint8_t>(SlotState::tried));
  EXPECT_EQ(slot(2).runs, 0);
  run(31'000);
  EXPECT_FALSE(bench->board.wants_restart()) << "the old image is not on trial";
}

TEST_F(UpdateOnBoard, IsRefusedWhileAnAxisIsEnabled) {
  ASSERT_EQ(ask(MessageType::begin_update, announcement_of(new_image)).status, Status::ok);
  ASSERT_EQ(ask(MessageType::update_block, block_of(new_image, 0)).status, Status::ok);
  bench->fit_and_enable_x(5.0);
  const std::size_t operations = bench->board.image_flash().operations();
  EXPECT_EQ(ask(MessageType::update_block, block_of(new_image, firmware::kUpdateBlock)).status, Status::drive_enabled);
  EXPECT_EQ(ask(MessageType::finish_update).status, Status::drive_enabled);
  EXPECT_EQ(ask(MessageType::begin_update, announcement_of(new_image)).status, Status::drive_enabled);
  EXPECT_EQ(ask(MessageType::confirm_update).status, Status::drive_enabled);
  EXPECT_EQ(ask(MessageType::read_slot, firmware::ReadSlotRequest{1}).status, Status::ok) << "looking is free";
  EXPECT_EQ(bench->board.image_flash().operations(), operations);
  ask(MessageType::disable, firmware::AxesRequest{1});
  run(2000);
  EXPECT_EQ(send(new_image), Status::ok);
}

TEST_F(UpdateOnBoard, SaysWhyItRefusesAnImage) {
  const auto cause = [&](const firmware::Message& reply) {
    EXPECT_EQ(reply.status, Status::bad_image);
    firmware::RefusedImagePayload refused;
    EXPECT_TRUE(reply.get(refused));
    EXPECT_EQ(refused.capacity, 112 * 1024u - 32u);
    EXPECT_EQ(refused.chip_id, 0x413u);
    EXPECT_EQ(std::string(refused.board.data()), "simulated");
    return refused.refusal;
  };
  EXPECT_EQ(cause(ask(MessageType::begin_update, announcement_of(made_image("2", 2, 900, "another")))),
            ImageRefusal::other_board);
  ASSERT_EQ(ask(MessageType::begin_update, announcement_of(new_image)).status, Status::ok);
  Bytes damaged = new_image;
  damaged[5000] ^= std::byte{1};
  for (std::size_t at = 0; at < damaged.size(); at += firmware::kUpdateBlock)
    ASSERT_EQ(ask(MessageType::update_block, block_of(damaged, at)).status, Status::ok);
  EXPECT_EQ(cause(ask(MessageType::finish_update)), ImageRefusal::wrong_crc);
  EXPECT_EQ(ask(MessageType::update_block, block_of(damaged, 0)).status, Status::set_differs);
  start();
  EXPECT_EQ(program(), old_image);
  EXPECT_EQ(ask(MessageType::read_slot, firmware::ReadSlotRequest{3}).status, Status::malformed);
}

/// Updates and confirms; then updates back to the old image.
TEST_F(UpdateOnBoard, ParametersTablesAndFaultsStayBothWays) {
  bench->fit_and_enable_x();
  ask(MessageType::disable, firmware::AxesRequest{1});
  run(2000);
  ASSERT_EQ(ask(MessageType::save).status, Status::ok);
  firmware::LoggedFault fault;
  fault.reset = 4;
  bench->application.log_end_of_last_run(fault);
  run(10);
  const auto resolution = bench->application.active().axis(0).get<"drive.encoder_resolution">();
  const std::array<firmware::PitchPoint, 2> points{{{0, 1, 2}, {1000, 3, 4}}};
  ASSERT_EQ(
      ask(MessageType::begin_table, firmware::BeginTableRequest{0, 0, 2, std::bit_cast<std::uint32_t>(resolution)})
          .status,
      Status::ok);
  firmware::TablePointsRequest part;
  part.count = 2;
  std::ranges::copy(points, part.point.begin());
  ASSERT_EQ(ask(MessageType::table_points, part).status, Status::ok);
  ASSERT_EQ(ask(MessageType::finish_table,
                firmware::FinishTableRequest{firmware::crc32(std::as_bytes(std::span(points))), 0, {}})
                .status,
            Status::ok);
  const auto stored = bench->board.parameter_flash().contents();
  const firmware::ParameterValues values = bench->application.active();
  const auto check = [&](const Bytes& image) {
    EXPECT_EQ(program(), image);
    EXPECT_EQ(bench->application.active(), values);
    EXPECT_EQ(bench->application.store().report().state, firmware::StoreState::loaded);
    EXPECT_EQ(bench->application.store().table(0).points.size(), 2u);
    firmware::FaultLogPayload logged;
    EXPECT_TRUE(bench->application.logged_fault(0, logged));
    EXPECT_EQ(logged.entry.reset, 4);
    EXPECT_EQ(bench->board.parameter_flash().contents(), stored) << "bit for bit";
  };
  for (const Bytes& image : {new_image, old_image}) {
    ASSERT_EQ(send(image), Status::ok);
    start();
    ASSERT_EQ(ask(MessageType::confirm_update).status, Status::ok);
    check(image);
  }
  ASSERT_EQ(send(new_image), Status::ok);
  start();
  check(new_image);
  start();
  check(old_image);
}

}  // namespace
