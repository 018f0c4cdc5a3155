// udev runs while the tests do: it applies rules, and tells libusb which devices come and go.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>

#include "tests/child.hpp"
#include "tests/guest/support/guest_boards.hpp"
#include "tests/run_program.hpp"

namespace {

class Udev : public testing::Environment {
 public:
  void SetUp() override {
    if (!guest_test::in_guest()) return;
    daemon_ = std::make_unique<Child>(std::vector<std::string>{"/lib/systemd/systemd-udevd"});
    bool answers = false;
    for (int attempt = 0; attempt < 100 && !answers; ++attempt) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      answers = run_program("udevadm control --ping --timeout=20").exit_code == 0;
    }
    ASSERT_TRUE(answers);
  }
  void TearDown() override { daemon_.reset(); }

 private:
  std::unique_ptr<Child> daemon_;
};

const testing::Environment* const kUdev = testing::AddGlobalTestEnvironment(new Udev);

}  // namespace
